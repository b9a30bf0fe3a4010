"""Projected size and frustum: values by hand, and that both err on the safe side."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.view.camera import Camera
from foveal.view.project import screen_error, sphere_in_frustum

CAMERA = Camera.of([0, 0, 10], [0, 0, 0], field_of_view=np.pi / 2, width=400, height=200, near=0.5)
numbers = st.floats(-30, 30)
points = st.tuples(numbers, numbers, numbers).map(np.array)


@pytest.mark.parametrize(
    ("error", "centre", "radius", "pixels"),
    [
        (1, (0, 0, 0), 0, 10),  # 100 pixels a unit at distance 1
        (1, (0, 0, 0), 5, 20),
        (1, (3, 4, 10), 0, 20),  # beside the eye counts as much as ahead
        (1, (0, 0, 9.75), 0, 200),  # nearer than the near plane
        (1, (0, 0, 9), 1, np.inf),
        (1, (0, 0, 10), 3, np.inf),
        (0, (0, 0, 10), 3, 0),
        (np.inf, (0, 0, 0), 1, np.inf),
    ],
)
def test_screen_error_by_hand(error, centre, radius, pixels):
    assert screen_error(error, centre, radius, CAMERA) == pytest.approx(pixels)


@given(points, st.floats(0, 20), points, st.floats(0.001, 10))
def test_no_point_of_the_sphere_shows_a_larger_error(centre, radius, towards, error):
    length = np.linalg.norm(towards)
    inside = centre + (towards / length * radius if length > 0 else 0)
    whole = screen_error(error, centre, radius, CAMERA)
    assert whole * (1 + 1e-9) >= screen_error(error, inside, 0, CAMERA) or np.isinf(whole)


def test_frustum_by_hand():
    # 45 degrees up and down; the picture is twice as wide as high.
    centres = [(0, 9, 0), (0, 11, 0), (19, 0, 0), (21, 0, 0), (0, 0, 9.6), (0, 0, 9.4), (0, 0, -9e9)]
    seen = sphere_in_frustum(centres, np.zeros(7), CAMERA.frustum())
    assert seen.tolist() == [True, False, True, False, False, True, True]


@given(points, st.floats(0, 20), points)
def test_a_sphere_with_a_visible_point_counts_as_seen(centre, radius, towards):
    length = np.linalg.norm(towards)
    point = centre + (towards / length * radius * 0.999 if length > 0 else 0)
    planes = CAMERA.frustum()
    if (planes[:, :3] @ point + planes[:, 3] >= 0).all():
        assert sphere_in_frustum(centre, radius, planes)
