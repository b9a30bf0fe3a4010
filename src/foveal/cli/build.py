"""foveal build: a mesh into a .fov."""

import time
from pathlib import Path
from typing import Annotated

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
from .report import print_json, reporter
from .work import build_arguments, dask_executor, refuse_existing

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

    It is compressed, and read part by part. Every triangle comes back. The file appears when it is whole; an interrupted build leaves nothing.
    """
    from foveal.base.errors import FovealError
    from foveal.scene.prepare import build_file

    if output is None:
        output = file.with_name(f"{file.name.removesuffix('.gz').rpartition('.')[0] or file.name}.fov")
    if output.suffix.lower() != ".fov":
        raise FovealError(f"{output}: the name must end in .fov.")
    if file.suffix.lower() in {".json"}:
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
    seconds = time.monotonic() - begin
    facts = {
        "file": str(output),
        "bytes": output.stat().st_size,
        "seconds": round(seconds, 3),
        **_facts(report),
    }
    if json:
        print_json(facts)
    elif not quiet:
        print(f"{output}: {facts['bytes']:,} bytes in {seconds:.1f} s")
        for name, value in _facts(report).items():
            if not isinstance(value, (list, dict)) and value is not None:
                print(
                    f"  {name.replace('_', ' ')}: {value:,}"
                    if isinstance(value, int)
                    else f"  {name.replace('_', ' ')}: {value}"
                )


def _facts(report: object) -> dict[str, object]:
    import dataclasses

    return (
        dataclasses.asdict(report)
        if dataclasses.is_dataclass(report) and not isinstance(report, type)
        else {}
    )
