"""The light of a scene: read, written, published, told of, checked."""

import json

import pytest

import foveal
from foveal import FovealError
from foveal.container import create, open_container
from foveal.scene import Layer, Scene, asset_names, read_scene, scene_json, scene_of, write_scene
from foveal.scene.prepare import load
from foveal.scene.publish import publish
from foveal.shadows import Directional
from scene.shadow_scenes import ball_over_slab


@pytest.fixture(scope="module")
def shadow_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("shadows") / "noon.fov"
    foveal.shadow(ball_over_slab(), path, light=Directional((0, 0, -1)), resolution=64)
    return path


@pytest.fixture
def lit(tmp_path, fov, shadow_file):
    """A scene.json with a light, in `tmp_path`."""
    (tmp_path / "data").mkdir()
    light = tmp_path / "data" / "light.fov"
    light.write_bytes(shadow_file.read_bytes())
    path = tmp_path / "scene.json"
    write_scene(Scene("lit", (Layer("statue", fov.resolve()),), light=light.resolve()), path)
    return path


def test_what_is_written_is_read(lit):
    data = json.loads(lit.read_bytes())
    assert data["light"] == {"asset": "data/light.fov"}
    scene = read_scene(lit)
    assert scene.light == (lit.parent / "data" / "light.fov").resolve()
    assert scene.assets == (scene.layers[0].path, scene.light)
    assert "light" not in json.loads(scene_json(scene_of(scene.layers[0].path), {scene.layers[0].path: "a"}))


@pytest.mark.parametrize(
    ("light", "sentence"),
    [
        ("data/light.fov", 'needs an "asset"'),
        ({}, 'needs an "asset"'),
        ({"asset": 3}, 'needs an "asset"'),
        ({"asset": "../light.fov"}, "leaves the folder"),
        ({"asset": "/etc/light.fov"}, "leaves the folder"),
        ({"asset": "data/none.fov"}, "no such file"),
        ({"asset": "data"}, "this is a folder"),
        ({"asset": "statue.fov"}, "no shadows. Make some with 'foveal shadow'"),
        ({"asset": "scene.json"}, "not a .fov"),
    ],
)
def test_a_light_that_is_none(lit, light, sentence):
    lit.write_text(json.dumps(json.loads(lit.read_bytes()) | {"light": light}))
    with pytest.raises(FovealError, match=sentence):
        read_scene(lit)


def test_no_light_may_be_said(lit):
    lit.write_text(json.dumps(json.loads(lit.read_bytes()) | {"light": None}))
    assert read_scene(lit).light is None


def test_a_light_outside_the_folder_is_not_written(tmp_path, fov, shadow_file):
    scene = Scene("lit", (Layer("statue", fov.resolve()),), light=shadow_file)
    with pytest.raises(FovealError, match="lies outside this folder"):
        write_scene(scene, tmp_path / "scene.json")


def test_it_is_published_under_a_name_of_its_own(tmp_path, lit, viewer, make_fov):
    scene = read_scene(lit)
    site = publish(scene, tmp_path / "site", viewer=viewer)
    assert sorted(path.name for path in (site / "data").iterdir()) == ["shadow.fov", "statue.fov"]
    back = read_scene(site / "scene.json")
    assert back.light.read_bytes() == scene.light.read_bytes()
    clash = Scene("two", (Layer("Shadow", make_fov(tmp_path / "a.fov")),), light=scene.light)
    assert list(asset_names(clash).values()) == ["Shadow.fov", "shadow-2.fov"]
    itself = Scene("lit", scene.layers, light=back.light)
    with pytest.raises(FovealError, match=r"the scene's own shadow\.fov"):
        publish(itself, site, viewer=viewer, force=True)


def test_a_lone_mesh_gets_a_light_beside_it(tmp_path, fov, lit, viewer, shadow_file, monkeypatch):
    monkeypatch.setattr("foveal.scene.prepare.cache_folder", lambda: tmp_path / "cache")
    site = publish(fov, tmp_path / "site", viewer=viewer, shadow=shadow_file)
    assert read_scene(site / "scene.json").light.read_bytes() == shadow_file.read_bytes()
    assert load(lit, shadow=shadow_file).light == shadow_file.resolve()  # in place of its own
    for wrong, sentence in ((tmp_path / "none.fov", "no such file"), (fov, "no shadows")):
        with pytest.raises(FovealError, match=sentence):
            load(ball_over_slab(), shadow=wrong)
    assert not (tmp_path / "cache").exists()  # nothing was built in vain


def test_it_is_told_of_and_checked_with_the_scene(lit, shadow_file):
    facts = foveal.info(lit)["light"]
    assert facts["kind"] == "shadow"
    assert facts["light"]["kind"] == "directional"
    assert foveal.check(shadow_file)["resolution"] == 64
    with pytest.raises(FovealError, match="no errors to be measured"):
        foveal.check(shadow_file, original="any.ply")
    light = read_scene(lit).light
    data = bytearray(light.read_bytes())
    data[-5] ^= 1
    light.write_bytes(data)
    with pytest.raises(FovealError, match="checksum"):
        foveal.check(light)


@pytest.mark.parametrize(
    "change",
    [
        {"levels": -1},
        {"levels": "6"},
        {"levels": 99},
        {"images": None},
        {"nodes": [1, 2]},
        {"nodes": {"leaf": 1}},
        {"light": "sun"},
        {"light": {}},
        {"projections": 1},
    ],
)
def test_a_damaged_header_is_a_sentence(tmp_path, shadow_file, change):
    with open_container(shadow_file) as file:
        header = {key: value for key, value in file.header.items() if key not in ("kind", "version")} | change
        chunks = [file.chunk(number) for number in range(len(file))]
    path = tmp_path / "damaged.fov"
    with create(path, kind="shadow", version=1) as writer:
        for chunk in chunks[1:]:
            writer.add_chunk(chunk)
        writer.finish(header, chunks[0])
    for verb in (foveal.info, foveal.check):
        with pytest.raises(FovealError, match=r"damaged\.fov"):
            verb(path)


def test_trees_that_are_not_what_the_header_tells(tmp_path, shadow_file):
    with open_container(shadow_file) as file:
        header = {key: value for key, value in file.header.items() if key not in ("kind", "version")}
        chunks = [file.chunk(number) for number in range(len(file))]
    header["nodes"]["leaf"] += 1
    with create(tmp_path / "odd.fov", kind="shadow", version=1) as writer:
        for chunk in chunks[1:]:
            writer.add_chunk(chunk)
        writer.finish(header, chunks[0])
    with pytest.raises(FovealError, match="not what its header tells"):
        foveal.check(tmp_path / "odd.fov")


def test_layers_that_move_are_named_by_the_light(lit):
    data = json.loads(lit.read_bytes())
    data["light"]["moving"] = ["statue"]
    lit.write_text(json.dumps(data))
    scene = read_scene(lit)
    assert [layer.is_moving for layer in scene.layers] == [True]
    write_scene(scene, lit)
    assert json.loads(lit.read_bytes())["light"] == data["light"]
    with pytest.raises(FovealError, match="no layer that stays"):
        foveal.shadow(lit, lit.parent / "other.fov", light=Directional((0, 0, -1)), resolution=16)
    for moving, words in (
        (["nobody"], "no layer has that name"),
        ("statue", "must be a list"),
        ([1], "a list"),
    ):
        data["light"]["moving"] = moving
        lit.write_text(json.dumps(data))
        with pytest.raises(FovealError, match=words):
            read_scene(lit)
