"""Export at a chosen error or number of triangles, and a frame around all of a scene."""

import dataclasses
import math

import numpy as np
import pytest

from foveal import FovealError, multires
from foveal.mesh.distance import sampled_hausdorff
from foveal.mesh.io import read_mesh, source_from_mesh, write_ply
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.scene.export import error_for_triangles, export
from foveal.scene.render import frame, read_camera, render
from foveal.scene.scene import scene_of


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    path = tmp_path_factory.mktemp("ball") / "ball.fov"
    multires.build(bumpy_sphere(5), path, cell_triangles=2048)
    return path


def test_without_a_limit_every_triangle_comes(ball, tmp_path):
    mesh = export(ball, tmp_path / "all.ply")
    assert len(mesh.faces) == 20480
    assert len(read_mesh(tmp_path / "all.ply").faces) == 20480


def test_the_number_of_triangles_is_kept_and_used(ball):
    with multires.open(ball) as asset:
        errors = np.unique(asset.graph.errors[1:])
        for wanted in (5000, 9000, 15000, 20480, 10**6):
            mesh = export(ball, triangles=wanted)
            assert len(mesh.faces) <= wanted
            error = error_for_triangles(asset.graph, wanted)
            finer = errors[errors < error]
            if len(finer):  # the next finer cut would have been too much
                assert len(export(ball, error=float(finer[-1])).faces) > wanted


def test_the_error_is_kept(ball):
    original = bumpy_sphere(5)
    for error in (0.02, 0.005):
        mesh = export(ball, error=error)
        assert len(mesh.faces) < 20480
        assert max(sampled_hausdorff(mesh, original, samples=20_000)) <= error


def test_too_few_triangles_are_refused(ball):
    with pytest.raises(FovealError, match="coarsest level has"):
        export(ball, triangles=3)


def test_formats_and_limits_are_checked_before_any_work(ball, tmp_path):
    with pytest.raises(FovealError, match=r"\.ply or \.glb"):
        export(ball, tmp_path / "ball.stl")
    with pytest.raises(FovealError, match="one by one"):
        export(tmp_path / "scene.json")
    with pytest.raises(FovealError, match="error must be"):
        export(ball, error=-1.0)
    with pytest.raises(ValueError, match="not both"):
        export(ball, error=0.1, triangles=100)


def test_a_mesh_becomes_another_format_without_a_build(tmp_path, monkeypatch):
    monkeypatch.setattr("foveal.multires.build", None)
    write_ply(bumpy_sphere(2), tmp_path / "in.ply")
    export(tmp_path / "in.ply", tmp_path / "out.glb")
    assert len(read_mesh(tmp_path / "out.glb").faces) == 320


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
