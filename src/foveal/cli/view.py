"""foveal view: build if needed, serve, open the browser."""

from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Annotated

import typer

from .groups import Telling, building, refining, takes, telling
from .options import Shadow, Source

if TYPE_CHECKING:
    from foveal.scene.build import BuildOptions
    from foveal.scene.refinement import RefineOptions

__all__ = ["view"]


@takes(building, refining, telling)
def view(
    file: Source,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only print the address.")] = False,
    port: Annotated[
        int | None,
        typer.Option(
            min=0, max=65535, metavar="N", help="Port; by default 8000. If taken, the next free one."
        ),
    ] = None,
    host: Annotated[
        str,
        typer.Option(
            "--bind", metavar="ADDRESS", help="Address to serve on. 0.0.0.0 lets other machines in."
        ),
    ] = "127.0.0.1",
    rate: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            max=1000.0,
            metavar="FPS",
            help="Frames a second to be held while a control mesh is refined; 0 for no such wish.",
        ),
    ] = None,
    shadow: Shadow = None,
    *,
    building: AbstractContextManager["BuildOptions"],
    refining: "RefineOptions",
    telling: Telling,
) -> None:
    """Show a mesh, a .fov or a scene.json in the browser.

    A mesh is built first, with a progress bar; the result is kept in your cache (10 GB, the least used go
    first), so that the second time is at once. With --scheme it is a control mesh, and the server refines it
    where it is looked at. Ctrl-C ends the server.
    """
    import foveal

    is_wanted = False if no_browser else None
    with telling.progress() as progress, building as options:
        chosen: BuildOptions = {**options, **refining, "rate": rate}
        running = foveal.view(
            file,
            host=host,
            port=port,
            open_browser=is_wanted,
            shadow=shadow,
            progress=progress,
            **chosen,
        )
    with running:
        telling.result({"url": running.url}, f"{running.url}   (Ctrl-C ends it)", brief=running.url)
        running.wait()
