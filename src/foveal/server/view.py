"""Show something in the viewer: build it if needed, serve it, open the browser."""

import sys
import threading
import webbrowser
from typing import Unpack

from foveal.base.files import PathLike
from foveal.base.progress import SILENT, Progress
from foveal.scene import Scene
from foveal.scene.build import BuildOptions
from foveal.scene.prepare import load
from foveal.scene.source import Source
from foveal.scene.viewer_files import viewer_files

from .run import Running, can_open_browser, refuse_address, start

__all__ = ["view"]


def view(
    source: Source | Scene,
    /,
    *,
    host: str = "127.0.0.1",
    port: int | None = None,
    open_browser: bool | None = None,
    viewer: PathLike | None = None,
    shadow: PathLike | None = None,
    progress: Progress = SILENT,
    **options: Unpack[BuildOptions],
) -> Running:
    """Show a mesh, a `.fov` or a scene.json in the viewer, without waiting for it to be closed.

    Control meshes (`scheme="sqrt3"`, or a `.fov` of one) are refined here, as the page's camera moves.

    Parameters
    ----------
    source : path, TriMesh, PolyMesh or Scene
        What to show; a mesh is built into the user's cache first.
    host, port
        Where to serve; by default on this machine alone, from port 8000 on.
    open_browser : bool, optional
        By default, where there is a display and this is no notebook, which shows the viewer inline.
    viewer
        A folder with a built viewer; by default the one that comes with foveal.
    shadow
        A `.fov` that `foveal.shadow` made: the light of the scene, in place of its own.
    progress, **options
        As for `build`.

    Returns
    -------
    Running
        With `url`; `close()` ends it, `wait()` waits for Ctrl-C, which a script needs that would else
        end. Shown in a notebook, it is the viewer.

    Raises
    ------
    FovealError
        If the source cannot be used, the viewer is not built, or the address cannot be served on.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> built = pathlib.Path(tempfile.mkdtemp())  # stands in for the viewer that comes with foveal
    >>> _ = (built / "index.html").write_text("<!doctype html><title>foveal</title>")
    >>> with foveal.view(icosphere(2), viewer=built, open_browser=False) as shown:
    ...     shown.url.startswith("http://127.0.0.1:")
    True
    """
    viewer_files(viewer)  # if it is missing, say so before minutes of building; so for the address
    refuse_address(host, port)
    scene = load(source, shadow=shadow, progress=progress, **options)
    running = start(scene, host=host, port=port, viewer=viewer, progress=progress)
    if open_browser is None:
        open_browser = "ipykernel" not in sys.modules and can_open_browser()
    if open_browser:  # apart, as browsers of text do not return before they are closed
        threading.Thread(target=webbrowser.open, args=(running.url,), daemon=True).start()
    return running
