"""foveal build: a mesh into a .fov."""

import dataclasses
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import (
    Bits,
    Dask,
    Debug,
    Force,
    Json,
    Memory,
    Normals,
    Quiet,
    Source,
    Step,
    Up,
    Verbose,
    Workers,
)
from .report import counted, print_json, reporter
from .work import build_arguments, dask_executor, refuse_existing

if TYPE_CHECKING:
    from foveal.multires import BuildReport

__all__ = ["build"]


def build(
    file: Source,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE.fov", help="By default FILE.fov beside the input."),
    ] = None,
    force: Force = False,
    bits: Bits = None,
    step: Step = None,
    normals: Normals = None,
    up: Up = None,
    memory: Memory = None,
    workers: Workers = None,
    dask: Dask = None,
    json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    debug: Debug = False,
) -> None:
    """Turn a mesh into one .fov that holds all resolutions.

    It is compressed, and read part by part. Every triangle comes back. The file appears when it is whole; an
    interrupted build leaves nothing.
    """
    from foveal.base.errors import FovealError
    from foveal.scene.prepare import build_file

    if output is None:
        output = file.with_name(f"{file.name.removesuffix('.gz').rpartition('.')[0] or file.name}.fov")
    if output.suffix.lower() != ".fov":
        raise typer.BadParameter(f"{output}: the name must end in .fov.", param_hint="--output")
    if file.suffix.lower() == ".json":
        raise FovealError(f"{file}: a scene.json is not built; build its meshes one by one.")
    if output.exists() and file.exists() and output.samefile(file):
        raise FovealError(f"{output}: this is the input itself. Name another output.")
    refuse_existing(output, force=force)
    begin = time.monotonic()
    with reporter(is_quiet=quiet, is_verbose=verbose) as progress, dask_executor(dask) as executor:
        report = build_file(
            file,
            output,
            **build_arguments(
                bits=bits,
                step=step,
                normals=normals,
                up=up,
                memory=memory,
                workers=workers,
                executor=executor,
                progress=progress,
            ),
        )
    facts = {"file": str(output), **dataclasses.asdict(report)}
    facts["seconds"] = {"total": time.monotonic() - begin, **report.seconds}
    if json:
        print_json(facts)
    elif not quiet:
        _print(output, report, facts["seconds"]["total"])


def _print(output: Path, report: "BuildReport", seconds: float) -> None:
    repairs = report.repairs
    counts = f"{counted(repairs.triangles, 'triangle')}, {counted(repairs.vertices, 'vertex', 'vertices')}"
    print(f"{output}: {counts}, in {seconds:.1f} s")
    bits = 8 * report.bytes / max(1, repairs.vertices)
    print(f"  size         {report.bytes:,} bytes, {bits:.2f} bits a vertex")
    levels = counted(len(report.levels), "level")
    print(f"  patches      {report.patches:,} in {report.nodes:,} nodes, {levels}")
    print(f"  grid step    {report.step:.6g}")
    if repairs.nonmanifold_edges or repairs.boundary_edges:
        odd = f"{repairs.boundary_edges:,} open, {repairs.nonmanifold_edges:,} of more than two triangles"
        print(f"  edges        {odd}")
