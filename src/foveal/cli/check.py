"""foveal check: is a file whole, and are its promises true."""

from pathlib import Path
from typing import Annotated

import typer

from .groups import Telling, takes, telling
from .options import Source

__all__ = ["check"]


@takes(telling)
def check(
    file: Source,
    deep: Annotated[
        bool,
        typer.Option("--deep", help="Also decode all and measure each error bound again. Slow, and sure."),
    ] = False,
    original: Annotated[
        Path | None,
        typer.Option(
            metavar="MESH",
            help="With --deep: measure against this mesh, not the finest level.",
            readable=False,
        ),
    ] = None,
    *,
    telling: Telling,
) -> None:
    """Verify a .fov, or every file of a scene.json.

    Checksums, structure and every patch. Exits with 1 if anything is wrong.
    """
    import foveal

    if original is not None and not deep:
        raise typer.BadParameter("it is for --deep. Add that.", param_hint="--original")
    with telling.progress() as progress:
        facts = foveal.check(file, deep=deep, original=original, progress=progress)
    telling.result(facts, f"{file}: whole, and every promise holds." if deep else f"{file}: whole.")
