"""How many receivers a second one thread finds lit or dark."""

import time
from collections.abc import Callable, Iterator

import numpy as np
from _shadows_scenes import scene
from _shape import Row
from numpy.typing import NDArray

from foveal import raster
from foveal.mesh import TriMesh
from foveal.shadows import build
from foveal.view.camera import Camera

__all__ = ["camera", "joined", "lookups", "receivers"]


def camera(width: int = 1920, height: int = 1080) -> Camera:
    """Over the plaza."""
    return Camera.of([13, -15, 9], [0, 0, 0], up=[0, 0, 1], width=width, height=height)


def joined(meshes: list[TriMesh]) -> TriMesh:
    """One mesh of many."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    return TriMesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]).astype(
            np.int32
        ),
    )


def receivers(mesh: TriMesh, view: Camera) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n, 3) what the pixels of a picture see, row by row, and the unit normals there, towards the eye."""
    seen = raster.rasterise(mesh.positions, mesh.faces, view)
    is_seen = seen.face_ids >= 0
    corners = mesh.positions[mesh.faces[seen.face_ids[is_seen]]]
    points = np.einsum("nk,nkd->nd", seen.weights[is_seen].astype(np.float64), corners)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    away = ((points - view.position) * normals).sum(1) > 0
    normals[away] *= -1
    return points, normals


def processor_s(function: Callable[[], object]) -> float:
    """Time of this thread alone."""
    begin = time.thread_time()
    function()
    return time.thread_time() - begin


def lookups(*, is_quick: bool) -> Iterator[Row]:
    """Million a second from points of the world, in the order of a picture of 1920 x 1080, and shuffled."""
    name = "small plaza" if is_quick else "plaza"
    found = scene(name)
    assert found is not None
    points, normals = receivers(joined(found[0]), camera())
    order = np.random.default_rng(1).permutation(len(points))
    mixed = points[order]
    rows: dict[str, list[Row]] = {
        "lookups_screen_per_s": [],
        "lookups_random_per_s": [],
        "pcf5_vs_single": [],
    }
    for side in (4096, 16384) if is_quick else (4096, 16384, 65536, 262144):
        shadow = build(*found, resolution=side)
        functions: dict[str, Callable[[], object]] = {
            "screen": lambda shadow=shadow: shadow.lookup(points),  # type: ignore[misc]
            "biased": lambda shadow=shadow: shadow.lookup(points, normals=normals),  # type: ignore[misc]
            "random": lambda shadow=shadow: shadow.lookup(mixed),  # type: ignore[misc]
            "pcf3": lambda shadow=shadow: shadow.pcf(points, footprint=3),  # type: ignore[misc]
            "pcf5": lambda shadow=shadow: shadow.pcf(points, footprint=5),  # type: ignore[misc]
        }
        times: dict[str, list[float]] = {kind: [] for kind in functions}
        for turn in range(4 if is_quick else 10):
            for kind, function in functions.items():
                took = processor_s(function)
                if turn:  # the first warms
                    times[kind].append(took)
        rate = {kind: [len(points) / 1e6 / t for t in some] for kind, some in times.items()}
        case = f"{name} {side}²"
        biased = {"with normals": float(np.median(rate["biased"]))}
        rows["lookups_screen_per_s"].append(
            Row.of("lookups_screen_per_s", case, rate["screen"], "million/s", "higher", bar=15, peers=biased)
        )
        rows["lookups_random_per_s"].append(
            Row.of("lookups_random_per_s", case, rate["random"], "million/s", "higher", bar=5)
        )
        share = [a / b for a, b in zip(times["pcf5"], times["screen"], strict=True)]
        third = {"3x3": float(np.median(times["pcf3"]) / np.median(times["screen"]))}
        rows["pcf5_vs_single"].append(Row.of("pcf5_vs_single", case, share, "x", "lower", bar=6, peers=third))
    for found_rows in rows.values():
        is_lower = found_rows[0].better == "lower"
        yield from sorted(found_rows, key=lambda row: (row.value or 0) * (-1 if is_lower else 1))
