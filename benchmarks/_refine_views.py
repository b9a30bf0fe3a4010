"""Refinement for a view: fresh, and after the camera went one degree on around the model."""

import statistics
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

import _refine_page as in_page
import _refine_peers as peers
from _refine_models import camera, criteria, head, threshold
from _shape import Row, seconds

import foveal.refine.filter as published
from foveal.mesh import TriMesh
from foveal.refine import Criteria, Region, Rgb, Sqrt3, Sqrt3Filter

#: Frames in a row.
_FRAMES = 6

Make = Callable[[TriMesh], Any]
"""A scheme: `Sqrt3`, or what has its methods."""


@cache
def pixels(make: Make, wanted: int) -> tuple[float, int]:
    """(edge_px, triangles): what brings the head to about so many triangles."""
    mesh, _ = head()
    return threshold(lambda px: int(make(mesh).update(camera(mesh), criteria=criteria(px)).faces), wanted)


@dataclass
class Walk:
    """Milliseconds of a scheme on the way around a model, and of others for the first view.

    An orbit's frame comes after the one before: `orbit` and `fresh` are medians of some in a row. `woken` is
    the first frame after the others ran, from whose hundreds of megabytes the caches are cold.
    """

    edge_px: float
    faces: int
    fresh: list[float]
    orbit: list[float]
    woken: list[float]
    bytes_per_triangle: float
    others: dict[str, list[float]]
    why: str


def walk(make: Make, wanted: int, runs: int, path: Path | None = None) -> Walk:
    """Fresh meshes and updates in turns, one degree further each frame, at about `wanted` triangles.

    A fresh mesh is made from nothing, its arrays included; an update leaves them in their slots.
    """
    mesh, _ = head()
    px, faces = pixels(make, wanted)
    wish, follower = criteria(px), make(mesh)
    follower.update(camera(mesh), criteria=wish)
    follower.mesh()
    bytes_used = follower.bytes_used / faces
    found = Walk(px, faces, [], [], [], bytes_used, {}, "")
    chosen = _others(mesh, path, wanted, found) if path else {}
    for turn in range(runs):
        views = [camera(mesh, turn * _FRAMES + i) for i in range(1, _FRAMES + 1)]
        frames = [1e3 * seconds(lambda view=view: follower.update(view, criteria=wish)) for view in views]
        found.woken.append(frames[0])
        found.orbit.append(statistics.median(frames[1:]))
        fresh = [1e3 * seconds(lambda view=view: _fresh(make, mesh, view, wish)) for view in views[-3:]]
        found.fresh.append(statistics.median(fresh))
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
    yield Row.of("sqrt3_orbit_woken_ms", case, done.woken, "ms", "lower")
    size = done.bytes_per_triangle
    yield Row(
        "sqrt3_bytes_per_triangle", case, size, "byte", "lower", bar=200, peers={"OpenMesh, note": 1300}
    )


def silhouette(*, is_quick: bool) -> Iterator[Row]:
    """The share of looking for silhouettes, and of all extraction, in a refinement as the paper publishes it.

    There both are steps of their own; the exact mode asks each triangle once where it is and how fine it is.
    """
    mesh, name = head()
    px, _ = pixels(Sqrt3Filter, 43_000)
    refined, wish = Sqrt3Filter(mesh), criteria(px)
    shares: dict[str, list[float]] = {"silhouette_share": [], "extraction_share": []}
    for turn in range(6 if is_quick else 22):
        with _timed(published.extract, ("keep_inside", "face_the_eye", "strips")) as spent:
            whole = seconds(lambda turn=turn: refined.update(camera(mesh, turn), criteria=wish))
        if turn:  # the first is the warm-up
            shares["silhouette_share"].append(spent["strips"] / whole)
            shares["extraction_share"].append(sum(spent.values()) / whole)
    yield Row.of(
        "silhouette_share",
        name,
        shares["silhouette_share"],
        "of all",
        "lower",
        bar=0.1,
        peers={"paper": 0.02},
    )
    yield Row.of("extraction_share", name, shares["extraction_share"], "of all", "lower")


@contextmanager
def _timed(module: Any, names: tuple[str, ...]) -> Iterator[dict[str, float]]:
    """Seconds that functions of a module take while this is open."""
    spent = dict.fromkeys(names, 0.0)

    def timed(name: str) -> Callable[..., Any]:
        function = getattr(module, name)

        def called(*values: Any) -> Any:
            begin = time.perf_counter()
            answer = function(*values)
            spent[name] += time.perf_counter() - begin
            return answer

        return called

    with patch.multiple(module, **{name: timed(name) for name in names}):
        yield spent


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
    done = walk(Rgb, 100_000, 3 if is_quick else 15)
    case = f"{name} to {done.faces:,}, {done.edge_px:.2f} px"
    for key, values in zip(bars, (done.fresh, done.orbit), strict=True):
        yield Row.of(key, case, values, "ms", "lower", bar=bars[key])
    yield Row.of("rgb_orbit_woken_ms", case, done.woken, "ms", "lower")


def rgb_operations(*, is_quick: bool) -> Iterator[Row]:
    """Splits, and merges, a second of RGB: everything that an update does counts in its time."""
    mesh, name = head()
    px, _ = pixels(Rgb, 100_000)
    coarse = Criteria(Region(0), Region(0), Region(0))
    speeds: dict[str, list[float]] = {"splits": [], "merges": []}
    for turn in range(4 if is_quick else 12):
        refined, view = Rgb(mesh), camera(mesh, turn)
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
