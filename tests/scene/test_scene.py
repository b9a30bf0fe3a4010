"""scene.json: round trips, names that are safe, and one sentence for whatever is wrong with it."""

import json
import os
import string
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal import Camera, FovealError
from foveal.scene import Layer, Scene, View, asset_names, read_scene, scene_json, scene_of, write_scene
from foveal.scene.publish import publish


def test_a_lone_file_is_a_scene_of_one_layer(fov):
    scene = read_scene(fov)
    assert scene == scene_of(fov)
    assert scene.title == "statue"
    assert [(layer.name, layer.path, layer.is_visible) for layer in scene.layers] == [("statue", fov, True)]


def test_what_is_written_is_read(tmp_path, make_fov):
    (tmp_path / "data").mkdir()
    a, b = make_fov(tmp_path / "data" / "a.fov"), make_fov(tmp_path / "b.fov")
    camera = Camera.of([0, 0, 5], [0, 1, 0], up=[0, 0, 1], width=640, height=480)
    scene = Scene(
        "Two — “statues”",
        (Layer("eins", a.resolve()), Layer("zwei", b.resolve(), is_visible=False)),
        (View("from the south", camera),),
        "#20242a",
    )
    write_scene(scene, tmp_path / "scene.json")
    back = read_scene(tmp_path / "scene.json")
    assert (back.title, back.layers, back.background) == (scene.title, scene.layers, scene.background)
    assert back.views[0].name == "from the south"
    assert back.views[0].camera.to_json() == camera.to_json()
    data = json.loads((tmp_path / "scene.json").read_bytes())
    assert data["version"] == 1
    assert [layer["asset"] for layer in data["layers"]] == ["data/a.fov", "b.fov"]


def test_what_is_left_out_takes_its_default_and_what_is_not_known_is_ignored(fov, tmp_path):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps({"version": 1, "layers": [{"asset": "statue.fov", "glow": 3}], "fog": {}}))
    scene = read_scene(path)
    assert scene == Scene(tmp_path.name, (Layer("statue", fov.resolve()),))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"version": 2}, "version 2 is not known"),
        ({"version": None}, "version None"),
        ({"layers": []}, '"layers" is empty'),
        ({"layers": "statue.fov"}, '"layers" must be a list'),
        ({"layers": ["statue.fov"]}, 'layer 1 of "layers" needs an "asset"'),
        ({"layers": [{"asset": 3}]}, "needs an"),
        ({"layers": [{"asset": "statue.fov", "visible": "yes"}]}, '"visible"'),
        ({"layers": [{"asset": "statue.fov", "name": 3}]}, '"name"'),
        ({"layers": [{"asset": "missing.fov"}]}, "no such file"),
        ({"layers": [{"asset": "scene.json"}]}, "not a .fov"),
        ({"title": ["a"]}, '"title"'),
        ({"title": "a\nb"}, "of one line"),
        ({"title": "\x1b[2J"}, "of one line"),
        ({"layers": [{"asset": "statue.fov", "name": "\ud800"}]}, "of one line"),
        ({"background": "red"}, '"background"'),
        ({"views": [3]}, "view 1"),
        ({"views": [{"name": "a"}]}, "view 'a'"),
        ({"views": [{"name": "a", "camera": {"position": [0, 0, 0], "target": [0, 0, 0]}}]}, "same point"),
        ({"views": {}}, '"views" must be a list'),
    ],
)
def test_each_fault_has_its_sentence(fov, tmp_path, change, sentence):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps({"version": 1, "layers": [{"asset": "statue.fov"}], **change}))
    with pytest.raises(FovealError) as caught:
        read_scene(path)
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("text", ["", "{", "[]", "3", '"a"', "null", '{"version": 1}', "[" * 100_000])
def test_what_is_no_scene_is_said(tmp_path, text):
    path = tmp_path / "scene.json"
    path.write_text(text)
    with pytest.raises(FovealError, match=r"scene\.json"):
        read_scene(path)
    with pytest.raises(FovealError, match="no such file"):
        read_scene(tmp_path / "none.json")


@pytest.mark.parametrize(
    "asset",
    [
        "../statue.fov",
        "/etc/passwd",
        "a/../../statue.fov",
        "..\\statue.fov",
        "C:statue.fov",
        "",
        "a\0b",
        "\ud800",
        ".",
    ],
)
def test_an_asset_does_not_leave_the_folder(tmp_path, make_fov, asset):
    make_fov(tmp_path / "statue.fov")
    folder = tmp_path / "inner"
    folder.mkdir()
    (folder / "scene.json").write_text(json.dumps({"version": 1, "layers": [{"asset": asset}]}))
    with pytest.raises(FovealError):
        read_scene(folder / "scene.json")


def test_nor_by_a_link(tmp_path, make_fov):
    make_fov(tmp_path / "statue.fov")
    folder = tmp_path / "inner"
    folder.mkdir()
    (folder / "link.fov").symlink_to(tmp_path / "statue.fov")
    (folder / "scene.json").write_text('{"version": 1, "layers": [{"asset": "link.fov"}]}')
    with pytest.raises(FovealError, match="leaves the folder"):
        read_scene(folder / "scene.json")


def test_a_scene_is_not_written_where_nobody_could_read_it(tmp_path, fov):
    with pytest.raises(FovealError, match="outside this folder"):
        write_scene(scene_of(fov), tmp_path / "inner" / "scene.json")
    assert not (tmp_path / "inner").exists()


@given(st.lists(st.text(max_size=120), min_size=1, max_size=12))
def test_asset_names_are_safe_and_no_two_alike(names):
    from pathlib import Path

    layers = tuple(Layer(name, Path(f"{i}.fov")) for i, name in enumerate(names))
    found = list(asset_names(Scene("", layers)).values())
    assert len({name.lower() for name in found}) == len(names)
    for name in found:
        assert name.endswith(".fov")
        assert set(name) <= set(string.ascii_letters + string.digits + "-_.")
        assert not name.startswith((".", "-"))
        assert name.split(".")[0].lower() not in {"con", "nul", "aux", "prn", "com1", "lpt9"}
        assert len(name) < 100


def test_one_asset_in_two_layers_is_one_file(fov):
    scene = Scene("", (Layer("a", fov), Layer("b", fov)))
    assert asset_names(scene) == {fov: "a.fov"}
    data = json.loads(scene_json(scene, {fov: "data/a.fov"}))
    assert [layer["asset"] for layer in data["layers"]] == ["data/a.fov"] * 2


@pytest.mark.skipif(sys.platform != "linux", reason="only there a name may be any bytes")
def test_a_file_of_any_name_is_a_scene_that_can_be_written_and_read(tmp_path, make_fov):
    path = make_fov(tmp_path / os.fsdecode(b"bell\x07\xff\n.fov"))
    scene = scene_of(path)
    assert scene.title == "bell___"
    publish(scene, tmp_path / "site", viewer=viewer_of(tmp_path))
    assert read_scene(tmp_path / "site" / "scene.json").title == "bell___"


def viewer_of(folder):
    (folder / "index.html").write_text("<!doctype html>")
    return folder
