"""Run the server: on a free port, in a thread of its own, until it is closed."""

import errno
import os
import socket
import sys
import threading
import time
from dataclasses import dataclass, field

import uvicorn

from foveal.base.errors import FovealError
from foveal.base.files import PathLike
from foveal.base.progress import SILENT, Progress
from foveal.scene import Scene

from .app import create_app
from .guard import LOCAL_HOSTS
from .warm import warm

__all__ = ["FIRST_PORT", "Running", "can_open_browser", "refuse_address", "start"]

FIRST_PORT = 8000
_TRIES = 100
_EVERYWHERE = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}  # and by which address it is shown here


def _listen(host: str, port: int | None) -> socket.socket:
    """A listening socket on `port`, or on the next free one after it; 0 lets the system choose."""
    first = FIRST_PORT if port is None else port
    if not 0 <= first <= 65535:
        raise FovealError(f"{first} is no port. Choose a --port from 0 to 65535.")
    host = host.strip("[]")
    if not host:  # to the system that would be all interfaces
        raise FovealError("no address to serve on is named. Choose a --bind, such as 127.0.0.1.")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    last: Exception | None = None
    for candidate in range(first, min(first + _TRIES, 65536)) if first else [0]:
        # With the protocol left at 0 asyncio does not see that this is TCP and leaves Nagle's algorithm on:
        # each answer then waits 40 ms (measured: 365 requests a second, against 15,000).
        listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
        try:
            if sys.platform == "win32":  # there SO_REUSEADDR would let two servers share a port
                listener.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
            else:
                listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listener.bind((host, candidate))
            listener.listen(2048)
            return listener
        except (OSError, UnicodeError) as error:
            listener.close()
            last = error
            is_name = isinstance(error, (socket.gaierror, UnicodeError))
            if is_name or getattr(error, "errno", None) == errno.EADDRNOTAVAIL:
                raise FovealError(
                    f"{host}: this machine has no such address ({getattr(error, 'strerror', error)}). "
                    "Choose another --bind, such as 127.0.0.1, or 0.0.0.0 for all it has."
                ) from error
    reason = getattr(last, "strerror", None) or last
    raise FovealError(
        f"{host}: no port from {first} on can be listened on ({reason}). Choose another --port."
    )


def refuse_address(host: str, port: int | None, /) -> None:
    """Say before any work that nothing can be served there.

    Raises
    ------
    FovealError
        If this machine has no such address, or no port from `port` on is free.
    """
    _listen(host, port).close()


@dataclass
class Running:
    """A server in the background; in a notebook it shows itself as a frame.

    Attributes
    ----------
    url : str
        Where the viewer is.
    """

    url: str
    _server: uvicorn.Server = field(repr=False)
    _thread: threading.Thread = field(repr=False)

    def close(self) -> None:
        """Stop serving; further calls do nothing."""
        self._server.should_exit = True
        self._thread.join(timeout=5)

    def wait(self) -> None:
        """Wait until the server ends or Ctrl-C, then close it."""
        try:
            while self._thread.is_alive():
                self._thread.join(timeout=0.5)
        except KeyboardInterrupt:
            pass
        finally:
            self.close()

    def __enter__(self) -> "Running":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        return (
            f'<iframe src="{self.url}" title="foveal viewer" allow="fullscreen" '
            'style="width: 100%; height: 600px; border: 0"></iframe>'
        )


def start(
    scene: Scene,
    /,
    *,
    host: str = "127.0.0.1",
    port: int | None = None,
    viewer: PathLike | None = None,
    progress: Progress = SILENT,
) -> Running:
    """Serve `scene` in a thread and return when requests are answered.

    That is at once, but for control meshes: their kernels are compiled first, 40 s once for a scheme.

    Parameters
    ----------
    scene : Scene
        What to show.
    host : str
        Address to bind. Anything but the default lets other machines in.
    port : int, optional
        Port to bind, by default 8000; if it is taken the next free one. 0 lets the system choose.
    viewer
        A folder with a built viewer; by default the one that comes with foveal.
    progress : Progress
        Told of what takes long.

    Raises
    ------
    FovealError
        If the viewer is not built, no port can be had, or a control mesh is no surface.
    """
    host = host.strip("[]")
    name = f"[{host}]" if ":" in host else host
    is_public = host in _EVERYWHERE
    hosts = {*LOCAL_HOSTS, name.lower(), *({socket.gethostname().lower()} if is_public else ())}
    warm(scene, progress=progress)
    app = create_app(scene, viewer=viewer, hosts=hosts, is_public=is_public)
    listener = _listen(host, port)
    config = uvicorn.Config(
        app,
        log_level="warning",
        access_log=False,
        server_header=False,
        proxy_headers=False,  # nobody is to tell us who asks
        lifespan="off",
        ws="websockets-sansio",
        ws_max_size=1 << 16,  # a request has at most a quarter; up to here a sentence says so
        ws_per_message_deflate=False,  # half the bytes, but 7 ms of every frame (29 MB/s)
        timeout_graceful_shutdown=2,
        timeout_keep_alive=60,
    )
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, args=([listener],), name="foveal-server", daemon=True)
    thread.start()
    while not server.started and thread.is_alive():
        time.sleep(0.01)
    return Running(f"http://{_EVERYWHERE.get(host, name)}:{listener.getsockname()[1]}/", server, thread)


def can_open_browser() -> bool:
    """Whether there is a display that a browser could be opened on."""
    if sys.platform in ("win32", "darwin"):
        return not os.environ.get("SSH_CONNECTION")
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
