"""The server on real sockets: ports, raw requests, clients that leave, Ctrl-C."""

import http.client
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlsplit

import pytest

from foveal import FovealError
from foveal.server import start
from foveal.server.run import refuse_address


@pytest.fixture
def running(scene, viewer):
    with start(scene, port=0, viewer=viewer) as server:
        yield server


def ask(url, request: bytes) -> bytes:
    with socket.create_connection((urlsplit(url).hostname, urlsplit(url).port), timeout=10) as connection:
        connection.sendall(request)
        answer = b""
        while piece := connection.recv(1 << 16):
            answer += piece
    return answer


def test_ranges_over_a_kept_connection(running, content):
    connection = http.client.HTTPConnection("127.0.0.1", urlsplit(running.url).port, timeout=10)
    begin = time.perf_counter()
    for start_byte in range(0, 200_000, 10_000):
        connection.request(
            "GET", "/data/statue.fov", headers={"Range": f"bytes={start_byte}-{start_byte + 9999}"}
        )
        answer = connection.getresponse()
        assert answer.status == 206
        assert answer.read() == content[start_byte : start_byte + 10_000]
    # Nagle's algorithm would make each wait 40 ms for the acknowledgement of its header.
    assert (time.perf_counter() - begin) / 20 < 0.02
    connection.close()


def test_the_path_is_not_walked(running):
    for path in (
        b"/../../etc/passwd",
        b"/data/../../etc/passwd",
        b"/data/..%2f..%2fetc/passwd",
        b"/\\etc\\passwd",
    ):
        answer = ask(
            running.url, b"GET " + path + b" HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n"
        )
        assert answer.startswith(b"HTTP/1.1 404")


def test_a_foreign_host_is_refused(running):
    answer = ask(running.url, b"GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n")
    assert answer.startswith(b"HTTP/1.1 421")
    assert ask(running.url, b"GET / HTTP/1.0\r\n\r\n").startswith(b"HTTP/1.1 400")


def test_a_client_that_leaves_does_no_harm(running, content):
    for _ in range(3):
        with socket.create_connection(("127.0.0.1", urlsplit(running.url).port), timeout=10) as connection:
            connection.sendall(b"GET /data/statue.fov HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
            connection.recv(1000)
    answer = ask(
        running.url, b"GET /data/statue.fov HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n"
    )
    assert answer.endswith(content[-100_000:])


def test_a_taken_port_gives_the_next(scene, viewer):
    with start(scene, port=0, viewer=viewer) as first:
        port = urlsplit(first.url).port
        with start(scene, port=port, viewer=viewer) as second:
            assert port < urlsplit(second.url).port < port + 100


def test_a_host_that_is_not_ours_is_said(scene, viewer):
    for host in ("203.0.113.1", "no.such.name.invalid", "a..b", "127.0.0.1:80"):
        with pytest.raises(FovealError, match=rf"^{host}: .*--bind"):
            start(scene, host=host, viewer=viewer)
        with pytest.raises(FovealError, match="--bind"):
            refuse_address(host, None)


def test_no_host_is_not_every_host(scene, viewer):
    with pytest.raises(FovealError, match="--bind"):
        start(scene, host="", viewer=viewer)


@pytest.mark.skipif(not socket.has_ipv6, reason="this Python knows no IPv6")
@pytest.mark.parametrize(("host", "shown"), [("::1", "[::1]"), ("[::1]", "[::1]"), ("::", "[::1]")])
def test_addresses_of_the_newer_kind(scene, viewer, host, shown):
    try:
        refuse_address("::1", 0)
    except FovealError:
        pytest.skip("this machine has no IPv6 address")
    with start(scene, host=host, port=0, viewer=viewer) as server:
        assert server.url.startswith(f"http://{shown}:")
        assert b" 200 " in ask(
            server.url,
            f"GET / HTTP/1.1\r\nHost: {urlsplit(server.url).netloc}\r\nConnection: close\r\n\r\n".encode(),
        )


def test_closing_ends_it(scene, viewer):
    server = start(scene, port=0, viewer=viewer)
    assert server.url in server._repr_html_()
    server.close()
    server.close()
    with pytest.raises(OSError):
        socket.create_connection(("127.0.0.1", urlsplit(server.url).port), timeout=1)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to a child alone")
def test_ctrl_c_is_how_a_server_ends_and_no_failure(scene, viewer):
    program = """
from pathlib import Path
from foveal.scene import Layer, Scene
from foveal.server import start
from foveal.server.run import refuse_address
scene = Scene("t", (Layer("t", Path(sys.argv[1])),))
running = start(scene, port=0, viewer=sys.argv[2])
print(running.url, flush=True)
running.wait()
"""
    source = str(Path(__file__).parents[2] / "src")
    child = subprocess.Popen(
        [
            sys.executable,
            "-c",
            f"import sys; sys.path.insert(0, {source!r})\n{program}",
            scene.layers[0].path,
            viewer,
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        url = child.stdout.readline().strip()
        assert url.startswith("http://127.0.0.1:")
        assert ask(url, b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n").startswith(
            b"HTTP/1.1 200"
        )
        child.send_signal(signal.SIGINT)
        out, error = child.communicate(timeout=10)
    finally:
        child.kill()
    assert child.returncode == 0
    assert out == ""
    assert error == ""
