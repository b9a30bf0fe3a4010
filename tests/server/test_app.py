"""What is served and what is not: the viewer, scene.json, the given files, and nothing else."""

import gzip
import json

import pytest

from foveal import FovealError
from foveal.server import create_app


def test_the_page_and_the_scene(client):
    page = client.get("/")
    assert page.status == 200
    assert page.headers["content-type"] == "text/html; charset=utf-8"
    assert page.text == client.get("/index.html").text
    scene = client.get("/scene.json")
    assert scene.headers["content-type"] == "application/json"
    layers = [{"name": "statue", "asset": "data/statue.fov", "visible": True}]
    assert scene.json() == {"version": 1, "title": "A statue", "layers": layers, "views": []}
    assert client.get("/" + layers[0]["asset"]).status == 200


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/assets/index-0a1B2c3D.js", "text/javascript; charset=utf-8"),
        ("/assets/decoder-9f8E7d6C.wasm", "application/wasm"),
    ],
)
def test_media_types_and_names_by_content_are_kept_for_good(client, path, kind):
    answer = client.get(path)
    assert answer.headers["content-type"] == kind
    assert "immutable" in answer.headers["cache-control"]
    assert client.get("/").headers["cache-control"] == "no-cache"


def test_text_is_gzipped_for_who_takes_it(client):
    plain = client.get("/", headers={"Accept-Encoding": "identity"})
    packed = client.get("/", headers={"Accept-Encoding": "br, gzip"})
    assert "content-encoding" not in plain.headers
    assert packed.headers["content-encoding"] == "gzip"
    assert packed.headers["vary"] == plain.headers["vary"] == "accept-encoding"
    assert packed.headers["etag"] != plain.headers["etag"]
    assert int(packed.headers["content-length"]) < int(plain.headers["content-length"]) == len(plain.content)
    assert gzip.decompress(packed.raw) == plain.content


def test_text_is_sent_again_only_when_it_changed(client, viewer):
    tag = client.get("/").headers["etag"]
    assert client.get("/", headers={"If-None-Match": tag}).status == 304
    (viewer / "index.html").write_text("<!doctype html>changed")
    again = client.get("/", headers={"If-None-Match": tag})
    assert again.status == 200
    assert again.text == "<!doctype html>changed"


def test_head(client):
    answer = client.head("/scene.json")
    assert answer.status == 200
    assert answer.content == b""
    assert int(answer.headers["content-length"]) == len(client.get("/scene.json").content)


@pytest.mark.parametrize(
    "path",
    [
        "/data/statue2.fov",
        "/data/",
        "/data",
        "/data/../statue.fov",
        "/data/%2e%2e/outside.txt",
        "/..%2foutside.txt",
        "//etc/passwd",
        "/%2fetc%2fpasswd",
        "/assets/../../outside.txt",
        "/assets/",
        "/.hidden",
        "/leak.txt",
        "/data/statue.fov/",
        "/data/statue.fov%00",
        "/DATA/statue.fov",
    ],
)
def test_nothing_else_is_served(client, path):
    answer = client.get(path)
    assert answer.status == 404
    assert "secret" not in answer.text


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.1:9999", "localhost:8000", "LocalHost", "[::1]:8000"])
def test_hosts_that_are_ours(client, host):
    assert client.get("/scene.json", headers={"Host": host}).status == 200


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("evil.example", 421),
        ("evil.example:8000", 421),
        ("127.0.0.1.evil.example", 421),
        ("10.0.0.5:8000", 421),
        ("localhost.", 421),
        ("", 400),
        ("a b", 400),
        ("127.0.0.1@evil.example", 400),
        ("127.0.0.1:80:80", 400),
    ],
)
@pytest.mark.parametrize("path", ["/scene.json", "/data/statue.fov"])
def test_other_hosts_are_refused(client, host, status, path):
    answer = client.get(path, headers={"Host": host})
    assert answer.status == status
    assert len(answer.text.strip()) > 10


def test_two_hosts_are_refused(client):
    assert client.send("GET", "/", [("host", "127.0.0.1"), ("host", "evil.example")]).status == 400
    assert client.send("GET", "/", []).status == 400


def test_on_all_interfaces_addresses_in_numbers_are_accepted_and_names_are_not(scene, viewer, client_of):
    app = create_app(scene, viewer=viewer, hosts={"127.0.0.1", "workstation"}, is_public=True)
    client = client_of(app)
    for host, status in {
        "192.168.0.7:8000": 200,
        "[fe80::1]": 200,
        "workstation": 200,
        "evil.example": 421,
    }.items():
        assert client.get("/", headers={"Host": host}).status == status


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"])
@pytest.mark.parametrize("path", ["/", "/data/statue.fov", "/nothing"])
def test_only_reading(client, method, path):
    answer = client.request(method, path)
    assert answer.status == 405
    assert answer.headers["allow"] == "GET, HEAD"


def test_security_headers(client):
    page = client.get("/").headers
    policy = page["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "'wasm-unsafe-eval'" in policy
    assert "unsafe-inline" not in policy
    assert "'unsafe-eval'" not in policy
    assert page["cross-origin-opener-policy"] == "same-origin"
    assert page["cross-origin-embedder-policy"] == "require-corp"
    for path in ("/", "/scene.json", "/data/statue.fov", "/nothing"):
        assert client.get(path).headers["x-content-type-options"] == "nosniff"
        assert client.get(path).headers["cross-origin-resource-policy"] == "same-origin"


def test_a_viewer_that_is_not_built_is_said(scene, tmp_path):
    with pytest.raises(FovealError, match="not built"):
        create_app(scene, viewer=tmp_path / "nowhere")


def test_the_scene_has_no_paths_of_this_machine(client, tmp_path):
    assert str(tmp_path) not in json.dumps(client.get("/scene.json").json())
