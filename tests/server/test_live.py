"""Live sessions: who is let in, what a page gets, and what becomes of pages that are slow, wrong or gone."""

import asyncio
import gc
import json
import threading
import time
import weakref
from urllib.request import urlopen

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from foveal import FovealError
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.refine import Criteria, Sqrt3
from foveal.refine.session import Session
from foveal.refine.wire import request_of
from foveal.scene import Layer, Scene
from foveal.scene.cage_file import write_cage
from foveal.scene.refinement import Refinement
from foveal.server import create_app, live, start
from refine.wire_page import Page, wish

HOST = "127.0.0.1:8000"
REFINEMENT = Refinement("sqrt3", Criteria())


@pytest.fixture
def cages(tmp_path, content):
    """A control mesh, and a file of patches, which has no session."""
    path, other = tmp_path / "ball.fov", tmp_path / "statue.fov"
    write_cage(icosphere(1), path, refinement=REFINEMENT)
    other.write_bytes(content)
    return Scene("two", (Layer("ball", path, refinement=REFINEMENT), Layer("statue", other)))


@pytest.fixture
def running(cages, viewer):
    with start(cages, port=0, viewer=viewer) as server:
        yield server


def address_of(app):
    """The session's address as the served scene.json tells it: path and query."""

    async def read():
        sent = []
        scope = {"type": "http", "method": "GET", "path": "/scene.json", "query_string": b""}
        headers = [(b"host", HOST.encode())]

        async def send(message):
            sent.append(message)

        await app({**scope, "headers": headers, "root_path": ""}, None, send)
        return json.loads(sent[1]["body"])

    layers = asyncio.run(read())["layers"]
    assert "live" not in layers[1]
    return layers[0]["live"]


class Socket:
    """One end of a WebSocket, without a network: what the page sends, and what it got."""

    def __init__(self, app, address, *, host=HOST, origin=f"http://{HOST}"):
        path, _, query = f"/{address}".partition("?")
        pairs = [(b"host", host), (b"origin", origin)]
        self.scope = {
            "type": "websocket",
            "path": path,
            "query_string": query.encode(),
            "headers": [(name, value.encode()) for name, value in pairs if value is not None],
            "root_path": "",
        }
        self.app = app
        self.got = asyncio.Queue()
        self.asked = asyncio.Queue()
        self.asked.put_nowait({"type": "websocket.connect"})

    async def __aenter__(self):
        async def send(message):
            await self.got.put(message)

        self.task = asyncio.create_task(self.app(self.scope, self.asked.get, send))
        self.first = await self.next()
        return self

    async def __aexit__(self, *_):
        self.leave()
        await asyncio.wait_for(self.task, 30)

    async def next(self):
        return await asyncio.wait_for(self.got.get(), 60)

    def ask(self, text):
        self.asked.put_nowait({"type": "websocket.receive", "text": text})

    def leave(self):
        self.asked.put_nowait({"type": "websocket.disconnect", "code": 1001})


def run(coroutine):
    return asyncio.run(asyncio.wait_for(coroutine, 120))


def test_a_page_is_let_in_and_gets_what_it_asks_for(cages, viewer):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)

    async def follow():
        page = Page()
        async with Socket(app, address) as socket:
            assert socket.first["type"] == "websocket.accept"
            for angle in (0, 0, 0.5):
                socket.ask(json.dumps(wish(seen=page.sequence, angle=angle)))
                if angle or not page.sequence:
                    page.apply((await socket.next())["bytes"])
        return page

    page = run(follow())
    assert page.sequence == 2
    assert page.head["is_settled"]
    assert page.head["triangles"] == sum(face != (0, 0, 0) for face in page.faces) > 80


def refused(app, address, **headers):
    async def knock():
        async with Socket(app, address, **headers) as socket:
            return socket.first

    return run(knock())["type"] == "websocket.close"


def test_who_is_not_let_in(cages, viewer):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)
    path = address.partition("?")[0]
    assert not refused(app, address)
    assert not refused(app, address, host="localhost:8000", origin="http://localhost:8000")
    assert not refused(app, address, origin=f"https://{HOST}")  # behind a proxy
    assert refused(app, address, origin=None)
    assert refused(app, address, origin="null")
    assert refused(app, address, origin="http://evil.example")
    assert refused(app, address, origin="http://127.0.0.1:8001")  # another server of this machine
    assert refused(app, address, origin=f"http://{HOST}.evil.example")
    assert refused(app, address, host="evil.example", origin="http://evil.example")
    assert refused(app, address, host=None)
    assert refused(app, path)
    assert refused(app, f"{path}?token=")
    assert refused(app, f"{address[:-1]}")
    assert refused(app, f"{address}&token=x")
    assert refused(app, f"{path}?token=%ff%00%c3%a9")
    assert refused(app, address.replace("ball", "statue"))  # patches
    assert refused(app, address.replace("live/ball", "data/ball"))
    assert refused(app, address.replace("live/ball", "live/../live/ball"))
    assert refused(app, "?token=")


def test_the_token_is_new_in_each_run(cages, viewer):
    assert address_of(create_app(cages, viewer=viewer)) != address_of(create_app(cages, viewer=viewer))


def test_a_session_too_many_is_refused_and_its_place_is_free_again(cages, viewer, monkeypatch):
    monkeypatch.setattr(live, "MAX_SESSIONS", 2)
    app = create_app(cages, viewer=viewer)
    address = address_of(app)

    async def knock():
        sockets = [Socket(app, address) for _ in range(3)]
        async with sockets[0], sockets[1], sockets[2]:
            found = [socket.first["type"] for socket in sockets]
        async with Socket(app, address) as again:
            return [*found, again.first["type"]]

    assert run(knock()) == [f"websocket.{what}" for what in ("accept", "accept", "close", "accept")]


@pytest.mark.parametrize(
    "text",
    ["", "hello", "{}", "[]", "\0", "[" * 5000, " " * 20_000, json.dumps(wish(seen=7)), '{"seen": 0}'],
)
def test_garbage_gets_a_sentence_and_a_close(cages, viewer, text):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)

    async def follow():
        async with Socket(app, address) as socket:
            socket.ask(text)
            return await socket.next(), await socket.next()

    said, closed = run(follow())
    assert json.loads(said["text"])["error"].endswith(".")
    assert closed == {"type": "websocket.close", "code": 1008, "reason": ""}


def test_bytes_get_a_sentence_too(cages, viewer):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)

    async def follow():
        async with Socket(app, address) as socket:
            socket.asked.put_nowait({"type": "websocket.receive", "bytes": b"\x00\x01"})
            return await socket.next()

    assert "text" in json.loads(run(follow())["text"])["error"]


def test_what_fails_in_a_kernel_is_a_sentence(cages, viewer, monkeypatch):
    def fail(*_, **__):
        raise MemoryError("no room for 900 GB")

    monkeypatch.setattr(Sqrt3, "update", fail)
    app = create_app(cages, viewer=viewer)
    address = address_of(app)

    async def follow():
        async with Socket(app, address) as socket:
            socket.ask(json.dumps(wish()))
            return await socket.next(), await socket.next()

    said, closed = run(follow())
    assert "no room for 900 GB" in json.loads(said["text"])["error"]
    assert closed["code"] == 1011


def test_a_file_that_went_away_is_a_sentence(cages, viewer):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)
    cages.layers[0].path.unlink()

    async def follow():
        async with Socket(app, address) as socket:
            return await socket.next(), await socket.next()

    said, closed = run(follow())
    assert "no such file" in json.loads(said["text"])["error"]
    assert closed["code"] == 1011


def test_a_slow_page_gets_one_message_and_then_the_newest(cages, viewer):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)

    async def follow():
        page = Page()
        async with Socket(app, address) as socket:
            for i in range(200):  # nothing acknowledged, nothing read
                socket.ask(json.dumps(wish(angle=0.01 * i)))
                await asyncio.sleep(0.001)
            await asyncio.sleep(0.3)
            waiting = socket.got.qsize()
            page.apply((await socket.next())["bytes"])
            while not page.head["is_settled"]:
                socket.ask(json.dumps(wish(angle=2.0, seen=page.sequence)))
                page.apply((await socket.next())["bytes"])
            socket.ask(json.dumps(wish(angle=2.0, seen=page.sequence)))
        return waiting, page

    waiting, page = run(follow())
    assert waiting == 1
    assert page.sequence <= 3


def test_a_page_that_leaves_frees_its_session(cages, viewer, monkeypatch):
    app = create_app(cages, viewer=viewer)
    address = address_of(app)
    sessions, is_working, may_end = weakref.WeakSet(), threading.Event(), threading.Event()
    answer = Session.answer

    def slow(self):
        sessions.add(self)
        is_working.set()
        may_end.wait(20)
        return answer(self)

    monkeypatch.setattr(Session, "answer", slow)

    async def follow():
        async with Socket(app, address) as socket:
            socket.ask(json.dumps(wish()))
            await asyncio.to_thread(is_working.wait, 20)
            begin = time.perf_counter()  # gone in the middle of an update
        left = time.perf_counter() - begin
        may_end.set()
        return left

    assert run(follow()) < 5
    for _ in range(100):
        gc.collect()
        if not sessions:
            break
        time.sleep(0.05)
    assert not sessions


def url_of(server):
    with urlopen(f"{server.url}scene.json") as answer:
        layer = json.load(answer)["layers"][0]
    return f"ws{server.url[4:]}{layer['live']}", server.url[:-1]


def test_two_pages_on_sockets_each_with_a_view_of_its_own(running):
    url, origin = url_of(running)
    with connect(url, origin=origin, compression=None) as one, connect(url, origin=origin) as two:
        for socket, angle in ((one, 0.0), (two, 3.0)):
            page = Page()
            for turn in range(3):
                socket.send(json.dumps(wish(angle=angle + 0.1 * turn, seen=page.sequence)))
                page.apply(socket.recv(timeout=60))
            assert page.sequence == 3
            assert page.head["is_settled"]


def test_on_sockets_strangers_are_refused_and_garbage_is_told(running):
    url, origin = url_of(running)
    for options in ({"origin": "http://evil.example"}, {}):
        with pytest.raises(InvalidStatus, match="403"):
            connect(url, **options)
    with pytest.raises(InvalidStatus, match="403"):
        connect(url[:-1], origin=origin)
    with connect(url, origin=origin) as socket:
        socket.send("no JSON")
        assert "error" in json.loads(socket.recv(timeout=60))
        with pytest.raises(ConnectionClosed):
            socket.recv(timeout=60)
        assert socket.close_code == 1008
    with connect(url, origin=origin) as socket:
        socket.send(" " * 100_000)
        with pytest.raises(ConnectionClosed):
            socket.recv(timeout=60)
        assert socket.close_code == 1009


def test_the_server_ends_while_pages_are_there(cages, viewer):
    server = start(cages, port=0, viewer=viewer)
    url, origin = url_of(server)
    with connect(url, origin=origin) as socket:
        socket.send(json.dumps(wish()))
        socket.recv(timeout=60)
        begin = time.perf_counter()
        server.close()
        assert time.perf_counter() - begin < 4


def test_a_larger_mesh_over_sockets_is_what_it_is_without(tmp_path, viewer):
    path, mesh = tmp_path / "bumpy.fov", bumpy_sphere(3)
    write_cage(mesh, path, refinement=REFINEMENT)
    scene = Scene("bumpy", (Layer("bumpy", path, refinement=REFINEMENT),))
    with start(scene, port=0, viewer=viewer) as server:
        url, origin = url_of(server)
        page = Page()
        with connect(url, origin=origin, compression=None, max_size=None) as socket:
            while not page.head.get("is_settled"):
                socket.send(json.dumps(wish(edge_px=2, iterations=5, seen=page.sequence)))
                page.apply(socket.recv(timeout=60))
    alone, session = Page(), Session(mesh)
    while not alone.head.get("is_settled"):
        session.ask(request_of(json.dumps(wish(edge_px=2, iterations=5, seen=alone.sequence))))
        alone.apply(session.answer())
    assert page.head["triangles"] == alone.head["triangles"] > 10_000


def test_kernels_are_ready_before_it_serves(cages, viewer, monkeypatch):
    warmed = []
    monkeypatch.setattr("foveal.refine.session.warm", warmed.append)
    with start(cages, port=0, viewer=viewer):
        assert warmed == ["sqrt3"]


def test_a_control_mesh_that_is_no_surface_is_refused_before_it_is_served(cages, viewer, monkeypatch):
    def refuse(*_, **__):
        raise FovealError("ball.fov: no surface.")

    monkeypatch.setattr("foveal.refine.session.Session", refuse)
    with pytest.raises(FovealError, match="no surface"):
        start(cages, port=0, viewer=viewer)
