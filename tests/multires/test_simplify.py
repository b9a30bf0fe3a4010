"""Edge collapse: planes stay planes, borders and locked vertices stay, topology stays until it may not."""

import numpy as np
import pytest

from foveal.mesh.shapes import grid_patch, icosphere, torus
from foveal.multires.bounds import deviation
from foveal.multires.check import boundary_edges
from foveal.multires.simplify import simplify, twins


def on_grid(mesh, scale=1000):
    return np.round(mesh.positions * scale), mesh.faces


def euler(faces):
    edges = np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    return len(np.unique(faces)) - len(edges) + len(faces)


@pytest.mark.parametrize(("mesh", "characteristic"), [(icosphere(4), 2), (torus(60, 30), 0)])
def test_closed_stays_closed_and_keeps_its_topology(mesh, characteristic):
    positions, faces = on_grid(mesh)
    result = simplify(positions, faces, np.zeros(len(positions), bool), target=300, relaxed_above=len(faces))
    assert len(result.faces) in (299, 300)
    assert boundary_edges(result.faces) == 0
    assert euler(result.faces) == characteristic
    assert not result.is_relaxed


def test_a_plane_is_kept_without_error():
    positions, faces = on_grid(grid_patch(20), 64)
    result = simplify(positions, faces, np.zeros(len(positions), bool), target=50, relaxed_above=800)
    assert len(result.faces) <= 50
    assert (result.positions[:, 2] == 0).all()
    errors = deviation(positions, faces, np.zeros(len(faces), np.float32), result)
    assert errors.max() < 2.0  # the border's corners move by steps, nothing else does


def test_locked_vertices_stay_where_they_are():
    positions, faces = on_grid(icosphere(4))
    locked = positions[:, 0] > 300
    result = simplify(positions, faces, locked, target=100, relaxed_above=100)
    kept = np.isin(np.flatnonzero(locked), result.kept)
    assert kept.all()
    where = np.searchsorted(result.kept, np.flatnonzero(locked))
    np.testing.assert_array_equal(result.positions[where], positions[locked])


def test_small_pieces_vanish_only_when_relaxed():
    base = icosphere(0)
    positions = np.concatenate([np.round(base.positions * 5) + np.array([20 * i, 0, 0]) for i in range(50)])
    faces = np.concatenate([base.faces + 12 * i for i in range(50)]).astype(np.int32)
    free = np.zeros(len(positions), bool)
    strict = simplify(positions, faces, free, target=20, relaxed_above=1000)
    assert len(strict.faces) == 200  # fifty tetrahedra
    relaxed = simplify(positions, faces, free, target=20, relaxed_above=100)
    assert 0 < len(relaxed.faces) <= 20
    assert boundary_edges(relaxed.faces) == 0


def test_twins_are_pairs_that_run_opposite_ways_on_a_manifold():
    faces = icosphere(2).faces
    beside = twins(faces, faces.max() + 1).reshape(-1)
    begin, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    assert (beside[beside] == np.arange(len(beside))).all()
    assert (begin[beside] == end).all()
    assert (end[beside] == begin).all()


def test_twins_are_pairs_where_many_faces_meet():
    # Five faces on the edge (0, 1), three of them one way round: two pairs, and one that is left over.
    faces = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [1, 0, 5], [1, 0, 6]], np.int32)
    beside = twins(faces, 7)
    assert beside[:, 0].tolist() == [9, 12, -2, 0, 3]
    assert (beside[:, 1:] == -1).all()


def test_twins_of_faces_that_disagree_about_the_outside():
    assert twins(np.array([[0, 1, 2], [0, 1, 3]], np.int32), 4)[:, 0].tolist() == [3, 0]


def test_attributes_stay_in_the_hull_of_what_they_were():
    positions, faces = on_grid(icosphere(4))
    values = np.random.default_rng(0).random((len(positions), 2)).astype(np.float32)
    result = simplify(
        positions, faces, np.zeros(len(positions), bool), target=200, relaxed_above=200, attributes=values
    )
    assert result.attributes.shape == (len(result.positions), 2)
    assert result.attributes.min() >= 0
    assert result.attributes.max() <= 1


def test_the_tips_of_thin_spikes_stay():
    # A plate of 40 x 40 with spikes two wide and twelve high: their triangles are few and small.
    plate = grid_patch(40)
    positions = np.round(plate.positions * 40 * 64)
    tops = [
        np.flatnonzero((positions[:, :2] == (64 * x, 64 * y)).all(axis=1))[0]
        for x in (9, 20)
        for y in (9, 20)
    ]
    positions[:, 2] = np.random.default_rng(0).integers(-12, 13, len(positions))  # the plate is rough
    positions[tops, 2] = 12 * 64
    free = np.zeros(len(positions), bool)
    result = simplify(positions, plate.faces, free, target=400, relaxed_above=3200)
    assert (result.positions[:, 2] > 11 * 64).sum() == 4
