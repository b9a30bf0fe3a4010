"""The table by resolution, plots and pictures of docs/shadows.md: python benchmarks/shadows_figures.py [docs]

Takes five minutes, of which a million pixels a side takes half. Writes what is between the page's markers
anew. Needs matplotlib.
"""

import sys
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from _shadows_fresh import in_a_process
from _shadows_lookups import camera, joined
from _shadows_scenes import scene
from _shape import ROOT
from refine_compare import fill, save

import foveal
from foveal import raster
from foveal.shadows import build
from foveal.view.camera import Camera

matplotlib.use("svg")
from matplotlib import pyplot as plot

SIDES = [1 << k for k in (10, 12, 14, 16, 18, 20)]
SCENES = ("Closed City", "Cityscape", "Villa", "Ship")
PAPER_MB = {
    1 << 10: (0.067, 0.11, 0.11, 0.15),
    1 << 11: (0.17, 0.26, 0.35, 0.43),
    1 << 12: (0.41, 0.59, 0.86, 1.05),
    1 << 14: (2.10, 2.70, 5.01, 5.26),
    1 << 16: (9.26, 11.41, 23.61, 22.71),
    1 << 18: (38.43, 46.73, 101.52, 94.18),
    1 << 19: (79.63, 94.88, 205.5, 191.5),
    1 << 20: (160.5, 190.4, 414.6, 392.1),
}
"""Table 1, of the paper's own scenes, whose MB are taken for 2^20 bytes."""
PAPER_S = {
    1 << 10: (0.089, 0.089),
    1 << 12: (0.242, 0.221),
    1 << 16: (5.301, 3.888),
    1 << 18: (55.18, 38.85),
}
"""Table 2, of the first two, on a Titan X."""
GREYS = ("#555555", "#777777", "#999999", "#bbbbbb")
OURS = "#4477aa"
Runs = dict[int, dict[str, Any]]


def table(runs: Runs) -> str:
    """A line for each resolution."""
    lines = [
        "| pixels a side | nodes | for lookups | a pixel | file | joined, projected | traced | peak |",
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for side, run in runs.items():
        phases, file = run["phases"], run["file_bytes"]
        lines.append(
            f"| {side:,} | {run['nodes']:,} | {run['packed_bytes'] / 1e6:.3g} MB "
            f"| {8 * run['packed_bytes'] / side**2:.2g} bit | {file / 1e6:.3g} MB "
            f"| {phases['joining'] + phases['projecting']:.1f} s | {phases['tracing']:.1f} s "
            f"| {run['peak_gb']:.1f} GB |"
        )
    return "\n".join(lines)


def plots(folder: Path, runs: Runs) -> None:
    """Bytes and seconds against the side, the paper's beside."""
    figure, axes = plot.subplots(figsize=(8, 3.6), layout="constrained")
    for i, name in enumerate(SCENES):
        sizes = [row[i] * 2**20 / 1e6 for row in PAPER_MB.values()]
        axes.plot(list(PAPER_MB), sizes, color=GREYS[i], marker=".", label=f"the paper, {name}")
    packed = [run["packed_bytes"] / 1e6 for run in runs.values()]
    axes.plot(list(runs), packed, color=OURS, marker="o", label="plaza, for lookups")
    files = [run["file_bytes"] / 1e6 for run in runs.values()]
    axes.plot(list(runs), files, color=OURS, marker="o", ls="--", label="plaza, file")
    _finish(axes, "MB")
    save(figure, folder / "shadows_bytes.svg")
    figure, axes = plot.subplots(figsize=(8, 3.6), layout="constrained")
    for i, name in enumerate(SCENES[:2]):
        seconds = [row[i] for row in PAPER_S.values()]
        axes.plot(list(PAPER_S), seconds, color=GREYS[i], marker=".", label=f"the paper, {name}, Titan X")
    whole = [run["seconds"] for run in runs.values()]
    axes.plot(list(runs), whole, color=OURS, marker="o", label="plaza, two processors, no GPU")
    traced = [run["phases"]["tracing"] for run in runs.values()]
    axes.plot(list(runs), traced, color=OURS, marker="o", ls="--", label="of that traced")
    _finish(axes, "seconds")
    save(figure, folder / "shadows_seconds.svg")


def _finish(axes: Any, what: str) -> None:
    axes.set(xscale="log", yscale="log", xlabel="pixels a side", ylabel=what)
    axes.set_xticks(SIDES, [f"{side >> 10}K" if side < 1 << 20 else "1M" for side in SIDES])
    axes.minorticks_off()
    axes.legend(fontsize=8)


def pictures(folder: Path) -> None:
    """The whole plaza, and what a coarse and a fine map make of one place, pixel for pixel."""
    found = scene("plaza")
    assert found is not None
    meshes, light = found
    mesh = joined(meshes)
    maps = {side: build(meshes, light, resolution=side) for side in (1 << 11, 1 << 18)}
    view = camera(1200, 560)
    foveal.render(mesh, folder / "shadows_plaza.png", camera=view, shadow=maps[1 << 18])
    near = Camera.of([4.4, -5.2, 2.6], [3.0, -3.0, 0.2], up=[0, 0, 1], width=600, height=400)
    halves = [
        foveal.render(mesh, camera=near, shadow=shadow, shadow_filter="hard") for shadow in maps.values()
    ]
    raster.write_png(np.ascontiguousarray(np.hstack(halves)), folder / "shadows_near.png")


def main(folder: Path) -> None:
    """Draw, measure, then write everything."""
    pictures(folder)
    runs: Runs = {}
    for side in SIDES:
        print(f"{side:,} pixels a side", file=sys.stderr)
        runs[side] = in_a_process("plaza", side)
    plots(folder, runs)
    path = folder / "shadows.md"
    path.write_text(fill(path.read_text(encoding="utf-8"), "sides", table(runs)), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
