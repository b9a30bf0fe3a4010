"""foveal export: a mesh file of a chosen fineness."""

from pathlib import Path
from typing import Annotated

import typer

from .options import Debug, Force, Json, Memory, Quiet, Source, Up, Verbose, Workers
from .report import counted, print_json, reporter
from .work import build_arguments, refuse_existing

__all__ = ["export"]


def export(
    file: Source,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="Ends in .ply or .glb.")],
    error: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            metavar="LENGTH",
            help="Largest distance to the original, in the file's unit. Larger is lighter.",
        ),
    ] = None,
    triangles: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="As fine as N triangles allow, instead of --error.")
    ] = None,
    force: Force = False,
    up: Up = None,
    memory: Memory = None,
    workers: Workers = None,
    json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    debug: Debug = False,
) -> None:
    """Write a PLY or GLB, whole or coarser.

    Without --error and --triangles every triangle is written. GLB is y up and float32 about a translation;
    PLY keeps the coordinates as they are.
    """
    from foveal.scene.export import export as write

    if error is not None and triangles is not None:
        raise typer.BadParameter(
            "it says in another way what --error says. Give one.", param_hint="--triangles"
        )
    if output.suffix.lower() not in (".ply", ".glb"):
        raise typer.BadParameter(
            f"{output}: the name must end in .ply or .glb, which says the format.", param_hint="--output"
        )
    refuse_existing(output, force=force)
    with reporter(is_quiet=quiet, is_verbose=verbose) as progress:
        mesh = write(
            file,
            output,
            error=error,
            triangles=triangles,
            **build_arguments(
                bits=None,
                step=None,
                normals=None,
                up=up,
                memory=memory,
                workers=workers,
                executor=None,
                progress=progress,
            ),
        )
    facts = {
        "file": str(output),
        "bytes": output.stat().st_size,
        "triangles": len(mesh.faces),
        "vertices": len(mesh.positions),
    }
    if json:
        print_json(facts)
    elif not quiet:
        counts = (
            f"{counted(len(mesh.faces), 'triangle')}, {counted(len(mesh.positions), 'vertex', 'vertices')}"
        )
        print(f"{output}: {counts}, {facts['bytes']:,} bytes")
