"""foveal shadow: the shadows of a light, precomputed."""

import enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, takes, telling
from .lighting import Lighting, lighting
from .options import Force, Source, Workers
from .output import refuse_output
from .result import counted

if TYPE_CHECKING:
    from foveal.scene.shadow import ShadowReport

__all__ = ["shadow"]

_MOST = 1 << 20


class MethodKind(enum.StrEnum):
    """How the tree is built."""

    optimal = "optimal"
    bottom_up = "bottom-up"
    top_down = "top-down"


class ExitsKind(enum.StrEnum):
    """What counts below open surfaces."""

    surface = "surface"
    strict = "strict"


def parse_resolution(said: str | int) -> int:
    """Pixels a side.

    Examples
    --------
    >>> parse_resolution("65536"), parse_resolution("65,536")
    (65536, 65536)
    """
    text = str(said)  # the default comes by here, too
    plain = text.replace(",", "").replace("_", "")
    number = int(plain) if plain.isascii() and plain.isdigit() and len(plain) < 20 else 0
    if not 2 <= number <= _MOST or number & (number - 1):
        raise typer.BadParameter(
            f"{text!r:.40} is not a power of two from 2 to 1,048,576; write for instance 4096 or 65536."
        )
    return number


@takes(lighting, telling)
def shadow(
    file: Source,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="FILE.fov", help="The shadows to write.", readable=False),
    ],
    resolution: Annotated[
        int,
        typer.Option(
            metavar="N",
            parser=parse_resolution,
            help="Pixels a side: a power of two up to 1,048,576. Twice as many are twice the bytes, about.",
        ),
    ] = 4096,
    method: Annotated[
        MethodKind,
        typer.Option(
            case_sensitive=False, help="optimal is smallest; the others are as in the paper, to compare."
        ),
    ] = MethodKind.optimal,
    exits: Annotated[
        ExitsKind,
        typer.Option(
            case_sensitive=False,
            help="surface is right for what is in the scene; strict also for what moves in it, and larger.",
        ),
    ] = ExitsKind.surface,
    workers: Workers = None,
    force: Force = False,
    *,
    lighting: Lighting,
    telling: Telling,
) -> None:
    """Precompute the shadows of a light.

    They are those of a shadow map of up to a million pixels a side, lossless, in little memory. Of a
    scene.json all visible layers cast, but those that move. Show them with --shadow of view, or as
    "light" of a scene.json.
    """
    import foveal

    refuse_output(output, file, ".fov", force=force)
    with telling.progress() as progress:
        report = foveal.shadow(
            file,
            output,
            light=lighting.light(file, progress),
            resolution=resolution,
            method=method.value,
            exits=exits.value,
            workers=workers,
            progress=progress,
        )
    telling.result({"file": str(output), **report.to_json()}, *_lines(output, report))


def _lines(output: Path, report: "ShadowReport") -> list[str]:
    side, raw = report.resolution, 4 * report.pixels
    maps = report.pixels // side**2
    what = f"{side:,} x {side:,}" + (f", {counted(maps, 'map')}" if maps > 1 else "")
    nodes = ", ".join(f"{count:,} {kind}" for kind, count in report.nodes.items())
    times = ", ".join(f"{phase} {spent:.1f} s" for phase, spent in report.seconds.items())
    total = sum(report.seconds.values())
    return [
        f"{output}: shadows of {counted(report.triangles, 'triangle')}, in {total:.1f} s",
        f"  pixels       {report.pixels:,} ({what})",
        f"  on disk      {report.bytes:,} bytes, 1/{raw / report.bytes:,.0f} of 32 bits a pixel",
        f"  in memory    {report.memory_bytes:,} bytes, 1/{raw / report.memory_bytes:,.0f}",
        f"  nodes        {nodes}",
        f"  time         {times}",
    ]
