"""Partitions: ratios as in the paper, no plane in two levels that follow, all triangles somewhere."""

import numpy as np
import pytest

from foveal.mesh.shapes import icosphere
from foveal.multires.partition import partition
from foveal.multires.pieces import Piece, join, split


def points(count, seed=0):
    return np.random.default_rng(seed).random((count, 3)) * 1000


@pytest.mark.parametrize("level", [0, 1])
def test_the_first_plane_takes_four_or_six_tenths(level):
    cloud = points(1000)
    cloud[:, 1] *= 3
    found = partition(cloud, limit=700, level=level)
    assert found.nodes[0, 0] == 1  # the longest axis
    below = (cloud[:, 1] < found.planes[0]).sum()
    assert below == (400 if level == 0 else 600)


def test_levels_that_follow_share_no_plane():
    cloud = points(5000)
    even, odd = (partition(cloud, limit=300, level=level) for level in (0, 1))
    assert len(np.intersect1d(even.planes, odd.planes)) == 0


def test_no_cell_is_above_the_limit_or_empty():
    cloud = points(5000)
    found = partition(cloud, limit=300, level=0)
    faces = np.arange(len(cloud), dtype=np.int32).repeat(3).reshape(-1, 3)
    # Positions thirds of the points: centroids are sums of three corners.
    cells = found.assign((cloud * 1e6 / 3).astype(np.int32), faces)
    assert found.cells == len(found.nodes) + 1
    scaled = partition(cloud * 1e6, limit=300, level=0)
    cells = scaled.assign((cloud * 1e6 / 3).astype(np.int32), faces)
    counts = np.bincount(cells, minlength=scaled.cells)
    assert counts.min() > 0
    assert counts.max() <= 301  # one to the next by rounding


def test_points_in_one_place_are_one_cell():
    assert partition(np.ones((100, 3)), limit=10, level=0).cells == 1


def test_joining_what_was_split_gives_it_back():
    ball = icosphere(3)
    positions = np.round(ball.positions * 1000).astype(np.int32)
    piece = Piece(
        np.arange(100, 100 + len(positions), dtype=np.int32),
        positions,
        ball.faces,
        np.arange(len(ball.faces), dtype=np.float32),
        positions.astype(np.float32),
    )
    cells = partition(positions.astype(float)[ball.faces].sum(axis=1), limit=200, level=0)
    parts = split(piece, cells)
    assert [cell for cell, _ in parts] == list(range(cells.cells))
    whole, maps = join([part for _, part in parts])
    assert len(whole.ids) == len(positions)
    for (_, part), where in zip(parts, maps, strict=True):
        np.testing.assert_array_equal(whole.positions[where], part.positions)
    # Errors number the faces: with them each face has its own corners again.
    order = np.argsort(whole.errors)
    np.testing.assert_array_equal(whole.ids[whole.faces[order]] - 100, ball.faces)
