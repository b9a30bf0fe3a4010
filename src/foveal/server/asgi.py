"""The few words of ASGI that the files speak, and answers in plain text."""

from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any

__all__ = ["EVERY_ANSWER", "App", "Headers", "Receive", "Scope", "Send", "finish", "refuse", "say", "start"]

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]
Headers = list[tuple[bytes, bytes]]

EVERY_ANSWER: Headers = [
    (b"x-content-type-options", b"nosniff"),
    (b"cross-origin-resource-policy", b"same-origin"),
]
"""What goes with every answer: the type is what it says, and other sites may not embed it."""


async def start(send: Send, status: int, headers: Headers, /) -> None:
    """Begin an answer."""
    await send({"type": "http.response.start", "status": status, "headers": headers})


async def finish(send: Send, body: bytes = b"", /) -> None:
    """Send the whole body, or the last of it."""
    await send({"type": "http.response.body", "body": body})


async def refuse(send: Send, /) -> None:
    """Answer a WebSocket that was not accepted yet: closing it so is a 403."""
    await send({"type": "websocket.close", "code": 1008})


async def say(send: Send, status: int, sentence: str, headers: Headers | None = None, /) -> None:
    """Answer with a sentence in plain text."""
    body = (sentence + "\n").encode()
    fixed = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", b"%d" % len(body))]
    await start(send, status, [*EVERY_ANSWER, *fixed, *(headers or [])])
    await finish(send, body)
