"""The bound of a simplified cell: never below what samples find, seldom far above."""

import numpy as np
import pytest

from foveal.mesh.distance import closest_distance, sample_surface, sampled_hausdorff
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain
from foveal.mesh.trimesh import TriMesh
from foveal.multires.bounds import deviation
from foveal.multires.simplify import simplify


def sampled(a, b, seed):
    return closest_distance(sample_surface(a, 20_000, seed=seed), b).max()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("make", [lambda s: bumpy_sphere(5, seed=s), lambda s: terrain(70, seed=s)])
@pytest.mark.parametrize("share", [2, 20])
def test_the_bound_holds_and_is_tight(make, seed, share):
    mesh = make(seed)
    fine = TriMesh.of(np.round(mesh.positions * 5000), mesh.faces)
    free = np.zeros(len(fine.positions), bool)
    count = len(fine.faces)
    coarse = simplify(fine.positions, fine.faces, free, target=count // share, relaxed_above=count)
    errors = deviation(fine.positions, fine.faces, np.zeros(count, np.float32), coarse)
    result = TriMesh.of(coarse.positions, coarse.faces)
    found = max(sampled_hausdorff(fine, result, samples=20_000, seed=seed))
    assert found <= errors.max() <= 2.0 * found


def test_what_the_fine_side_carries_is_added():
    mesh = icosphere(4)
    positions = np.round(mesh.positions * 1000)
    free = np.zeros(len(positions), bool)
    coarse = simplify(positions, mesh.faces, free, target=1000, relaxed_above=5000)
    plain = deviation(positions, mesh.faces, np.zeros(len(mesh.faces), np.float32), coarse)
    loaded = deviation(positions, mesh.faces, np.full(len(mesh.faces), 7, np.float32), coarse)
    np.testing.assert_allclose(loaded, plain + 7, rtol=1e-5, atol=1e-4)


def test_the_same_surface_is_at_no_distance():
    mesh = icosphere(2)
    positions = np.round(mesh.positions * 100)
    free = np.zeros(len(positions), bool)
    same = simplify(positions, mesh.faces, free, target=len(mesh.faces), relaxed_above=len(mesh.faces))
    assert deviation(positions, mesh.faces, np.zeros(len(mesh.faces), np.float32), same).max() < 1e-5


def test_a_piece_that_vanished_counts():
    # Two flat squares ten apart: if one is gone, the bound must be ten at least.
    square = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], float)
    positions = np.concatenate([square, square + np.array([0, 0, 10])])
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]], np.int32)
    coarse = simplify(positions, faces, np.zeros(8, bool), target=2, relaxed_above=2)
    errors = deviation(positions, faces, np.zeros(4, np.float32), coarse)
    result = TriMesh.of(coarse.positions, coarse.faces)
    assert errors.max() >= sampled(TriMesh.of(positions, faces), result, 0)
