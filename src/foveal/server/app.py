"""The ASGI app: the viewer, scene.json, the scene's files by range, and live sessions of its control meshes.

Files can only be read; who wants a session needs the token that only scene.json tells, new in each run.
"""

import re
from collections.abc import Collection

from starlette.routing import Route, Router

from foveal.base.files import PathLike
from foveal.scene import Scene, asset_names, scene_json
from foveal.scene.viewer_files import viewer_files

from .asgi import Receive, Scope, Send, say
from .data_file import DataFile
from .guard import LOCAL_HOSTS, Guard
from .live import Live
from .text_file import TextFile

__all__ = ["create_app"]

_HASHED = re.compile(r".*-[A-Za-z0-9_-]{8}\.[a-z0-9.]+")  # what Vite names by content


def create_app(
    scene: Scene,
    /,
    *,
    viewer: PathLike | None = None,
    hosts: Collection[str] = LOCAL_HOSTS,
    is_public: bool = False,
) -> Guard:
    """An ASGI app that shows `scene` in the viewer.

    It gives out exactly the viewer's files at ``/``, ``/scene.json``, each asset of the scene at
    ``/data/<name>.fov``, and for each control mesh a WebSocket at ``/live/<name>.fov``; nothing is looked up
    on disk by what a request says.

    Parameters
    ----------
    scene : Scene
        What to show.
    viewer
        A folder with a built viewer; by default the one that comes with foveal.
    hosts, is_public
        Which hosts are answered for; see `Guard`.

    Raises
    ------
    FovealError
        If the viewer is not built.
    """
    names = asset_names(scene)
    sessions = {f"/live/{names[layer.path]}": layer for layer in scene.layers if layer.refinement}
    live = Live(sessions)
    addresses = {layer.path: f"{address[1:]}?token={live.token}" for address, layer in sessions.items()}
    text = scene_json(scene, {path: f"data/{name}" for path, name in names.items()}, live=addresses)
    data = {f"/data/{name}": DataFile(path) for path, name in names.items()}
    files = viewer_files(viewer)
    routes = [
        Route("/", TextFile("index.html", files["index.html"])),
        Route("/scene.json", TextFile("scene.json", lambda: text)),
        *(
            Route(f"/{name}", TextFile(name, path, is_immutable=_HASHED.fullmatch(name) is not None))
            for name, path in files.items()
        ),
    ]
    router = Router(routes, redirect_slashes=False, default=_not_found)

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "websocket":
            await live(scope, receive, send)
            return
        # Ranges go ahead of the router, which tries one route after the other.
        asset = data.get(scope["path"]) if scope["type"] == "http" else None
        await (asset or router)(scope, receive, send)

    return Guard(app, hosts=hosts, is_public=is_public)


async def _not_found(scope: Scope, receive: Receive, send: Send) -> None:
    await say(send, 404, "There is nothing at this address.")
