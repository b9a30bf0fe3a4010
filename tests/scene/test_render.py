"""Pictures of files, meshes and scenes: what is drawn, from where, and how fine."""

import dataclasses
import json
import math

import numpy as np
import pytest
from PIL import Image

from foveal import Camera, FovealError, multires
from foveal.mesh.io import source_from_mesh
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.raster import gradient, picture
from foveal.scene import Layer, Scene, scene_of
from foveal.scene.render import frame, read_camera, render


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    path = tmp_path_factory.mktemp("ball") / "ball.fov"
    multires.build(bumpy_sphere(5), path, cell_triangles=2048)
    return path


def test_the_default_camera_sees_all(ball):
    scene = dataclasses.replace(scene_of(ball), background="#0000ff")
    picture = render(scene, size=(80, 60))
    assert picture.shape == (60, 80, 3)
    assert picture.dtype == np.uint8
    differs = (picture != [0, 0, 255]).any(axis=2).nonzero()
    for found, size in zip(differs, (60, 80), strict=True):
        assert 0 < found.min() < found.max() < size - 1


@pytest.mark.parametrize(
    ("up", "towards"), [("x", (0.25, -0.3, 1)), ("y", (0.3, 0.25, 1)), ("z", (0.3, -1, 0.25))]
)
def test_the_default_camera_is_the_viewers_home(tmp_path, up, towards):
    # viewer/src/scene/navigation.ts: 40 degrees, 0.3 to the right, 0.25 up and 1 to the front, where a corner
    # of the box touches the picture's rim, times 1.12.
    multires.build(source_from_mesh(icosphere(1), up=up), tmp_path / "ball.fov")
    camera = frame(scene_of(tmp_path / "ball.fov"), size=(300, 200))
    assert math.degrees(camera.field_of_view) == pytest.approx(40)
    away = camera.position - camera.target
    np.testing.assert_allclose(away / np.linalg.norm(away), np.array(towards) / np.linalg.norm(towards))
    half = np.ptp(icosphere(1).positions, axis=0).max() / 2
    corners = np.array(np.meshgrid(*[[-half, half]] * 3)).reshape(3, -1)
    right, above, back = camera.basis() @ corners
    reach = np.maximum(np.abs(right) / 1.5, np.abs(above)) / math.tan(math.radians(20))
    assert np.linalg.norm(away) == pytest.approx(1.12 * (back + reach).max(), rel=1e-3)


def test_a_camera_file_is_read_and_faults_are_said(tmp_path):
    path = tmp_path / "cam.json"
    path.write_text('{"position": [0, 0, 5], "target": [0, 0, 0], "size": [320, 200]}')
    assert read_camera(path).width == 320
    for text, sentence in (
        ("{", "not JSON"),
        ("[" * 10**5, "not JSON"),
        ("{}", "position"),
        ("[]", "position"),
    ):
        path.write_text(text)
        with pytest.raises(FovealError, match=sentence):
            read_camera(path)
    with pytest.raises(FovealError, match="no such file"):
        read_camera(tmp_path / "none.json")


def test_a_mesh_in_memory_is_drawn_as_it_is_without_a_build(monkeypatch):
    monkeypatch.setattr("foveal.multires.build", None)
    ball = bumpy_sphere(3)
    found = render(ball, size=(60, 40))
    np.testing.assert_array_equal(
        found, picture(ball, found.camera, background=gradient(found.camera))[..., :3]
    )
    up = render(ball, size=(60, 40), up="z").camera.up
    np.testing.assert_array_equal(up, [0, 0, 1])


def test_the_camera_comes_back_and_serves_again(ball, tmp_path):
    first = render(ball, size=(60, 40))
    np.testing.assert_array_equal(render(ball, camera=first.camera), first)
    (tmp_path / "cam.json").write_text(json.dumps(first.camera.to_json()))
    np.testing.assert_array_equal(render(ball, camera=tmp_path / "cam.json"), first)
    larger = render(ball, tmp_path / "out.png", camera=tmp_path / "cam.json", size=(90, 60))
    assert larger.shape == (60, 90, 3)
    with Image.open(tmp_path / "out.png") as image:
        np.testing.assert_array_equal(np.asarray(image), larger)


def test_it_is_as_fine_as_the_picture_shows_or_the_budget_allows(ball, monkeypatch):
    drawn = []

    def counted(mesh, *rest, **more):
        drawn.append(len(mesh.faces))
        return picture(mesh, *rest, **more)

    monkeypatch.setattr("foveal.raster.picture", counted)
    for error_px, triangles in ((0.0, None), (1.0, None), (1e9, None), (0.0, 9000)):
        render(ball, size=(300, 200), error_px=error_px, triangles=triangles)
    whole, usual, coarse, few = drawn
    assert whole == 20480 > usual > coarse
    assert coarse < few <= 9000


def built(folder, name, mesh, **options):
    multires.build(mesh, folder / f"{name}.fov", **options)
    return Layer(name, folder / f"{name}.fov")


def test_of_layers_the_visible_ones_are_drawn(tmp_path):
    ball = icosphere(2)
    layers = [
        built(
            tmp_path,
            f"at{height}",
            dataclasses.replace(ball, positions=ball.positions + np.array([0, height, 0])),
        )
        for height in (0, 3)
    ]
    scene = Scene("two", tuple(layers), background="#000000")
    both = render(scene, size=(40, 80))
    rows = both.any(axis=(1, 2))
    assert rows[10:35].any()
    assert rows[45:70].any()
    layers[1] = dataclasses.replace(layers[1], is_visible=False)
    alone = render(dataclasses.replace(scene, layers=tuple(layers)), camera=both.camera)
    assert not alone[:38].any()
    np.testing.assert_array_equal(alone[45:], both[45:])
    layers[0] = dataclasses.replace(layers[0], is_visible=False)  # then the first, as in the viewer
    hidden = render(dataclasses.replace(scene, layers=tuple(layers)), camera=both.camera)
    np.testing.assert_array_equal(hidden, alone)


def test_each_layer_is_drawn_as_if_it_were_alone(tmp_path):
    ball = icosphere(2)
    red = np.tile(np.array([200, 30, 30], np.uint8), (len(ball.positions), 1))
    layers = (
        built(tmp_path, "coloured", dataclasses.replace(ball, colours=red)),
        built(tmp_path, "smooth", dataclasses.replace(ball, positions=ball.positions + np.array([3, 0, 0]))),
        built(
            tmp_path,
            "flat",
            dataclasses.replace(ball, positions=ball.positions + np.array([6, 0, 0])),
            normals="none",
        ),
    )
    all_three = render(Scene("three", layers, background="#000000"), size=(120, 40))
    alone = [
        render(Scene("one", (layer,), background="#000000"), camera=all_three.camera) for layer in layers
    ]
    np.testing.assert_array_equal(all_three, np.max(alone, axis=0))  # they lie side by side


def test_a_file_without_normals_is_flat_as_in_the_viewer(tmp_path):
    layer = built(tmp_path, "flat", icosphere(2), normals="none", bits=16)
    found = render(layer.path, size=(60, 40), error_px=0.0)
    with multires.open(layer.path) as asset:
        mesh = multires.extract(asset)
    flat = picture(mesh, found.camera, background=gradient(found.camera), is_flat=True)
    np.testing.assert_array_equal(found, flat[..., :3])


def test_what_is_wrong_is_said_before_any_work(ball, tmp_path):
    with pytest.raises(FovealError, match=r"end in \.png"):
        render(ball, tmp_path / "a.jpg")
    with pytest.raises(FovealError, match="error_px"):
        render(ball, error_px=float("nan"))
    with pytest.raises(FovealError, match="from 1 to"):
        render(ball, camera=Camera.of([0, 0, 4], [0, 0, 0]), size=(0, 9))
