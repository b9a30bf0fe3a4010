"""Export at a chosen error or number of triangles, to what the suffix says."""

import numpy as np
import pytest

from foveal import FovealError, TriMesh, multires
from foveal.mesh.distance import sampled_hausdorff
from foveal.mesh.io import read_mesh, write_ply
from foveal.mesh.shapes import bumpy_sphere
from foveal.scene.export import error_for_triangles, export


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


def test_what_glb_cannot_hold_is_said(tmp_path):
    mesh = TriMesh.of([[0, 0, -1e300], [1, 0, 0], [0, 1, 1e300]], [[0, 1, 2]])
    with pytest.raises(FovealError, match=r"\.ply"):
        export(mesh, tmp_path / "a.glb")
    assert list(tmp_path.iterdir()) == []
    export(mesh, tmp_path / "a.ply")
    np.testing.assert_array_equal(read_mesh(tmp_path / "a.ply").positions, mesh.positions)
