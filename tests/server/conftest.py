"""A small scene, a stand-in for the built viewer, and a client that speaks ASGI without sockets."""

import asyncio
import gzip
import json
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

import numpy as np
import pytest

from foveal.scene import Layer, Scene
from foveal.server import create_app

SIZE = 3_000_000


@pytest.fixture(scope="session")
def content() -> bytes:
    return np.random.default_rng(1).integers(0, 256, SIZE, dtype=np.uint8).tobytes()


@pytest.fixture
def viewer(tmp_path: Path) -> Path:
    folder = tmp_path / "viewer"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<!doctype html><title>foveal</title>" + "<p>a page</p>" * 200)
    (folder / "assets" / "index-0a1B2c3D.js").write_text("console.log(1)\n" * 100)
    (folder / "assets" / "decoder-9f8E7d6C.wasm").write_bytes(b"\0asm" + bytes(2000))
    (folder / ".hidden").write_text("a secret")
    (tmp_path / "outside.txt").write_text("a secret")
    (folder / "leak.txt").symlink_to(tmp_path / "outside.txt")
    return folder


@pytest.fixture
def scene(tmp_path: Path, content: bytes) -> Scene:
    path = tmp_path / "statue.fov"
    path.write_bytes(content)
    return Scene("A statue", (Layer("statue", path),))


@pytest.fixture
def app(scene: Scene, viewer: Path):
    return create_app(scene, viewer=viewer)


@dataclass
class Answer:
    status: int
    header_list: list[tuple[str, str]]
    raw: bytes

    @property
    def headers(self) -> dict[str, str]:
        assert len(dict(self.header_list)) == len(self.header_list), "a header is there twice"
        return dict(self.header_list)

    @property
    def content(self) -> bytes:
        return gzip.decompress(self.raw) if self.headers.get("content-encoding") == "gzip" else self.raw

    @property
    def text(self) -> str:
        return self.content.decode()

    def json(self):
        return json.loads(self.content)


class Client:
    """Asks an ASGI app as uvicorn would, and holds the app to the protocol."""

    def __init__(self, app) -> None:
        self.app = app

    def get(self, path, headers=None) -> Answer:
        return self.request("GET", path, headers)

    def head(self, path, headers=None) -> Answer:
        answer = self.request("HEAD", path, headers)
        assert answer.raw == b""
        return answer

    def request(self, method, path, headers=None) -> Answer:
        pairs = [(name.lower(), value) for name, value in (headers or {}).items()]
        if "host" not in dict(pairs):
            pairs.insert(0, ("host", "127.0.0.1:8000"))
        return self.send(method, path, pairs)

    def send(self, method, path, pairs) -> Answer:
        scope = {
            "type": "http",
            "method": method,
            "path": unquote(path),
            "raw_path": path.encode(),
            "root_path": "",
            "query_string": b"",
            "headers": [(name.encode(), value.encode("latin-1")) for name, value in pairs],
        }
        return asyncio.run(self._run(scope))

    async def _run(self, scope) -> Answer:
        begin, body, is_complete = None, b"", False
        requests = [{"type": "http.request", "body": b"", "more_body": False}]

        async def receive():
            if requests:
                return requests.pop()
            await asyncio.Event().wait()  # the client stays

        async def send(message):
            nonlocal begin, body, is_complete
            assert not is_complete
            if message["type"] == "http.response.start":
                assert begin is None
                begin = message
            else:
                assert begin is not None
                body += message.get("body", b"")
                is_complete = not message.get("more_body", False)

        await self.app(scope, receive, send)
        assert is_complete
        pairs = [(name.decode(), value.decode("latin-1")) for name, value in begin["headers"]]
        assert all(name == name.lower() for name, _ in pairs)
        length = dict(pairs).get("content-length")
        if scope["method"] == "GET" and begin["status"] != 304:
            assert length == str(len(body))
        return Answer(begin["status"], pairs, body)


@pytest.fixture
def client(app) -> Client:
    return Client(app)


@pytest.fixture
def client_of():
    return Client
