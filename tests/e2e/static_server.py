"""A small web server of static files that can misbehave as real ones do: for tests of the viewer only."""

import re
import threading
import time
from collections.abc import Callable
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

__all__ = ["StaticServer"]


class StaticServer:
    """Serves files by address, with ranges or without, and keeps count.

    Attributes
    ----------
    files : dict
        Address (without the first slash) to a path or to bytes.
    has_ranges : bool
        Whether a range is answered with 206; without, all of the file comes with 200.
    delay : float
        Seconds before a range beyond the first of a file is answered.
    spoil : callable
        What is done to the bytes of a range, given (address, start, bytes).
    requests : list of (str, str or None)
        Address and Range header of what was asked.
    most_at_once : int
        The largest number of ranges under way together.
    """

    def __init__(self, files: dict[str, Path | bytes]) -> None:
        self.files = files
        self.has_ranges = True
        self.delay = 0.0
        self.spoil: Callable[[str, int, bytes], bytes] = lambda address, start, data: data
        self.requests: list[tuple[str, str | None]] = []
        self.most_at_once = 0
        self._now = 0
        self._lock = threading.Lock()
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Handler, self))
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True)
        self._thread.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_port}/"

    def read(self, address: str) -> bytes | None:
        """The bytes at an address."""
        file = self.files.get(address)
        if file is None:
            return None
        return file if isinstance(file, bytes) else file.read_bytes()

    def enter(self, step: int) -> None:
        """Count a range that begins (1) or ends (-1)."""
        with self._lock:
            self._now += step
            self.most_at_once = max(self.most_at_once, self._now)

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


class _Handler(SimpleHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    extensions_map = SimpleHTTPRequestHandler.extensions_map | {".js": "text/javascript", ".fov": "model/fov"}

    def __init__(self, owner: StaticServer, *arguments: object) -> None:
        self.owner = owner
        super().__init__(*arguments)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        owner = self.owner
        address = self._address()
        asked = self.headers.get("Range")
        owner.requests.append((address, asked))
        data = owner.read(address)
        if data is None:
            self._answer(404, b"not here", {})
            return
        tag = f'"{hash(data) & 0xFFFFFFFF:08x}"'
        found = re.fullmatch(r"bytes=(\d+)-(\d+)", asked or "")
        is_stale = self.headers.get("If-Range", tag) != tag
        if not found or not owner.has_ranges or is_stale:
            self._answer(200, owner.spoil(address, 0, data), {"ETag": tag, "Cache-Control": "no-store"})
            return
        start, stop = int(found[1]), min(int(found[2]) + 1, len(data))
        owner.enter(1)
        if start:
            time.sleep(owner.delay)
        headers = {
            "ETag": tag,
            "Cache-Control": "no-store",
            "Content-Range": f"bytes {start}-{stop - 1}/{len(data)}",
        }
        self._answer(206, owner.spoil(address, start, data[start:stop]), headers)
        owner.enter(-1)

    def _address(self) -> str:
        return self.path.split("?")[0].lstrip("/") or "index.html"

    def _answer(self, status: int, body: bytes, headers: dict[str, str]) -> None:
        try:
            self.send_response(status)
            for name, value in headers.items():
                self.send_header(name, value)
            self.send_header("Content-Type", self.guess_type(self._address()))
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)
        except OSError:
            pass  # the page went away, or gave the request up

    def log_message(self, *_: object) -> None:
        pass
