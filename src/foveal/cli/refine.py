"""foveal refine: a control mesh refined for a camera."""

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, refining, takes, telling
from .options import Force, ModeKind, Source, Up
from .output import refuse_output
from .result import counted

if TYPE_CHECKING:
    from foveal.scene.refinement import RefineOptions

__all__ = ["refine"]


@takes(refining, telling)
def refine(
    file: Source,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Ends in .ply or .glb.", readable=False)
    ],
    camera: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            help="Position, target, up, field of view in degrees, size. By default all is framed.",
            readable=False,
        ),
    ] = None,
    everywhere: Annotated[
        bool, typer.Option("--everywhere", help="Refine uniformly, --iterations times, whatever is seen.")
    ] = False,
    visible_only: Annotated[
        bool, typer.Option("--visible-only", help="Leave alone what is behind the rest. For sqrt3.")
    ] = False,
    mode: Annotated[
        ModeKind,
        typer.Option(
            case_sensitive=False,
            help="exact: at the points of uniform subdivision; filter: as the √3 paper has it, to compare.",
        ),
    ] = ModeKind.exact,
    up: Up = None,
    force: Force = False,
    *,
    refining: "RefineOptions",
    telling: Telling,
) -> None:
    """Write a control mesh as a camera has it refined.

    By √3 subdivision, unless --scheme or the .fov says otherwise: fine on silhouettes, coarser on front
    faces, not at all where nothing is seen.
    """
    from foveal.scene.refine import refine as refine_mesh

    if everywhere and (camera is not None or visible_only):
        which = "--visible-only" if camera is None else "--camera"
        raise typer.BadParameter("--everywhere asks no camera. Leave one out.", param_hint=which)
    if mode == ModeKind.filter and (everywhere or visible_only):
        which = "--everywhere" if everywhere else "--visible-only"
        raise typer.BadParameter("--mode filter does not know it. Leave one out.", param_hint=which)
    refuse_output(output, file, ".ply", ".glb", force=force)
    begin = time.monotonic()
    with telling.progress() as progress:
        mesh = refine_mesh(
            file,
            output,
            camera=camera,
            everywhere=everywhere,
            visible_only=visible_only,
            mode=mode.value,
            up=up and up.value,
            progress=progress,
            **refining,
        )
    faces, vertices, size = len(mesh.faces), len(mesh.positions), output.stat().st_size
    telling.result(
        {
            "file": str(output),
            "bytes": size,
            "triangles": faces,
            "vertices": vertices,
            "seconds": time.monotonic() - begin,
        },
        f"{output}: {counted(faces, 'triangle')}, {counted(vertices, 'vertex', 'vertices')}, {size:,} bytes",
    )
