"""Small text over HTTP: the viewer's files and the scene, gzipped once and kept."""

import gzip
import hashlib
from collections.abc import Callable
from pathlib import Path

from .asgi import EVERY_ANSWER, Headers, Receive, Scope, Send, finish, say, start
from .conditions import Version, precondition
from .media import accepts_gzip, is_text, media_type

__all__ = ["TextFile"]

_POLICY = "; ".join(
    [
        "default-src 'self'",
        "script-src 'self' 'wasm-unsafe-eval'",  # the decoder is WebAssembly
        "worker-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",  # icons; screenshots on their way to a download
        "object-src 'none'",
        "base-uri 'none'",
        "form-action 'none'",
        # No frame-ancestors: notebooks show the page in a frame, and nothing here can be clicked into harm.
    ]
)
_PAGE: Headers = [
    (b"content-security-policy", _POLICY.encode()),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-embedder-policy", b"require-corp"),
    (b"referrer-policy", b"no-referrer"),
]
"""What browsers may do with pages and scripts. Data goes without: it is no document, and uvicorn checks
each header of each answer, which costs a tenth of the requests a second."""

_WORTH_GZIP = 512  # below this many bytes the headers weigh more than what gzip saves


class TextFile:
    """A small file, or bytes made in memory, kept as it is and gzipped: an ASGI app for its address.

    Ranges are not offered: gzip's bytes and a range's would be easy to mix up, and nobody needs both.

    Parameters
    ----------
    name : str
        File name, for the media type.
    source : Path or function that gives bytes
        Looked at on every request; read again, or gzipped again, only when it changed.
    is_immutable : bool
        Whether the address has a hash of the content in it, so that browsers need never ask again.
    """

    def __init__(
        self, name: str, source: Path | Callable[[], bytes], /, *, is_immutable: bool = False
    ) -> None:
        self._name = name
        self._source = source
        self._cache = b"public, max-age=31536000, immutable" if is_immutable else b"no-cache"
        self._state: object = None
        self._plain = b""
        self._gzipped: bytes | None = None
        self._versions = (Version(b"", None), Version(b"", None))

    def _look(self) -> None:
        if isinstance(self._source, Path):
            status = self._source.stat()
            state: object = (status.st_ino, status.st_size, status.st_mtime_ns)
            if state != self._state:
                self._hold(self._source.read_bytes(), int(status.st_mtime))
        else:
            state = self._source()
            if state != self._state:
                self._hold(state, None)
        self._state = state

    def _hold(self, content: bytes, modified: int | None) -> None:
        self._plain, self._gzipped = content, None
        if is_text(self._name) and len(content) > _WORTH_GZIP:
            packed = gzip.compress(content, 6, mtime=0)
            self._gzipped = packed if len(packed) < len(content) else None
        digest = hashlib.sha256(content).hexdigest()[:24].encode()
        # Two strong tags, as the bytes on the wire differ.
        self._versions = (Version(b'"%s"' % digest, modified), Version(b'"%s-gz"' % digest, modified))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a GET or HEAD for this file."""
        try:
            self._look()
        except OSError:
            await say(send, 404, f"{self._name} is not there any more. Reload the page.")
            return
        asked: dict[bytes, bytes] = dict(scope["headers"])
        is_gzipped = self._gzipped is not None and accepts_gzip(asked.get(b"accept-encoding"))
        version = self._versions[is_gzipped]
        headers = [*EVERY_ANSWER, *_PAGE, (b"cache-control", self._cache), *version.headers()]
        if self._gzipped is not None:
            headers.append((b"vary", b"accept-encoding"))
        if (status := precondition(asked, version)) is not None:
            await _stop_early(send, status, headers)
            return
        body = self._gzipped if is_gzipped and self._gzipped is not None else self._plain
        headers.append((b"content-type", media_type(self._name).encode()))
        headers.append((b"content-length", b"%d" % len(body)))
        if is_gzipped:
            headers.append((b"content-encoding", b"gzip"))
        await start(send, 200, headers)
        await finish(send, body if scope["method"] == "GET" else b"")


async def _stop_early(send: Send, status: int, headers: Headers) -> None:
    if status == 412:
        await say(send, 412, "The file changed meanwhile.")
    else:
        await start(send, status, headers)
        await finish(send)
