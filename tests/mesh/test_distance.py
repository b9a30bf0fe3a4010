"""Distances: exact against a plain twin for triangles of every shape, lower bounds, spread samples."""

import numpy as np
import pytest

import corpus
import naive
from foveal.mesh.distance import (
    SurfaceIndex,
    closest_distance,
    mean_distance,
    sample_surface,
    sampled_hausdorff,
)
from foveal.mesh.shapes import bumpy_sphere, grid_patch, icosphere, terrain
from foveal.mesh.trimesh import TriMesh


def places_around(mesh, seed, count=8):
    rng = np.random.default_rng(seed)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    near = mesh.positions[rng.integers(0, len(mesh.positions), count)]
    return np.concatenate([rng.uniform(2 * low - high, 2 * high - low, size=(count, 3)), near])


@pytest.mark.parametrize("name", corpus.MESHES)
def test_it_agrees_with_the_plain_twin(name):
    mesh = corpus.MESHES[name]()
    mesh = TriMesh(mesh.positions, mesh.faces[:150])
    points = places_around(mesh, 3)
    expected = naive.surface_distance(points, mesh.positions, mesh.faces)
    size = np.abs(mesh.positions).max()
    np.testing.assert_allclose(closest_distance(points, mesh), expected, rtol=1e-9, atol=1e-14 * size)


def test_triangles_of_all_sizes_together():
    rng = np.random.default_rng(4)
    sizes = 10.0 ** rng.uniform(-6, 2, 300)
    corners = rng.uniform(size=(300, 1, 3)) + sizes[:, None, None] * rng.normal(size=(300, 3, 3))
    slivers = rng.uniform(size=(20, 1, 3)) + rng.uniform(-5, 5, size=(20, 3, 1)) * rng.normal(size=(20, 1, 3))
    points = np.concatenate([corners, slivers]).reshape(-1, 3)
    mesh = TriMesh.of(points, np.arange(len(points)).reshape(-1, 3))
    places = rng.uniform(-3, 3, size=(20, 3))
    expected = naive.surface_distance(places, mesh.positions, mesh.faces)
    np.testing.assert_allclose(closest_distance(places, mesh), expected, rtol=1e-9, atol=1e-10)


def test_the_nearest_triangle_is_named():
    mesh = terrain(20)
    rng = np.random.default_rng(0)
    chosen = rng.permutation(len(mesh.faces))[:200]
    middles = mesh.positions[mesh.faces[chosen]].mean(axis=1)
    distances, triangles = SurfaceIndex(mesh).closest(middles)
    assert distances.max() < 1e-12
    np.testing.assert_array_equal(triangles, chosen)


def test_distance_moves_and_scales_with_everything():
    mesh, points = bumpy_sphere(3), places_around(bumpy_sphere(3), 9)
    far = TriMesh(1000 * mesh.positions + [5e5, 4.8e6, 100], mesh.faces)
    moved = closest_distance(1000 * points + [5e5, 4.8e6, 100], far)
    np.testing.assert_allclose(moved, 1000 * closest_distance(points, mesh), atol=1e-8)


def test_the_sides_of_a_prism_by_hand():
    square = grid_patch(3)
    places = [[0.5, 0.5, 0.25], [2, 0.5, 0], [-3, -4, 0], [0.2, 0.7, 0], [1, 1, -2]]
    np.testing.assert_allclose(closest_distance(places, square), [0.25, 1, 5, 0, 2], atol=1e-15)


def test_samples_lie_on_the_surface_by_area():
    mesh = TriMesh.of(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [3, 0, 0], [0, 3, 0]], [[0, 1, 2], [3, 4, 5]]
    )
    far = TriMesh(mesh.positions + np.repeat([[0, 0, 0], [0, 0, 9]], 3, axis=0), mesh.faces)
    points = sample_surface(far, 20_000, seed=1)
    assert closest_distance(points, far).max() < 1e-14
    assert (points[:, 2] > 5).mean() == pytest.approx(0.9, abs=0.01)
    np.testing.assert_array_equal(points, sample_surface(far, 20_000, seed=1))


def test_samples_of_a_mesh_without_area():
    line = TriMesh.of([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    assert closest_distance(sample_surface(line, 100), line).max() < 1e-15


def test_concentric_spheres_are_their_radii_apart():
    a, b = icosphere(4), icosphere(4, radius=1.5)
    there, back = sampled_hausdorff(a, b, samples=5000)
    assert 0.49 < there <= 0.5 + 1e-12
    assert 0.49 < back <= 0.501
    assert mean_distance(a, b, samples=5000) == pytest.approx(0.5, abs=0.003)


def test_the_two_sides_differ_where_one_surface_has_more():
    whole, part = grid_patch(4), TriMesh(grid_patch(4).positions, grid_patch(4).faces[:16])
    assert sampled_hausdorff(whole, part, samples=2000) == pytest.approx((0.5, 0), abs=1e-12)


def test_wrong_use_is_refused():
    with pytest.raises(ValueError, match="shape"):
        closest_distance(np.zeros((3, 2)), icosphere(0))
    with pytest.raises(ValueError, match="no triangle"):
        SurfaceIndex(TriMesh(np.zeros((3, 3)), np.zeros((0, 3), np.int32)))
