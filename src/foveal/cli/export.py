"""foveal export: a mesh file of a chosen fineness."""

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, building, takes, telling
from .options import Force, Source
from .output import refuse_output
from .result import counted

if TYPE_CHECKING:
    from foveal.scene.build import BuildOptions

__all__ = ["export"]


@takes(building, telling)
def export(
    file: Source,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Ends in .ply or .glb.", readable=False)
    ],
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
    *,
    building: AbstractContextManager["BuildOptions"],
    telling: Telling,
) -> None:
    """Write a PLY or GLB, whole or coarser.

    Without --error and --triangles every triangle is written. GLB is y up and float32 about a translation;
    PLY keeps the coordinates as they are.
    """
    import foveal

    if error is not None and triangles is not None:
        raise typer.BadParameter(
            "it says in another way what --error says. Give one.", param_hint="--triangles"
        )
    refuse_output(output, file, ".ply", ".glb", force=force)
    with telling.progress() as progress, building as options:
        mesh = foveal.export(file, output, error=error, triangles=triangles, progress=progress, **options)
    faces, vertices, size = len(mesh.faces), len(mesh.positions), output.stat().st_size
    telling.result(
        {"file": str(output), "bytes": size, "triangles": faces, "vertices": vertices},
        f"{output}: {counted(faces, 'triangle')}, {counted(vertices, 'vertex', 'vertices')}, {size:,} bytes",
    )
