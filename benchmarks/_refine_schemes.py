"""What each scheme makes of a view: triangles, time, memory, and how far they are from the limit surface."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from _refine_levels import Edges, Hierarchy, Mask, by_view
from _refine_models import TURNS, camera, criteria
from _refine_redgreen import least_count, red_green, wanted_edges
from numpy.typing import NDArray

from foveal.mesh import TriMesh
from foveal.mesh.distance import SurfaceIndex, sample_surface
from foveal.refine import Criteria, Region, Rgb, Sqrt3, loop
from foveal.view.camera import Camera

SAMPLES = 20_000
MOST = 1_400_000
"""Triangles of what stands for the limit surface, at most: edges of about 2 pixels, vertices in the limit."""


@dataclass
class Made:
    """One scheme's mesh for one camera; distances in pixels, of what faces the eye.

    `long_permille` of the triangles that face the eye have an edge that is longer than wanted: they were cut,
    or kept, only to fit to coarser ones.
    """

    scheme: str
    triangles: int
    ms: float
    bytes_per_triangle: float
    mean_px: float = 0.0
    most_px: float = 0.0
    long_permille: float = 0.0


def everywhere(level: int) -> Criteria:
    """So many iterations, wherever it is."""
    return Criteria(Region(level), Region(level), Region(level))


def placed(refined: object) -> TriMesh:
    """A refinement's mesh with its vertices in the limit, or as they are where it offers no such choice."""
    try:
        return refined.mesh(positions="limit")
    except TypeError:
        return refined.mesh()


def meshes(
    mesh: TriMesh, view: Camera, wish: Criteria, hierarchy: Hierarchy
) -> Iterator[tuple[Made, TriMesh]]:
    """Each scheme's mesh for the same limits. Those of red-green read levels that are made before."""
    is_wanted = by_view(hierarchy, view, wish)
    depth = len(wanted_edges(hierarchy, is_wanted))
    ms, fine = timed(lambda: loop(mesh, depth, positions="limit"))
    yield Made("uniform Loop", len(fine.faces), ms, _bytes(fine)), fine
    for name, is_sparing in (("red-green", False), ("red-green, sparing", True)):
        ms, fine = timed(
            lambda is_sparing=is_sparing: red_green(hierarchy, is_wanted, is_sparing=is_sparing).mesh(
                is_limit=True
            )
        )
        size = hierarchy.bytes_used() / len(fine.faces)
        yield Made(name, len(fine.faces), ms, size), fine
    for name, make in (("RGB", Rgb), ("√3", Sqrt3)):
        ms, refined = timed(lambda make=make: _refined(make, mesh, view, wish))
        fine = placed(refined)
        yield Made(name, len(fine.faces), ms, refined.bytes_used / len(fine.faces)), fine


def _refined(make: Callable[[TriMesh], object], mesh: TriMesh, view: Camera, wish: Criteria) -> object:
    refined = make(mesh)
    refined.update(view, criteria=wish)
    return refined


def _bytes(mesh: TriMesh) -> float:
    return (mesh.positions.nbytes + mesh.faces.nbytes) / len(mesh.faces)


def timed(function: Callable[[], object]) -> tuple[float, object]:
    """(milliseconds, result): the quickest of three, after one to warm up."""
    function()
    best, result = float("inf"), None
    for _ in range(3):
        begin = time.perf_counter()
        result = function()
        best = min(best, 1e3 * (time.perf_counter() - begin))
    return best, result


def compared(mesh: TriMesh, *, edge_px: float) -> list[Made]:
    """All schemes, all cameras."""
    loop_level = int(np.log(MOST / len(mesh.faces)) / np.log(4))
    sqrt3_level = int(np.log(MOST / len(mesh.faces)) / np.log(3))
    truth = {"Loop": SurfaceIndex(loop(mesh, loop_level, positions="limit"))}
    truth["√3"] = SurfaceIndex(placed(_refined(Sqrt3, mesh, camera(mesh), everywhere(sqrt3_level))))
    hierarchy, found = Hierarchy(mesh), []
    for degrees in TURNS:
        view = camera(mesh, degrees)
        for made, fine in meshes(mesh, view, criteria(edge_px), hierarchy):
            index = truth["√3" if made.scheme == "√3" else "Loop"]
            seen = front_of(fine, view)
            pixels = distances_px(seen, index, view)
            made.mean_px, made.most_px = float(pixels.mean()), float(pixels.max())
            # A twentieth is for the limit, whose edges differ a little from those that were asked.
            made.long_permille = 1e3 * float((longest_px(seen, view) > 1.05 * edge_px).mean())
            found.append(made)
    return found


def front_of(mesh: TriMesh, view: Camera) -> TriMesh:
    """The triangles that face the eye."""
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    is_front = (np.cross(b - a, c - a) * (view.position - a)).sum(axis=1) > 0
    return TriMesh(mesh.positions, mesh.faces[is_front])


def longest_px(mesh: TriMesh, view: Camera) -> NDArray[np.float64]:
    """Each triangle's longest edge, in pixels at its middle."""
    corners = mesh.positions[mesh.faces]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    return edges * view.pixels_per_radian() / np.linalg.norm(view.position - corners.mean(axis=1), axis=1)


def distances_px(mesh: TriMesh, truth: SurfaceIndex, view: Camera) -> NDArray[np.float64]:
    """How far points spread over a mesh are from the limit surface, in pixels there."""
    points = sample_surface(mesh, SAMPLES)
    away = np.linalg.norm(view.position - points, axis=1)
    return truth.distance(points) * view.pixels_per_radian() / away


def around_a_point(mesh: TriMesh) -> dict[str, int]:
    """Triangles that are added to refine vertex 0 as deep as it goes: as abrupt as a transition can be."""
    hierarchy = Hierarchy(mesh, 5)

    def is_wanted(level: int, edges: Edges) -> Mask:
        points, ends = hierarchy.positions[level], hierarchy.ends(level, edges)
        a, b = points[ends[:, 0]], points[ends[:, 1]]
        reach = np.linalg.norm((a + b) / 2 - points[0], axis=1)
        return reach < 0.6 * np.linalg.norm(b - a, axis=1)

    base = len(mesh.faces)
    return {
        "red-green": red_green(hierarchy, is_wanted).count() - base,
        "red-green, sparing": red_green(hierarchy, is_wanted, is_sparing=True).count() - base,
        "RGB": least_count(hierarchy, is_wanted) - base,
    }


def growth(mesh: TriMesh, iterations: int) -> dict[str, list[int]]:
    """Triangles after 0, 1, 2, ... iterations, as in Alliez et al., figure 14: from the fourth on, those that
    follow the view refine silhouettes only."""
    count, made = len(mesh.faces), {}
    made["uniform Loop"] = [count * 4**i for i in range(iterations + 1)]
    made["uniform √3"] = [count * 3**i for i in range(iterations + 1)]
    for name, make in (("√3 by view", Sqrt3), ("RGB by view", Rgb)):
        wishes = [Criteria(Region(min(i, 3)), Region(i), Region(0)) for i in range(iterations + 1)]
        made[name] = [int(make(mesh).update(camera(mesh), criteria=wish).faces) for wish in wishes]
    return made
