"""Refinement for a view: fresh, and after the camera went one degree on around the model."""

import statistics
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import _refine_page as in_page
import _refine_peers as peers
from _refine_models import camera, criteria, head, threshold
from _shape import Row, seconds

from foveal.base.jit import kernel
from foveal.mesh import TriMesh
from foveal.mesh.normals import vertex_normals
from foveal.refine import Criteria, Region, Sqrt3
from foveal.refine._kernels_criteria import is_wanted
from foveal.refine.criteria import view_of

Make = Callable[[TriMesh], Any]
"""A scheme: `Sqrt3`, or what has its methods."""


def rgb_scheme() -> Make | None:
    """`foveal.refine.Rgb`, where this foveal has it."""
    import foveal.refine

    return getattr(foveal.refine, "Rgb", None)


@cache
def pixels(make: Make, wanted: int) -> tuple[float, int]:
    """(edge_px, triangles): what brings the head to about so many triangles."""
    mesh, _ = head()
    return threshold(lambda px: int(make(mesh).update(camera(mesh), criteria=criteria(px)).faces), wanted)


@dataclass
class Walk:
    """Milliseconds of a scheme on the way around a model, and of others for the first view."""

    edge_px: float
    faces: int
    fresh: list[float]
    orbit: list[float]
    bytes_per_triangle: float
    others: dict[str, list[float]]
    why: str


def walk(make: Make, wanted: int, runs: int, path: Path | None = None) -> Walk:
    """Fresh meshes and updates in turns, one degree further each time, at about `wanted` triangles.

    A fresh mesh is made from nothing, its arrays included; an update leaves them in their slots.
    """
    mesh, _ = head()
    px, faces = pixels(make, wanted)
    wish, follower = criteria(px), make(mesh)
    follower.update(camera(mesh), criteria=wish)
    follower.mesh()
    bytes_used = follower.bytes_used / faces
    found = Walk(px, faces, [], [], bytes_used, {}, "")
    chosen = _others(mesh, path, wanted, found) if path else {}
    for turn in range(1, runs + 1):
        view = camera(mesh, turn)
        found.orbit.append(1e3 * seconds(lambda view=view: follower.update(view, criteria=wish)))
        found.fresh.append(1e3 * seconds(lambda view=view: _fresh(make, mesh, view, wish)))
        for name, (program, edge_px) in chosen.items():
            ms = peers.by_view(program, path, camera(mesh), edge_px)[1]
            found.others.setdefault(name, []).append(ms)
    return found


def _fresh(make: Make, mesh: TriMesh, view: Any, wish: Criteria) -> None:
    refined = make(mesh)
    refined.update(view, criteria=wish)
    refined.mesh()


def _others(mesh: TriMesh, path: Path, wanted: int, found: Walk) -> dict[str, tuple[str, float]]:
    """Programs that are there, each with the pixels that give it as many triangles."""
    chosen = {}
    peers.write(mesh, path)
    for name, program in (("OpenMesh", "openmesh_sqrt3"), ("Bfr", "bfr_loop")):
        try:
            peers.program(program)
        except peers.Missing as reason:
            found.why += f"{reason}. "
            continue
        px, faces = threshold(
            lambda px, program=program: peers.by_view(program, path, camera(mesh), px)[0], wanted
        )
        chosen[f"{name} to {faces:,}"] = program, px
    return chosen


def sqrt3(folder: Path, *, is_quick: bool) -> Iterator[Row]:
    """The paper's case: a head of 838 triangles to about 43,000."""
    _, name = head()
    done = walk(Sqrt3, 43_000, 5 if is_quick else 21, folder / "head.bin")
    case = f"{name} to {done.faces:,}, {done.edge_px:.2f} px"
    others = {name: statistics.median(ms) for name, ms in done.others.items()}
    yield Row.of(
        "sqrt3_fresh_43k_ms", case, done.fresh, "ms", "lower", bar=20, peers=others, why=done.why.strip()
    )
    yield Row.of("sqrt3_orbit_1deg_ms", case, done.orbit, "ms", "lower", bar=5)
    shares = [o / statistics.median(done.fresh) for o in done.orbit]
    yield Row.of("sqrt3_orbit_vs_fresh", case, shares, "of fresh", "lower", bar=0.25)
    size = done.bytes_per_triangle
    yield Row(
        "sqrt3_bytes_per_triangle", case, size, "byte", "lower", bar=200, peers={"OpenMesh, note": 1300}
    )


@kernel
def classify(view, limits, faces, positions, normals):
    """Ask of every triangle whether it is in the frustum, front, silhouette or back, and fine enough."""
    count = 0
    for f in range(len(faces)):
        u, v, w = faces[f, 0], faces[f, 1], faces[f, 2]
        a, b, c = positions[u], positions[v], positions[w]
        answer, _ = is_wanted(
            view, limits, 1, a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], normals, u, v, w
        )
        count += answer
    return count


def silhouette(*, is_quick: bool) -> Iterator[Row]:
    """The share that asking has of a fresh refinement: once of each triangle there is and of each split."""
    mesh, name = head()
    px, _ = pixels(Sqrt3, 43_000)
    wish, refined = criteria(px), Sqrt3(mesh)
    done = refined.update(camera(mesh), criteria=wish)
    fine = refined.mesh()
    normals = vertex_normals(fine)
    words = view_of(camera(mesh)), wish.limits(), fine.faces, fine.positions, normals
    classify(*words)
    shares = []
    for _ in range(5 if is_quick else 21):
        asked = seconds(lambda: classify(*words)) * (done.faces + done.split) / done.faces
        shares.append(asked / seconds(lambda: _fresh(Sqrt3, mesh, camera(mesh), wish)))
    yield Row.of("silhouette_share", name, shares, "of fresh", "lower", bar=0.1, peers={"paper": 0.02})


def page(*, is_quick: bool) -> Iterator[Row]:
    """The same √3 in the page, in a worker."""
    mesh, name = head()
    px, _ = pixels(Sqrt3, 43_000)
    cameras = [camera(mesh, turn) for turn in range(16)]
    yield from in_page.rows(mesh, name, cameras, criteria(px), runs=5 if is_quick else 25)


def rgb(*, is_quick: bool) -> Iterator[Row]:
    """The head to about 100,000 triangles by RGB."""
    bars = {"rgb_fresh_100k_ms": 200, "rgb_orbit_1deg_ms": 10}
    _, name = head()
    make = rgb_scheme()
    if make is None:
        for key, bar in bars.items():
            yield Row(key, name, None, "ms", "lower", bar=bar, why="foveal.refine.Rgb is not there")
        return
    done = walk(make, 100_000, 3 if is_quick else 15)
    case = f"{name} to {done.faces:,}, {done.edge_px:.2f} px"
    for key, values in zip(bars, (done.fresh, done.orbit), strict=True):
        yield Row.of(key, case, values, "ms", "lower", bar=bars[key])


def rgb_operations(*, is_quick: bool) -> Iterator[Row]:
    """Splits, and merges, a second of RGB: everything that an update does counts in its time."""
    mesh, name = head()
    make = rgb_scheme()
    if make is None:
        why = "foveal.refine.Rgb is not there"
        yield Row("rgb_ops_per_s", name, None, "M/s", "higher", bar=0.7, why=why)
        return
    px, _ = pixels(make, 100_000)
    coarse = Criteria(Region(0), Region(0), Region(0))
    speeds: dict[str, list[float]] = {"splits": [], "merges": []}
    for turn in range(4 if is_quick else 12):
        refined, view = make(mesh), camera(mesh, turn)
        begin = time.perf_counter()
        finer = refined.update(view, criteria=criteria(px))
        middle = time.perf_counter()
        coarser = refined.update(view, criteria=coarse)
        end = time.perf_counter()
        if turn:  # the first is the warm-up
            speeds["splits"].append(finer.split / (middle - begin) / 1e6)
            speeds["merges"].append(coarser.undone / (end - middle) / 1e6)
    for kind in sorted(speeds, key=lambda kind: statistics.median(speeds[kind])):
        case = f"{name} to 100,000, {kind}"
        yield Row.of("rgb_ops_per_s", case, speeds[kind], "M/s", "higher", bar=0.7)
