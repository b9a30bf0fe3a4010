"""The rasteriser: by hand, against rays, and the laws of shared edges, threads and large coordinates."""

import dataclasses
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from foveal.base.errors import FovealError
from foveal.mesh.shapes import icosphere
from foveal.raster.rasterise import rasterise
from foveal.view.camera import Camera
from raster import naive_raster

ONE = ThreadPoolExecutor(1)  # threads begin with the first task; none outlives the tests
seeds = st.integers(0, 2**32 - 1)
few = settings(max_examples=40, deadline=None)


def ahead(**options):
    """A pixel of this camera is a unit wide in the plane z = 0, the origin in the middle."""
    return Camera.of(
        [0, 0, 10], [0, 0, 0], **{"field_of_view": np.pi / 2, "width": 20, "height": 20} | options
    )


def draw(positions, faces, camera):
    return rasterise(positions, faces, camera, executor=ONE)


def covered(positions, faces, camera):
    """How many of the faces cover each sample, drawn one by one."""
    return sum((draw(positions, [face], camera).face_ids >= 0).astype(int) for face in faces)


def assert_like_rays(positions, faces, camera, *, reach=0.02):
    """Equal to casting rays, as far as rays moved by `reach` pixels agree with one another."""
    found = draw(positions, faces, camera)
    ring = [(0.0, 0.0)] + [(np.cos(a) * reach, np.sin(a) * reach) for a in np.arange(8) * np.pi / 4]
    casts = [naive_raster.cast(positions, faces, camera, shift=shift) for shift in ring]
    ids, depths = (np.stack(one) for one in zip(*casts, strict=True))
    # The depth of a face seen nearly edge-on changes by per cents within the rounding of a place.
    low, high = depths.min(axis=0) * 0.98, depths.max(axis=0) * 1.02
    is_close = (found.depth >= low) & (found.depth <= high)
    # Where two faces meet or cross, either may win; its depth decides.
    is_same = (ids == found.face_ids).any(axis=0) | ((found.face_ids >= 0) & np.isfinite(depths).any(axis=0))
    assert is_close.all()
    assert is_same.all()


def test_a_square_covers_the_samples_within_it_and_a_shared_edge_counts_once():
    corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
    seen = draw(corners, [[0, 1, 3], [1, 2, 3]], ahead())
    inside = np.zeros((20, 20), dtype=bool)
    inside[8:12, 8:12] = True
    np.testing.assert_array_equal(seen.face_ids >= 0, inside)
    np.testing.assert_array_equal(seen.depth, np.where(inside, np.float32(10), np.float32(np.inf)))
    assert (seen.weights[~inside] == 0).all()


def test_samples_on_an_edge_belong_to_the_triangle_right_of_it_or_below():
    # Edges run through samples: x and y from -2.5 to 2.5. Left and top are in, right and bottom out.
    corners = [[-2.5, -2.5, 0], [2.5, -2.5, 0], [2.5, 2.5, 0], [-2.5, 2.5, 0]]
    seen = draw(corners, [[0, 1, 2], [0, 2, 3]], ahead()).face_ids >= 0
    rows, columns = np.nonzero(seen)
    assert (rows.min(), rows.max(), columns.min(), columns.max()) == (7, 11, 7, 11)


def test_a_triangle_whose_corner_alone_is_a_sample_covers_it_if_it_is_the_upper_left_one():
    corner = np.array([-0.5, 0.5, 0])
    for right, down, is_seen in (
        (0.4, -0.4, True),
        (-0.4, -0.4, False),
        (0.4, 0.4, False),
        (-0.4, 0.4, False),
    ):
        seen = draw(
            [corner, corner + np.array([right, 0, 0]), corner + np.array([0, down, 0])], [[0, 1, 2]], ahead()
        ).face_ids
        assert (seen >= 0).sum() == is_seen


def test_weights_know_perspective():
    # A strip that recedes: half way across the picture is not half way along it.
    corners = np.array([[-5, -1, 5], [-5, 1, 5], [30, -1, -20], [30, 1, -20]], dtype=float)
    camera = ahead(width=200, height=40, field_of_view=0.4)
    faces = np.array([[0, 2, 1], [1, 2, 3]])
    seen = draw(corners, faces, camera)
    rows, columns = np.nonzero(seen.face_ids >= 0)
    assert len(rows) > 1000
    points = (corners[faces[seen.face_ids[rows, columns]]] * seen.weights[rows, columns][..., None]).sum(1)
    relative = points - camera.position
    depth = -relative[:, 2]
    np.testing.assert_allclose(
        relative[:, 0] / depth * camera.pixels_per_radian() + 100, columns + 0.5, atol=0.01
    )
    np.testing.assert_allclose(
        20 - relative[:, 1] / depth * camera.pixels_per_radian(), rows + 0.5, atol=0.01
    )
    np.testing.assert_allclose(seen.depth[rows, columns], depth, rtol=0.01)


def test_the_nearer_face_is_seen_and_of_equal_ones_the_lower():
    near, far = [[-9, -9, 1], [9, -9, 1], [0, 9, 1]], [[-9, -9, -1], [9, -9, -1], [0, 9, -1]]
    positions = np.array(far + near + near)
    faces = np.arange(9).reshape(3, 3)
    for order in ([0, 1, 2], [1, 0, 2], [2, 1, 0]):
        seen = draw(positions, faces[order], ahead()).face_ids[10, 10]
        assert seen == min(order.index(1), order.index(2))


def test_both_sides_are_drawn():
    corners = [[-5, -5, 0], [5, -5, 0], [0, 5, 0]]
    front, back = draw(corners, [[0, 1, 2]], ahead()), draw(corners, [[0, 2, 1]], ahead())
    np.testing.assert_array_equal(front.face_ids, back.face_ids)


def test_only_what_is_between_near_and_far_is_drawn():
    corners = np.array([[-50, -50, 0], [50, -50, 0], [0, 50, 0]], dtype=float)
    for near, far, is_seen in ((9.9, 10.1, True), (10.1, 20, False), (1, 9.9, False)):
        seen = draw(corners, [[0, 1, 2]], ahead(near=near, far=far)).face_ids
        assert (seen[10, 10] == 0) == is_seen
    behind = corners + np.array([0, 0, 20])
    assert (draw(behind, [[0, 1, 2]], ahead()).face_ids == -1).all()


@few
@given(seeds, st.sampled_from([0.3, 3.0, 12.0]))
def test_agrees_with_rays(seed, spread):
    # Spread 12 puts corners behind the eye and across the near plane.
    rng = np.random.default_rng(seed)
    positions = rng.normal(size=(18, 3)) * spread
    camera = Camera.of(
        *([0, 0, 10], rng.normal(size=3)),
        field_of_view=rng.uniform(0.3, 2.5),
        width=31,
        height=23,
        near=rng.choice([0.01, 1.0]),
        far=100,
    )
    assert_like_rays(positions, rng.integers(0, 18, (12, 3)), camera)


@pytest.mark.parametrize("size", [1e3, 1e6, 1e9, 1e12])
def test_huge_triangles_agree_with_rays(size):
    rng = np.random.default_rng(int(np.log10(size)))
    positions = rng.normal(size=(9, 3)) * size
    assert_like_rays(positions, np.arange(9).reshape(3, 3), ahead(near=0.1, far=1e15))


def tiling(rng, kind):
    """Points of a plane and triangles that tile a square of 40 units or more of it, once."""
    if kind == "far aside":  # a fan; corners up to 10^9 pixels away
        angles = np.sort(rng.uniform(0, 2 * np.pi, 9))
        assume((np.diff([*angles, angles[0] + 2 * np.pi]) < 2.5).all() and np.diff(angles).min() > 1e-3)
        away = 10.0 ** rng.uniform(2, 9, 9)
        middle = rng.uniform(-8, 8, size=(1, 2))  # of the angles, too: else some triangle may be turned over
        ring = middle + np.column_stack([np.cos(angles), np.sin(angles)]) * away[:, None]
        points = np.concatenate([middle, ring])
        return points, np.array([[0, i + 1, (i + 1) % 9 + 1] for i in range(9)])
    points = rng.uniform(-8, 8, size=(14, 2))
    if kind == "samples":  # corners and edges run through samples
        points = np.unique(rng.integers(-8, 8, size=(14, 2)) + 0.5, axis=0)
    points = np.concatenate([points, [[-40, -40], [40, -40], [40, 40], [-40, 40]]])
    faces = Delaunay(points).simplices
    # A triangle thinner than the rounding of places may turn over.
    a, b, c = points[faces].transpose(1, 2, 0)
    areas = np.abs((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
    longest = np.max([np.linalg.norm(e, axis=0) for e in (b - a, c - b, a - c)], axis=0)
    assume((areas > 0.05 * longest).all())
    return points, faces


@few
@given(seeds, st.sampled_from(["any", "samples", "far aside"]))
def test_a_triangulated_plane_covers_each_sample_exactly_once(seed, kind):
    points, faces = tiling(np.random.default_rng(seed), kind)
    positions = np.column_stack([points, np.zeros(len(points))])
    assert (covered(positions, faces, ahead(near=0.1)) == 1).all()


@few
@given(seeds)
def test_a_plane_that_runs_behind_the_eye_is_covered_at_most_once_without_gaps(seed):
    points, faces = tiling(np.random.default_rng(seed), "any")
    positions = np.column_stack([points[:, 0], np.full(len(points), -3.0), points[:, 1]])
    camera = ahead(near=2.0, far=1e6)
    counts = covered(positions, faces, camera)
    assert counts.max() == 1
    depths = naive_raster.cast(positions[-4:], [[0, 1, 2], [0, 2, 3]], camera)[1]
    assert counts[(depths > 2.001) & (depths < 30)].all()


def test_a_closed_surface_shows_no_background_inside_its_outline():
    ball = icosphere(4)
    camera = Camera.of([0, 0, 1.5], [0, 0, 0], field_of_view=0.8, width=150, height=150)
    assert (draw(ball.positions, ball.faces, camera).face_ids >= 0).all()


@pytest.mark.parametrize(
    "corners",
    [
        [[0, 0, 0], [0, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [1, 1, 0], [2, 2, 0]],
        [[0, 0, 10], [1, 0, 10], [0, 1, 10]],  # in the plane of the eye
        [[0, 0, 10], [0, 0, 5], [0, 0, 0]],  # along the line of sight
        [[1e300, 0, 0], [0, 1e300, 0], [0, 0, -1e300]],
        [[1e-300, 0, 9.99], [0, 1e-300, 9.99], [0, 0, 9.99]],
        [[-1e200, -1, 9.995], [1e200, -1, 9.995], [0, 1e200, 9.995]],
    ],
)
def test_degenerate_and_absurd_triangles_do_no_harm(corners):
    seen = draw(corners, [[0, 1, 2]], ahead())
    assert np.isin(seen.face_ids, [-1, 0]).all()
    assert not np.isnan(seen.depth).any()
    assert np.isfinite(seen.weights).all()


def test_the_number_of_threads_and_the_height_of_bands_change_no_bit(monkeypatch):
    ball = icosphere(5)
    camera = Camera.of([0.2, 0.4, 1.3], [0, 0, 0], width=173, height=331)
    results = []
    for workers, rows in ((1, 64), (3, 64), (2, 7), (2, 1000)):
        monkeypatch.setattr(sys.modules["foveal.raster.rasterise"], "BAND_ROWS", rows)
        with ThreadPoolExecutor(workers) as pool:
            results.append(rasterise(ball.positions, ball.faces, camera, executor=pool))
    for name in ("depth", "face_ids", "weights"):
        first, *others = (getattr(result, name).tobytes() for result in results)
        assert all(other == first for other in others)


def test_large_coordinates_do_not_jitter():
    ball = icosphere(3)
    positions = np.round(ball.positions * 4096) / 4096  # so that the shift is exact
    camera = Camera.of([0, 0.5, 3], [0, 0, 0], width=90, height=70)
    shift = np.array([500_000.0, 4_649_776.0, 128.0])
    moved = Camera.of(camera.position + shift, camera.target + shift, width=90, height=70)
    here, there = draw(positions, ball.faces, camera), draw(positions + shift, ball.faces, moved)
    np.testing.assert_array_equal(here.face_ids, there.face_ids)
    np.testing.assert_array_equal(here.depth, there.depth)


def test_a_picture_that_is_too_large_is_refused():
    with pytest.raises(FovealError, match="too large"):
        draw([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], dataclasses.replace(ahead(), width=40_000))
