"""Uniform Loop subdivision: foveal, OpenSubdiv's Far, libigl and trimesh in turns."""

import statistics
from collections.abc import Iterator
from pathlib import Path

import _refine_peers as peers
from _refine_models import shared
from _shape import Row, seconds

from foveal.mesh import shapes
from foveal.refine import loop

LEVELS = 3


def loops(folder: Path, *, is_quick: bool) -> Iterator[Row]:
    """Million triangles a second that come out, all told: checking the mesh, its edges, all levels."""
    mesh = shared("cheburashka.obj") or shapes.bumpy_sphere(5)
    made = len(mesh.faces) * 4**LEVELS / 1e6
    case = f"{len(mesh.faces):,} to {len(mesh.faces) * 4**LEVELS:,} tri"
    functions = {"foveal": lambda: loop(mesh, LEVELS), **peers.python_loops(mesh, LEVELS)}
    loop(mesh, LEVELS)
    speeds: dict[str, list[float]] = {}
    path, why = peers.write(mesh, folder / "uniform.bin"), ""
    for turn in range(3 if is_quick else 7):
        for name, function in functions.items():
            if name == "trimesh" and turn >= (1 if is_quick else 3):
                continue  # it takes seconds
            speeds.setdefault(name, []).append(made / seconds(function))
        try:
            speeds.setdefault("OpenSubdiv Far", []).append(
                1e3 * made / peers.run("far_loop", path, LEVELS)[1]
            )
        except peers.Missing as reason:
            why = str(reason)
    others = {name: statistics.median(found) for name, found in speeds.items() if found and name != "foveal"}
    yield Row.of(
        "loop_uniform_mtris", case, speeds["foveal"], "Mtri/s", "higher", bar=5, peers=others, why=why
    )
