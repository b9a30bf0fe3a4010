"""foveal render: a picture without a GPU or a display."""

import re
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, building, refining, takes, telling
from .options import Force, Shadow, Source
from .output import refuse_output

if TYPE_CHECKING:
    from foveal.scene.build import BuildOptions
    from foveal.scene.refinement import RefineOptions

__all__ = ["render"]


@takes(building, refining, telling)
def render(
    file: Source,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE.png", help="The picture to write.", readable=False)
    ],
    camera: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            help="Position, target, up, field of view in degrees. By default all is framed.",
            readable=False,
        ),
    ] = None,
    size: Annotated[
        str | None,
        typer.Option(metavar="WxH", help="Picture size in pixels; by default the camera's, or 1280x720."),
    ] = None,
    error_px: Annotated[
        float,
        typer.Option(
            min=0.0,
            metavar="PX",
            help="How wrong the surface may look, in pixels. Larger is faster and coarser.",
        ),
    ] = 1.0,
    triangles: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="At most about this many for each layer. Fewer is faster and coarser."
        ),
    ] = None,
    shadow: Shadow = None,
    shadow_filter: Annotated[
        str | None,
        typer.Option(
            metavar="FILTER",
            help="The shadow's edge: hard, pcf3, pcf5, filtered (as fine as the picture shows) or soft (the "
            "mean of all images). By default soft in the light of a surface, else pcf3.",
        ),
    ] = None,
    shadow_image: Annotated[
        int,
        typer.Option(
            min=0,
            metavar="N",
            help="Which of the shadow's images, from 0: along a sun's path the time of day.",
        ),
    ] = 0,
    force: Force = False,
    *,
    building: AbstractContextManager["BuildOptions"],
    refining: "RefineOptions",
    telling: Telling,
) -> None:
    """Draw a PNG, the same pixels on every machine.

    Needs no GPU and no display.
    """
    import foveal

    wanted = None if size is None else parse_picture_size(size)
    refuse_output(output, file, ".png", force=force)
    with telling.progress() as progress, building as options:
        chosen: BuildOptions = {**options, **refining}
        picture = foveal.render(
            file,
            output,
            camera=camera,
            size=wanted,
            error_px=error_px,
            triangles=triangles,
            shadow=shadow,
            shadow_filter=shadow_filter,
            shadow_image=shadow_image,
            progress=progress,
            **chosen,
        )
    eye = picture.camera
    telling.result(
        {"file": str(output), "bytes": output.stat().st_size, "camera": eye and eye.to_json()},
        f"{output}: {picture.shape[1]} x {picture.shape[0]} pixels",
    )


def parse_picture_size(text: str) -> tuple[int, int]:
    """Width and height from 1280x720.

    Examples
    --------
    >>> parse_picture_size("1280x720")
    (1280, 720)
    """
    match = re.fullmatch(r"\s*([0-9]{1,5})\s*[x×]\s*([0-9]{1,5})\s*", text.lower())
    if match is None or not 1 <= int(match[1]) <= 16384 or not 1 <= int(match[2]) <= 16384:
        raise typer.BadParameter(
            f"{text!r} is not a size in pixels up to 16384; write for instance 1280x720.", param_hint="--size"
        )
    return int(match[1]), int(match[2])
