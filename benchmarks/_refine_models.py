"""The meshes and cameras of ./do bench refine."""

import math
from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
import platformdirs
from _shape import SHARED_DATA

from foveal.mesh import TriMesh, read_mesh, shapes
from foveal.mesh.io import write_ply
from foveal.mesh.topology import weld
from foveal.refine import Criteria, Region
from foveal.view.camera import Camera

CACHE = platformdirs.user_cache_path("foveal") / "bench"
EDGE_PX, TURNS = 8.0, (0, 72, 144, 216, 288)
"""Of the comparison of schemes: the longest edge that faces the eye, and its five cameras in degrees."""
HEAD_FACES = 838  # of the mannequin's head in Alliez et al., figure 10


def shared(name: str) -> TriMesh | None:
    """A control mesh for development, welded; None where it is not there."""
    path = SHARED_DATA / "base_meshes" / name
    return weld(read_mesh(path))[0] if path.is_file() else None


@cache
def head() -> tuple[TriMesh, str]:
    """A closed head of 838 triangles and what to call it; a bumpy sphere where none can be made."""
    path = CACHE / f"head_{HEAD_FACES}.ply"
    if path.is_file():
        return read_mesh(path), f"head, {HEAD_FACES} tri"
    whole = shared("decimated-max.obj")
    try:
        import fast_simplification
    except ImportError:
        whole = None
    if whole is None:
        ball = shapes.bumpy_sphere(3)
        return ball, f"bumpy sphere, {len(ball.faces)} tri"
    positions, faces = fast_simplification.simplify(
        whole.positions.astype(np.float32), whole.faces, target_count=HEAD_FACES
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    write_ply(TriMesh.of(positions, faces), path)
    return read_mesh(path), f"head, {HEAD_FACES} tri"


def real() -> Iterator[tuple[str, TriMesh]]:
    """Control meshes that people made, coarse enough to be worth refining: one is open, one has two holes."""
    for name, file in (
        ("knight", "decimated-knight.off"),
        ("eight", "cgal/eight.off"),
        ("rotor", "cgal/rotor.off"),
        ("open head", "cgal/head.off"),
    ):
        mesh = shared(file)
        if mesh is not None:
            yield name, mesh


def camera(mesh: TriMesh, degrees: float = 0.0, *, closeness: float = 1.0) -> Camera:
    """The standard view: the whole mesh in 1280 by 720 from a little above, turned by so much around y."""
    angle = math.radians(degrees)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    around = Camera.around(low, high, direction=(math.sin(angle), 0.3, math.cos(angle)))
    return Camera.of(around.target + closeness * (around.position - around.target), around.target)


def criteria(edge_px: float) -> Criteria:
    """Silhouettes twice as fine as what faces the eye, backs left alone; pixels decide, not iterations."""
    return Criteria(Region(14, edge_px), Region(14, edge_px / 2), Region(0))


def threshold(count: Callable[[float], int], wanted: int) -> tuple[float, int]:
    """(pixels, triangles): the edge length for which `count` is nearest to `wanted`, by bisection."""
    low, high = math.log(0.05), math.log(500)  # triangles fall from low to high
    best = (math.inf, 0.0, 0)
    for _ in range(24):
        middle = math.exp((low + high) / 2)
        made = count(middle)
        best = min(best, (abs(made - wanted) / wanted, middle, made))
        if best[0] < 0.01:
            break
        if made > wanted:
            low = math.log(middle)
        else:
            high = math.log(middle)
    return best[1], best[2]
