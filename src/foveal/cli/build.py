"""foveal build: a mesh into a .fov."""

import dataclasses
import time
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, building, refining, takes, telling
from .options import Force, Source
from .output import refuse_output
from .result import counted

if TYPE_CHECKING:
    from foveal.multires import BuildReport
    from foveal.scene.build import BuildOptions
    from foveal.scene.refinement import RefineOptions

__all__ = ["build"]


@takes(building, refining, telling)
def build(
    file: Source,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE.fov", help="By default FILE.fov beside the input.", readable=False
        ),
    ] = None,
    force: Force = False,
    *,
    building: AbstractContextManager["BuildOptions"],
    refining: "RefineOptions",
    telling: Telling,
) -> None:
    """Turn a mesh into one .fov that holds all resolutions.

    It is compressed, and read part by part. Every triangle comes back. The file appears when it is whole; an
    interrupted build leaves nothing. With --scheme it is kept as a control mesh instead, to be refined where
    it is looked at.
    """
    import foveal
    from foveal.scene.build import title_of
    from foveal.scene.cage_file import CageReport
    from foveal.scene.cage_polygons import told

    output = output or file.with_name(f"{title_of(file)}.fov")
    refuse_output(output, file, ".fov", force=force)
    begin = time.monotonic()
    with telling.progress() as progress, building as options:
        chosen: BuildOptions = {**options, **refining}
        report = foveal.build(file, output, progress=progress, **chosen)
    seconds = time.monotonic() - begin
    facts = {"file": str(output), **dataclasses.asdict(report)}
    if isinstance(report, CageReport):
        counts = f"{counted(report.triangles, 'triangle')}, {counted(report.vertices, 'vertex', 'vertices')}"
        if report.sharp_edges:
            counts += f", {counted(report.sharp_edges, 'sharp edge')}"
        if report.polygons is not None:
            counts = f"{told(report.polygons)}, {counted(report.vertices, 'vertex', 'vertices')}"
            counts += f", in {report.placements:,} places" if report.placements > 1 else ""
        telling.result(facts, f"{output}: a control mesh of {counts}, {report.bytes:,} bytes")
        return
    facts["seconds"] = {"total": seconds, **report.seconds}
    telling.result(facts, *_lines(output, report, seconds))


def _lines(output: Path, report: "BuildReport", seconds: float) -> list[str]:
    repairs = report.repairs
    counts = f"{counted(repairs.triangles, 'triangle')}, {counted(repairs.vertices, 'vertex', 'vertices')}"
    bits = 8 * report.bytes / max(1, repairs.vertices)
    levels = counted(len(report.levels), "level")
    lines = [
        f"{output}: {counts}, in {seconds:.1f} s",
        f"  size         {report.bytes:,} bytes, {bits:.2f} bits a vertex",
        f"  patches      {report.patches:,} in {report.nodes:,} nodes, {levels}",
        f"  grid step    {report.step:.6g}",
    ]
    if repairs.nonmanifold_edges or repairs.boundary_edges:
        odd = f"{repairs.boundary_edges:,} open, {repairs.nonmanifold_edges:,} of more than two triangles"
        lines.append(f"  edges        {odd}")
    return lines
