"""Normals of vertices: by area, of unit length, unmoved by scale and place."""

import numpy as np
import pytest

import corpus
import naive
from foveal.mesh.normals import unit_normals, vertex_normals
from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh


@pytest.mark.parametrize("name", corpus.MESHES)
def test_they_agree_with_the_plain_twin(name):
    mesh = corpus.MESHES[name]()
    normals = vertex_normals(mesh)
    assert normals.dtype == np.float32
    centred = mesh.positions - mesh.positions[0]
    expected = naive.vertex_normals(centred / np.abs(centred).max(), mesh.faces)
    lengths = np.linalg.norm(normals, axis=1)
    assert np.isin(lengths.round(6), (0, 1)).all()
    clear = np.linalg.norm(expected, axis=1) > 0
    if name != "many_wings":  # whose sums are rounding around zero
        np.testing.assert_allclose(normals[clear], expected[clear], atol=1e-5)


def test_a_large_triangle_weighs_more():
    mesh = TriMesh.of([[0, 0, 0], [3, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [0, 2, 3]])
    np.testing.assert_allclose(vertex_normals(mesh)[0], np.array([1, 0, 3]) / 10**0.5, atol=1e-7)


@pytest.mark.parametrize("scale", [1e-150, 1e-9, 1e12, 1e150])
def test_scale_does_not_matter(scale):
    ball = icosphere(2)
    scaled = TriMesh(ball.positions * scale, ball.faces)
    np.testing.assert_allclose(vertex_normals(scaled), vertex_normals(ball), atol=1e-6)


def test_what_has_no_direction_is_zero():
    assert not vertex_normals(corpus.unused_vertices())[0].any()
    assert unit_normals(np.array([[np.inf, 0, 0], [1e300, 1e300, 0], [3e-320, 0, 0]])).round(3).tolist() == [
        [0, 0, 0],
        [np.float32(0.707), np.float32(0.707), 0],
        [1, 0, 0],
    ]
