"""foveal view: build if needed, serve, open the browser."""

from typing import Annotated

import typer

from .options import Bits, Dask, Debug, Memory, Normals, Quiet, Source, Step, Up, Verbose, Workers
from .report import reporter
from .work import build_arguments, dask_executor, refuse_missing

__all__ = ["view"]


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
    bits: Bits = None,
    step: Step = None,
    normals: Normals = None,
    up: Up = None,
    memory: Memory = None,
    workers: Workers = None,
    dask: Dask = None,
    quiet: Quiet = False,
    verbose: Verbose = False,
    debug: Debug = False,
) -> None:
    """Show a mesh, a .fov or a scene.json in the browser.

    A mesh is built first, with a progress bar; the result is kept in your cache (10 GB, the least used go
    first), so that the second time is at once. Ctrl-C ends the server.
    """
    from foveal.scene.prepare import load
    from foveal.scene.viewer_files import viewer_files
    from foveal.server.run import serve

    refuse_missing(file)
    viewer_files()  # if the viewer is missing, say so before minutes of building
    with reporter(is_quiet=quiet, is_verbose=verbose) as progress, dask_executor(dask) as executor:
        scene = load(
            file,
            **build_arguments(
                bits=bits,
                step=step,
                normals=normals,
                up=up,
                memory=memory,
                workers=workers,
                executor=executor,
                progress=progress,
            ),
        )

    def announce(url: str) -> None:
        print(url if quiet else f"{url}   (Ctrl-C ends it)", flush=True)

    serve(scene, host=host, port=port, open_browser=False if no_browser else None, announce=announce)
