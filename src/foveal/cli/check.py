"""foveal check: is a file whole, and are its promises true."""

from pathlib import Path
from typing import Annotated, Any

import typer

from .options import Debug, Json, Quiet, Source, Verbose
from .report import print_json, reporter

__all__ = ["check"]


def check(
    file: Source,
    deep: Annotated[
        bool,
        typer.Option("--deep", help="Also decode all and measure each error bound again. Slow, and sure."),
    ] = False,
    original: Annotated[
        Path | None,
        typer.Option(metavar="MESH", help="With --deep: measure against this mesh, not the finest level."),
    ] = None,
    json: Json = False,
    quiet: Quiet = False,
    verbose: Verbose = False,
    debug: Debug = False,
) -> None:
    """Verify a .fov, or every file of a scene.json.

    Checksums, structure and every patch. Exits with 1 if anything is wrong.
    """
    from foveal.scene.check import check as verify

    if original is not None and not deep:
        raise typer.BadParameter("it is for --deep. Add that.", param_hint="--original")
    with reporter(is_quiet=quiet, is_verbose=verbose) as progress:
        facts: dict[str, Any] = verify(file, deep=deep, original=original, progress=progress)
    if json:
        print_json(facts)
    elif not quiet:
        print(f"{file}: whole, and every promise holds." if deep else f"{file}: whole.")
