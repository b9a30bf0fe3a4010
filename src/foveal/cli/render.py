"""foveal render: a picture without a GPU or a display."""

from pathlib import Path
from typing import Annotated

import typer

from .options import (
    Debug,
    ErrorPx,
    Force,
    Json,
    Memory,
    Quiet,
    Size,
    Source,
    Up,
    Verbose,
    Workers,
    parse_picture_size,
)
from .report import print_json, reporter
from .work import build_arguments, refuse_existing

__all__ = ["render"]


def render(
    file: Source,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.png", help="The picture to write.")],
    camera: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            help="Position, target, up, field of view in degrees. By default all is framed.",
        ),
    ] = None,
    size: Size = None,
    error_px: ErrorPx = 1.0,
    triangles: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="At most about this many for each layer. Fewer is faster and coarser."
        ),
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
    """Draw a PNG, the same pixels on every machine.

    Needs no GPU and no display.
    """
    wanted = None if size is None else parse_picture_size(size)
    if output.suffix.lower() != ".png":
        raise typer.BadParameter(f"{output}: the name must end in .png.", param_hint="--output")
    refuse_existing(output, force=force)

    from foveal.raster import write_png
    from foveal.scene.prepare import load
    from foveal.scene.render import frame, read_camera
    from foveal.scene.render import render as draw

    with reporter(is_quiet=quiet, is_verbose=verbose) as progress:
        eye = None if camera is None else read_camera(camera, size=wanted)
        scene = load(
            file,
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
        eye = eye or frame(scene, size=wanted or (1280, 720))
        write_png(draw(scene, eye, error_px=error_px, triangle_budget=triangles), output)
    if json:
        print_json({"file": str(output), "bytes": output.stat().st_size, "camera": eye.to_json()})
    elif not quiet:
        print(f"{output}: {eye.width} x {eye.height} pixels")
