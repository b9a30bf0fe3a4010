"""The camera: values by hand, its file's round trip, refusals."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.view.camera import Camera

numbers = st.floats(-1e6, 1e6)
points = st.tuples(numbers, numbers, numbers)


def test_basis_by_hand():
    # From +x towards the origin with z up: right is +y, up +z, backward +x.
    camera = Camera.of([5, 0, 0], [0, 0, 0], up=[0, 0, 1])
    np.testing.assert_allclose(camera.basis(), [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-15)


def test_basis_is_right_handed_and_unit_for_a_slanted_up():
    basis = Camera.of([3, -2, 7], [1, 1, 1], up=[0.2, 5, -1]).basis()
    np.testing.assert_allclose(basis @ basis.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(basis) == pytest.approx(1)
    assert basis[1] @ [0.2, 5, -1] > 0


def test_pixels_per_radian_by_hand():
    camera = Camera.of([0, 0, 1], [0, 0, 0], field_of_view=math.pi / 2, height=200)
    assert camera.pixels_per_radian() == pytest.approx(100)


def test_near_and_far_follow_the_distance():
    camera = Camera.of([0, 0, 50], [0, 0, 0])
    assert (camera.near, camera.far) == (0.05, 50_000)


def test_frustum_planes_are_unit_and_hold_the_target():
    camera = Camera.of([3, 4, 5], [1, 0, 2], near=0.1)
    planes = camera.frustum()
    np.testing.assert_allclose(np.linalg.norm(planes[:, :3], axis=1), 1)
    assert (planes[:, :3] @ camera.target + planes[:, 3] > 0).all()
    # The eye lies on the four sides and the near distance behind the near plane.
    np.testing.assert_allclose(planes[:, :3] @ camera.position + planes[:, 3], [-0.1, 0, 0, 0, 0], atol=1e-14)


@given(points, points, st.floats(0.01, 3), st.integers(1, 4000), st.integers(1, 4000))
def test_a_camera_around_a_box_sees_all_its_corners(low, high, angle, width, height):
    low, high = np.minimum(low, high), np.maximum(low, high) + 1e-3
    camera = Camera.around(low, high, field_of_view=angle, width=width, height=height)
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    planes = camera.frustum()[1:]
    slack = 1e-9 * np.abs(corners - camera.position).max() + 1e-9 * np.abs(camera.position).max()
    assert (corners @ planes[:, :3].T + planes[:, 3] >= -slack).all()


def test_json_round_trip():
    camera = Camera.of([1, 2, 3], [4, 5, 6], up=[0, 0, 1], field_of_view=0.7, width=640, height=480)
    again = Camera.from_json(camera.to_json())
    assert again.field_of_view == pytest.approx(camera.field_of_view, rel=1e-15)
    assert (again.width, again.height) == (640, 480)
    for name in ("position", "target", "up"):
        np.testing.assert_array_equal(getattr(again, name), getattr(camera, name))


def test_json_defaults():
    camera = Camera.from_json({"position": [0, 0, 1], "target": [0, 0, 0]})
    assert (camera.width, camera.height) == (1280, 720)
    assert math.degrees(camera.field_of_view) == pytest.approx(40)  # as in the viewer


def test_resized_keeps_all_but_the_size():
    camera = Camera.of([1, 2, 3], [4, 5, 6], near=0.25, far=9)
    again = camera.resized(64, 48)
    assert (again.width, again.height, again.near, again.far) == (64, 48, 0.25, 9)
    assert again.position is camera.position
    with pytest.raises(FovealError, match="from 1 to"):
        camera.resized(64, 0)


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        (([0, 0, 1], [0, 0, 1]), {}, "the same point"),
        (([0, 1, 0], [0, 0, 0]), {}, "along its own up"),
        (([0, 0, 1], [0, 0, 0]), {"up": [0, 0, 0]}, "up"),
        (([0, 0, 1], [0, 0, 0]), {"field_of_view": math.pi}, "between 0 and 180"),
        (([0, 0, 1], [0, 0, 0]), {"field_of_view": float("nan")}, "between 0 and 180"),
        (([0, 0, 1], [0, 0, 0]), {"width": 0}, "from 1 to 16384 pixels"),
        (([0, 0, 1], [0, 0, 0]), {"width": 1e9}, "from 1 to 16384 pixels"),
        (([0, 0, 1], [0, 0, 0]), {"height": 10.5}, "whole pixels"),
        (([0, 0, 1e200], [0, 0, 0]), {}, "below 1e100"),
        (([0, 0, 1], [0, 0, 0]), {"near": 2, "far": 1}, "near and far"),
        (([0, 0, float("inf")], [0, 0, 0]), {}, "position must be three numbers"),
        (([0, 1], [0, 0, 0]), {}, "position must be three numbers"),
        (([0, [1], 2], [0, 0, 0]), {}, "position must be three numbers"),
        ((["0", "0", "1"], [0, 0, 0]), {}, "position must be three numbers"),
        (([0, 0, 10**400], [0, 0, 0]), {}, "position must be three numbers"),
        (([0, 0, 1e-160], [0, 0, 0]), {}, "the same point"),
    ],
)
def test_impossible_cameras_are_refused(arguments, options, words):
    with pytest.raises(FovealError, match=words):
        Camera.of(*arguments, **options)


@pytest.mark.parametrize(
    "data",
    [
        [],
        None,
        "camera",
        {},
        {"position": [0, 0, 1]},
        {"position": "abc", "target": [0, 0, 0]},
        {"position": [0, 0, 1], "target": [0, 0, 0], "size": 5},
        {"position": [0, 0, 1], "target": [0, 0, 0], "size": [5]},
        {"position": [0, 0, 1], "target": [0, 0, 0], "size": [5, 5, 5]},
        {"position": [0, 0, "1"], "target": [0, 0, 0]},
        {"position": [0, 0, None], "target": [0, 0, 0]},
        {"position": {"x": 1}, "target": [0, 0, 0]},
        {"position": [0, 0, 1], "target": [0, 0, 0], "field_of_view_degrees": "wide"},
        {"position": [0, 0, 1], "target": [0, 0, 0], "size": [0, 5]},
        {"position": [0, 0, 1], "target": [0, 0, 0], "size": [float("inf"), 5]},
        {"position": [0, 0, 1], "target": [0, 0, 0], "size": [10.5, "5"]},
    ],
)
def test_a_file_that_is_no_camera_is_refused_by_name(data):
    with pytest.raises(FovealError, match=r"^cam\.json: (?!camera)"):
        Camera.from_json(data, name="cam.json")


def test_whole_numbers_of_any_size_are_numbers():
    assert Camera.from_json({"position": [0, 0, 10**30], "target": [0, 0, 0]}).position[2] == 1e30


def test_a_box_that_is_a_point_is_seen_too():
    camera = Camera.around([3, 4, 5], [3, 4, 5])
    assert np.linalg.norm(camera.position - camera.target) > 0
    np.testing.assert_array_equal(camera.target, [3, 4, 5])


@pytest.mark.parametrize("direction", [[0, 0, 0], [0, 0, 1e-200], [0, 1, 0]])
def test_a_direction_that_is_none_is_said(direction):
    with pytest.raises(FovealError, match="direction"):
        Camera.around([0, 0, 0], [1, 1, 1], direction=direction)
