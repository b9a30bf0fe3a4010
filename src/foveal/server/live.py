"""Live sessions: each page's own refinement of a control mesh, over a WebSocket, as spec/wire.md has it."""

import asyncio
import json
import secrets
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING
from urllib.parse import parse_qs

from starlette.websockets import WebSocket, WebSocketDisconnect

from foveal.base.errors import FovealError
from foveal.base.tasks import threads
from foveal.scene import Layer

from .asgi import Receive, Scope, Send, refuse

if TYPE_CHECKING:
    from foveal.refine.dialogue import Dialogue

__all__ = ["MAX_SESSIONS", "Live"]

MAX_SESSIONS = 16
"""At once: each holds a refinement of its own, 400 MB at most."""

_THEIRS, _OURS = 1008, 1011  # whose fault it is that a WebSocket is closed


class Live:
    """An ASGI app for the WebSockets of a scene's control meshes.

    A session's kernels run in a thread, one update at a time, on as many threads as there are processors for
    all sessions together. What a page asks meanwhile waits in one place, where the newest replaces the rest.

    Parameters
    ----------
    layers : mapping of str to Layer
        Control meshes by address.

    Attributes
    ----------
    token : str
        What an address must have in `?token=`; of this run only.
    sessions : int
        How many there are at the moment.
    """

    def __init__(self, layers: Mapping[str, Layer], /) -> None:
        self.token = secrets.token_urlsafe(18)
        self.sessions = 0
        self._layers = dict(layers)
        self._pool: ThreadPoolExecutor | None = None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one WebSocket until either side leaves."""
        layer = self._layers.get(scope["path"])
        tokens = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        is_known = len(tokens) == 1 and secrets.compare_digest(tokens[0].encode(), self.token.encode())
        if layer is None or not is_known or self.sessions >= MAX_SESSIONS:
            await refuse(send)
            return
        self._pool = self._pool or threads()
        socket = WebSocket(scope, receive, send)
        self.sessions += 1
        try:
            await socket.accept()
            await self._follow(socket, layer)
        except WebSocketDisconnect:
            pass
        finally:
            self.sessions -= 1

    async def _follow(self, socket: WebSocket, layer: Layer) -> None:
        """Listen and answer side by side; whichever ends, ends the other."""
        loop = asyncio.get_running_loop()
        try:
            session = await loop.run_in_executor(self._pool, _session, layer)
        except FovealError as error:
            await _end(socket, str(error), _OURS)
            return
        asked = asyncio.Event()
        tasks = [
            asyncio.create_task(_listen(socket, session, asked)),
            asyncio.create_task(self._answer(socket, session, asked)),
        ]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
        why = done.pop().exception()
        if isinstance(why, FovealError | _RefinementError):
            await _end(socket, str(why), _THEIRS if isinstance(why, FovealError) else _OURS)
        elif why is not None:
            raise why

    async def _answer(self, socket: WebSocket, session: "Dialogue", asked: asyncio.Event) -> None:
        """Send what the session says, each message when the one before is acknowledged."""
        loop = asyncio.get_running_loop()
        while True:
            await asked.wait()
            asked.clear()
            try:
                message = await loop.run_in_executor(self._pool, session.answer)
            except Exception as error:
                what = " ".join(f"{type(error).__name__}: {error}".split())
                raise _RefinementError(
                    f"The refinement failed ({what:.300}). Reload the page to begin anew."
                ) from error
            if message is not None:
                await socket.send_bytes(message)


class _RefinementError(Exception):
    """What a page is told where its refinement failed."""


def _session(layer: Layer) -> "Dialogue":
    """A refinement of a layer's control mesh of its own."""
    from foveal.scene.cage_file import read_cage

    from .warm import begun

    assert layer.refinement is not None
    cage = read_cage(layer.path)
    return begun(cage, layer.refinement.scheme, layer.path.name)


async def _listen(socket: WebSocket, session: "Dialogue", asked: asyncio.Event) -> None:
    """Hand on requests as they come, the last in place of those before it."""
    from foveal.refine.wire import request_of

    while True:
        received = await socket.receive()
        if received["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(received.get("code", 1005))
        text = received.get("text")
        if text is None:
            raise FovealError("request: it must be a text message.")
        session.ask(request_of(text))
        asked.set()


async def _end(socket: WebSocket, sentence: str, code: int) -> None:
    await socket.send_text(json.dumps({"error": sentence}))
    await socket.close(code)
