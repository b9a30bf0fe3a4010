"""Masks of control vertices: limits stay where a step takes them, and are the same numbers as in the page."""

import math

import numpy as np
import pytest

from foveal.refine import _kernels_slates_masks as kernels
from foveal.refine.slates_masks import Ring, mask_of


def pulled(ring, row):
    centres, out = np.empty(ring.faces), np.empty(len(row))
    kernels.pull(ring.faces, np.array(ring.spokes), ring.sharpness, row, centres, out)
    return out


def dart(n):
    return Ring(n, (math.inf,) + (n - 1) * (0.0,))


RINGS = {
    **{f"inner {n}": Ring(n, n * (0.0,)) for n in (2, 3, 4, 5, 9, 31)},
    **{f"dart {n}": dart(n) for n in (2, 3, 4, 5, 12, 40)},
    **{f"border {k}": Ring(k, (math.inf, *(k - 1) * (0.0,), math.inf)) for k in (1, 2, 3)},
    "crease": Ring(5, (0.0, math.inf, 0.0, 0.0, math.inf)),
}


@pytest.mark.parametrize("ring", RINGS.values(), ids=RINGS)
def test_limit_points_and_tangents_are_left_eigenvectors(ring):
    rows = mask_of(ring, 0).rows
    assert rows[0].sum() == pytest.approx(1, abs=1e-14)
    np.testing.assert_allclose(pulled(ring, rows[0]), rows[0], atol=2e-14)
    for row in rows[-2:]:
        after = pulled(ring, row)
        size = after @ row / (row @ row)
        assert 0.2 < size < 0.7
        assert abs(row.sum()) < 1e-12 * np.abs(row).max()
        np.testing.assert_allclose(after, size * row, atol=1e-12 * np.abs(row).max())


def test_a_dart_of_four_faces():
    point = mask_of(dart(4), 0).rows[0]
    assert point[:2] == pytest.approx([0.46766, 0.1306], abs=5e-5)


@pytest.mark.parametrize("spokes", [(0.3, 0.0, 2.5, 0.0, 0.0), (1.0, 1.4, 0.6, 0.0), (0.0, 3.0, 0.0)])
def test_a_semi_sharp_mask_is_the_settled_one_some_steps_on(spokes):
    ring = Ring(len(spokes), spokes, 0.5)
    rows = mask_of(ring, 3).rows
    np.testing.assert_allclose(rows[0], pulled(ring, mask_of(ring.after(1), 2).rows[0]), atol=1e-15)
    assert rows[0].min() >= 0
    assert rows[0].sum() == pytest.approx(1, abs=1e-15)


def test_a_vertex_of_no_face_stays():
    assert mask_of(Ring(0, ()), 2).rows.tolist() == [[1.0]]
