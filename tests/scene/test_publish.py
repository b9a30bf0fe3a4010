"""A published folder: whole, for the plainest server, and never in place of anything else."""

import functools
import http.server
import json
import threading
import urllib.request

import pytest

from foveal import FovealError
from foveal.base.files import _MACHINE
from foveal.scene import Layer, Scene, read_scene, scene_of
from foveal.scene.publish import publish


def test_what_is_in_the_folder(tmp_path, fov, viewer):
    site = publish(scene_of(fov), tmp_path / "site", viewer=viewer)
    files = sorted(path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file())
    assert files == ["README.txt", "assets/index-0a1B2c3D.js", "data/statue.fov", "index.html", "scene.json"]
    assert (site / "data" / "statue.fov").read_bytes() == fov.read_bytes()
    assert "ranges" in (site / "README.txt").read_text()
    assert str(tmp_path) not in (site / "scene.json").read_text()


def test_it_can_be_read_as_a_scene_again_and_published_again(tmp_path, fov, viewer):
    site = publish(scene_of(fov), tmp_path / "site", viewer=viewer)
    again = publish(read_scene(site / "scene.json"), tmp_path / "again", viewer=viewer)
    assert (again / "scene.json").read_bytes() == (site / "scene.json").read_bytes()


def test_layers_of_one_name_do_not_collide(tmp_path, make_fov, viewer):
    a, b = make_fov(tmp_path / "a.fov"), make_fov(tmp_path / "b.fov", step=0.25)
    scene = Scene("two", (Layer("statue", a), Layer("Statue", b)))
    site = publish(scene, tmp_path / "site", viewer=viewer)
    back = read_scene(site / "scene.json")
    assert [layer.path.read_bytes() for layer in back.layers] == [a.read_bytes(), b.read_bytes()]


def test_a_server_without_ranges_will_do(tmp_path, fov, viewer):
    site = publish(scene_of(fov), tmp_path / "site", viewer=viewer)

    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), functools.partial(Handler, directory=str(site))
    ) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            base = f"http://127.0.0.1:{server.server_port}/"
            asset = json.load(urllib.request.urlopen(base + "scene.json"))["layers"][0]["asset"]
            with urllib.request.urlopen(base + asset) as answer:
                assert answer.read() == fov.read_bytes()
        finally:
            server.shutdown()
            thread.join()


def test_what_is_there_stays_unless_forced(tmp_path, fov, viewer):
    folder = tmp_path / "site"
    publish(scene_of(fov), folder, viewer=viewer)
    with pytest.raises(FovealError, match="--force"):
        publish(scene_of(fov), folder, viewer=viewer)
    (folder / "old.txt").write_text("old")
    publish(scene_of(fov), folder, viewer=viewer, force=True)
    assert not (folder / "old.txt").exists()


def test_force_never_deletes_what_foveal_did_not_publish(tmp_path, fov, viewer):
    home = tmp_path / "home"
    home.mkdir()
    (home / "thesis.tex").write_text("years of work")
    with pytest.raises(FovealError, match="was not made by"):
        publish(scene_of(fov), home, viewer=viewer, force=True)
    assert (home / "thesis.tex").read_text() == "years of work"


def test_force_never_deletes_what_is_to_be_published(tmp_path, fov, viewer):
    site = publish(scene_of(fov), tmp_path / "site", viewer=viewer)
    with pytest.raises(FovealError, match="lies in this folder"):
        publish(read_scene(site / "scene.json"), site, viewer=viewer, force=True)
    assert (site / "data" / "statue.fov").exists()


def test_a_copy_that_fails_leaves_nothing(tmp_path, fov, viewer, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("shutil.copyfile", full)
    with pytest.raises(FovealError, match="No space"):
        publish(scene_of(fov), tmp_path / "site", viewer=viewer)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["statue.fov", "viewer"]


def test_a_viewer_that_is_not_built_is_said_before_anything(tmp_path, fov):
    with pytest.raises(FovealError, match="not built"):
        publish(scene_of(fov), tmp_path / "site", viewer=tmp_path)
    assert not (tmp_path / "site").exists()


def test_a_link_to_a_site_stays_a_link(tmp_path, fov, viewer):
    site = publish(scene_of(fov), tmp_path / "site", viewer=viewer)
    link = tmp_path / "link"
    link.symlink_to(site)
    publish(scene_of(fov, title="again"), link, viewer=viewer, force=True)
    assert link.is_symlink()
    assert read_scene(site / "scene.json").title == "again"


def test_where_one_stands_and_what_a_killed_one_left(tmp_path, fov, viewer, monkeypatch):
    here = tmp_path / "here"
    (here / f".foveal-new.{_MACHINE}-999999999.part").mkdir(parents=True)
    monkeypatch.chdir(here)
    publish(scene_of(fov), ".", viewer=viewer)
    assert sorted(path.name for path in here.iterdir()) == [
        "README.txt",
        "assets",
        "data",
        "index.html",
        "scene.json",
    ]
