"""foveal publish: a folder for any web server."""

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, building, refining, takes, telling
from .options import Shadow, Source

if TYPE_CHECKING:
    from foveal.scene.build import BuildOptions
    from foveal.scene.refinement import RefineOptions

__all__ = ["publish"]


@takes(building, refining, telling)
def publish(
    file: Source,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="New or empty.", readable=False)
    ],
    force: Annotated[bool, typer.Option("--force", help="Replace what was published there before.")] = False,
    shadow: Shadow = None,
    *,
    building: AbstractContextManager["BuildOptions"],
    refining: "RefineOptions",
    telling: Telling,
) -> None:
    """Make a web site: static files for any server.

    Servers that answer byte ranges send only what is looked at; without ranges it works too.
    """
    import foveal

    with telling.progress() as progress, building as options:
        chosen: BuildOptions = {**options, **refining}
        foveal.publish(file, output, force=force, shadow=shadow, progress=progress, **chosen)
    files = [path for path in output.rglob("*") if path.is_file()]
    size = sum(path.stat().st_size for path in files)
    telling.result(
        {"folder": str(output), "files": len(files), "bytes": size},
        f"{output}: {len(files)} files, {size:,} bytes. README.txt in it says how to host them.",
    )
