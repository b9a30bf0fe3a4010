"""Lights: frames that are tight, pixels that stay in place, and a sentence for what lights nothing."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal import FovealError
from foveal.shadows import AreaLight, Directional, Point, Spot, Sun, SunPath, light_from_json
from foveal.shadows.frames import basis, checked_resolution, unit
from foveal.shadows.samples import hilbert, on_a_disc, on_a_square

SUN = Sun("2026-06-21T15:00+02:00", 43.72, 10.40, up="z")
DAY = SunPath("2026-06-21T08:00+02:00", "2026-06-21T18:00+02:00", 11, 43.72, 10.40, up="z")
HOURS = SunPath("2026-06-21T11:00+02:00", "2026-06-21T15:00+02:00", 5, 43.72, 10.40, up="z")
SPOT = Spot((1, 2, 9), (0, 0, 0), 1.0)
LIGHTS = {
    "directional": Directional((1, 2, -3)),
    "down": Directional((0, 0, -1)),
    "sun": SUN,
    "spot": SPOT,
    "point": Point((0.1, 0.2, 6)),
    "disc": AreaLight(SPOT, radius=0.5, samples=16),
    "rectangle": AreaLight(SPOT, size=(0.5, 1.0), samples=16, jitter=True, seed=3),
    "sun's disc": AreaLight(SUN, radius=0.01, samples=16),
    "sky": AreaLight(Directional((0, 1, -1)), size=(0.2, 1.0), samples=4),
    "hours": HOURS,
    "day": DAY,
}
STACKS = {name: light for name, light in LIGHTS.items() if light.is_stack}
DIRECTIONS = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda d: np.linalg.norm(d) > 1e-3)


def scene(seed=1, size=400, scale=1.0, offset=(0.0, 0.0, 0.0)):
    return np.random.default_rng(seed).random((size, 3)) * [8, 6, 2] * scale - [4, 3, 1] + offset


def is_placed(light):
    return isinstance(getattr(light, "light", light), (Spot, Point))


@pytest.mark.parametrize("name", LIGHTS)
def test_the_scene_is_on_the_map_and_never_at_its_far_end(name):
    light = LIGHTS[name]
    # Of a light at a place what is in its cone is on the map; a scene that is no more than that fits whole.
    positions = scene() * (0.1 if is_placed(light) else 1.0)
    for projection in light.projections(positions, 64):
        u, v, depth = projection.project(positions).T
        assert (depth <= 1 - 2**-10).all()
        if not isinstance(light, Point):
            assert (depth >= 0).all()
            assert (np.abs(np.array([u, v]) - 0.5) < 0.5).all()


@pytest.mark.parametrize("name", [name for name, light in LIGHTS.items() if not is_placed(light)])
def test_coordinates_may_begin_far_away(name):
    """As they do on maps: to the place of a thousandth of a pixel of the largest map."""
    far = np.array([4e5, 5e6, 100])
    near = LIGHTS[name].projections(scene(), 64)
    for a, b in zip(near, LIGHTS[name].projections(scene() + far, 64), strict=True):
        np.testing.assert_allclose(b.project(scene() + far), a.project(scene()), atol=1e-3 / 2**20)


@given(DIRECTIONS, st.integers(1, 50), st.integers(0, 99))
def test_parallel_light_has_a_frame_as_tight_as_it_can_be(direction, size, seed):
    positions = scene(seed, size)
    (projection,) = Directional(direction).projections(positions, 4096)
    seen = projection.project(positions)
    assert projection.is_parallel
    assert (seen >= 0).all()
    assert (seen < 1).all()
    if size > 1:
        np.testing.assert_allclose(seen.min(axis=0), 0, atol=2**-8)
        np.testing.assert_allclose(seen.max(axis=0), 1, atol=2**-8)
    along = projection.project(positions + np.array(direction))  # along the light only the depth changes
    np.testing.assert_allclose(along[:, :2], seen[:, :2], atol=1e-9)
    assert (along[:, 2] > seen[:, 2]).all()


@pytest.mark.parametrize("name", LIGHTS)
def test_the_frame_is_the_same_at_every_resolution_and_of_each_order_of_points(name):
    if name == "point":  # its seams are in pixels
        return
    coarse = LIGHTS[name].projections(scene(), 64)
    fine = LIGHTS[name].projections(scene()[::-1], 1 << 20)
    assert len(coarse) == len(fine)
    for a, b in zip(coarse, fine, strict=True):
        np.testing.assert_allclose(a.matrix, b.matrix, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", LIGHTS)
def test_light_goes_through_a_pixel_along_the_direction_towards_it(name):
    """Moved towards the light, a point stays in its place of the map and comes nearer."""
    light = LIGHTS[name]
    points = scene(size=50)
    for image, projection in enumerate(light.projections(scene(), 64)):
        towards = light.towards(points, 0 if name == "point" else image)
        np.testing.assert_allclose(np.linalg.norm(towards, axis=1), 1)
        before, after = projection.project(points), projection.project(points + 0.3 * towards)
        is_ahead = np.isfinite(before).all(axis=1) & np.isfinite(after).all(axis=1)
        np.testing.assert_allclose(after[is_ahead, :2], before[is_ahead, :2], atol=1e-9)
        assert (after[is_ahead, 2] < before[is_ahead, 2]).all()
        assert is_ahead.any() or name == "point"


@pytest.mark.parametrize("name", LIGHTS)
def test_fronts_are_counter_clockwise_on_the_map(name):
    """A triangle that faces the light has its corners as a person there would see them, v going up."""
    light = LIGHTS[name]
    corner = np.array([0.1, 0.2, 0.3])
    for image, projection in enumerate(light.projections(scene(), 64)):
        towards = light.towards([corner], 0 if name == "point" else image)[0]
        right, up, _ = basis(-towards)
        uv = projection.project([corner, corner + 0.01 * right, corner + 0.01 * up])[:, :2]
        if np.isfinite(uv).all():
            a, b = uv[1] - uv[0], uv[2] - uv[0]
            assert a[0] * b[1] - a[1] * b[0] > 0


@pytest.mark.parametrize("name", LIGHTS)
def test_depth_is_linear(name):
    for projection in LIGHTS[name].projections(scene(), 64):
        ends = projection.project([[0, 0, 0], [0.4, -0.2, 0.6]])[:, 2]
        middle = projection.project([[0.2, -0.1, 0.3]])[0, 2]
        assert middle == pytest.approx(ends.mean(), abs=1e-12)


@pytest.mark.parametrize("name", STACKS)
def test_images_of_a_stack_share_a_window(name):
    light = STACKS[name]
    projections = light.projections(scene(), 64)
    assert len(projections) == light.images == len(light.towards([[0, 0, 0]] * light.images))
    rays = np.array([projection.project([[0.3, 0.1, 0.2]])[0] for projection in projections])
    if name == "day":
        return  # 10 hours are more than 60 degrees from the middle: each has a frame of its own
    assert np.ptp(rays[:, 2]) < 1e-9  # all measure depth alike
    # What lies on the plane of the window stays in place: a point whose depth is in the middle.
    middle = np.array([0.0, 0.0, 0.0])
    matrix = projections[0].matrix
    ahead = matrix[2, :3] / np.linalg.norm(matrix[2, :3]) ** 2
    seen = [projection.project(scene())[:, 2] for projection in projections]
    centre = (seen[0].min() + seen[0].max()) / 2
    on_plane = middle + ahead * (centre - projections[0].project([middle])[0, 2])
    places = np.array([projection.project([on_plane])[0, :2] for projection in projections])
    np.testing.assert_allclose(np.ptp(places, axis=0), 0, atol=1e-9)
    assert np.ptp([projection.project([[0.3, 0.1, 5.0]])[0, 0] for projection in projections]) > 1e-4


def test_a_path_of_few_hours_shares_a_window_and_a_day_does_not():
    near, far = (np.array([p.matrix for p in path.projections(scene(), 64)]) for path in (HOURS, DAY))
    assert np.ptp(near[:, 2], axis=0).max() < 1e-12
    assert np.ptp(far[:, 2], axis=0).max() > 0.01


def test_a_spot_light_looks_no_farther_than_the_scene_and_its_cone():
    ball = scene(scale=0.01) * 0.1
    (projection,) = Spot((0, 0, 10), (0, 0, 0), 1.0).projections(ball, 64)
    seen = projection.project(ball)
    assert seen[:, 2].min() < 0.01
    assert seen[:, 2].max() > 0.99
    np.testing.assert_allclose(np.ptp(seen, axis=0), 1, atol=0.02)
    # Ground that goes on under the light and behind it: the cone is the frame.
    ground = np.array([[-100, -100, 0], [100, -100, 0], [0, 100, 0], [0, 0, 11.0]])
    (projection,) = Spot((0, 0, 10), (0, 0, 0), math.pi / 2).projections(ground, 64)
    np.testing.assert_allclose(projection.project([[9.9, -9.9, 0]])[0, :2], [0.995, 0.005], atol=0.01)


def test_a_cube_sees_every_point_once_by_its_rule_and_again_at_its_seams():
    light = Point((0.1, 0.2, 0.3))
    points = np.concatenate([scene(size=2000), light.position + hilbert_signs()])
    faces = light.face(points)
    for n in (16, 64, 4096, 1 << 20):
        projections = light.projections(points, n)
        uv = np.array([projections[f].project([p])[0, :2] for f, p in zip(faces, points, strict=True)])
        # Four pixels beyond the seam, in maps that have so many.
        assert (uv >= min(0.124, 3.99 / n)).all()
        assert (uv <= 1 - min(0.124, 3.99 / n)).all()
    assert set(faces) == set(range(6))


def hilbert_signs():
    """Points on all edges and corners of a cube."""
    grid = np.array(np.meshgrid(*[[-1.0, 0.0, 1.0]] * 3)).reshape(3, -1).T
    return grid[np.abs(grid).max(axis=1) > 0]


def test_ties_of_a_cube_go_to_the_first_axis():
    light = Point((0, 0, 0))
    ties = [[1, 1, 1], [-1, 1, 1], [0, 2, -2], [0, -2, 2], [1, 0, -1], [0, 0, -1]]
    assert light.face(ties).tolist() == [0, 1, 2, 3, 0, 5]


def test_hilbert_is_a_walk_over_all_cells():
    for side in (1, 2, 4, 8, 16, 32):
        cells = hilbert(side)
        assert len(np.unique(cells, axis=0)) == side * side
        assert (np.abs(np.diff(cells, axis=0)).sum(axis=1) == 1).all()
        assert cells.min() == 0
        assert cells.max() == side - 1


@given(st.sampled_from([1, 4, 16, 64, 256]), st.booleans(), st.integers(0, 9))
def test_there_is_one_sample_in_each_cell(samples, jitter, seed):
    square = on_a_square(samples, jitter=jitter, seed=seed)
    side = int(samples**0.5)
    cells = np.floor((square + 1) / 2 * side)
    assert (cells == hilbert(side)).all()
    disc = on_a_disc(square)
    assert (np.linalg.norm(disc, axis=1) <= 1).all()
    np.testing.assert_array_equal(square, on_a_square(samples, jitter=jitter, seed=seed))


def test_a_disc_is_covered_evenly():
    disc = on_a_disc(on_a_square(4096))
    for radius in (0.25, 0.5, 0.75):
        share = (np.linalg.norm(disc, axis=1) < radius).mean()
        assert share == pytest.approx(radius**2, abs=0.01)


def rounded(told):
    """But for the last digits of angles, which files have in degrees."""
    return json.loads(json.dumps(told), parse_float=lambda text: round(float(text), 9))


@pytest.mark.parametrize("name", LIGHTS)
def test_files_keep_it(name):
    light = LIGHTS[name]
    told = json.loads(json.dumps(light.to_json(), allow_nan=False))
    back = light_from_json(told | {"later": 1})
    assert rounded(back.to_json()) == rounded(light.to_json())
    for a, b in zip(light.projections(scene(), 64), back.projections(scene(), 64), strict=True):
        np.testing.assert_allclose(a.matrix, b.matrix, atol=1e-9)
    assert type(back) is type(light)
    assert (back.images, back.is_stack) == (light.images, light.is_stack)


@pytest.mark.parametrize(
    "change", [None, {}, {"kind": 3}, {"kind": "moon"}, {"kind": "spot"}, {"kind": "area"}]
)
def test_what_is_no_light_is_told(change):
    with pytest.raises(FovealError, match="light"):
        light_from_json(change)


@pytest.mark.parametrize("name", LIGHTS)
@pytest.mark.parametrize("wrong", [None, "x", -1, [], {}, [1, 2], 1e999, True])
def test_any_damage_to_it_is_a_sentence_or_a_light(name, wrong):
    told = json.loads(json.dumps(LIGHTS[name].to_json()))
    for key in told:
        try:
            light = light_from_json(told | {key: wrong})
        except FovealError:
            continue
        assert light.to_json()


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Directional((0, 0, 0)), "has no length"),
        (lambda: Directional((0, math.nan, 1)), "three numbers"),
        (lambda: Directional((0, 1)), "three numbers"),
        (lambda: Directional("down"), "three numbers"),
        (lambda: Spot((1, 2, 3), (1, 2, 3), 1.0), "is where it stands"),
        (lambda: Spot((1, 2, 3), (0, 0, 0), 0.0), "above 0 and at most 170"),
        (lambda: Spot((1, 2, 3), (0, 0, 0), math.pi), "got 180"),
        (lambda: Spot((1, 2, 3), (0, 0, 0), math.nan), "angle of a cone"),
        (lambda: Point((0, 0, math.inf)), "three numbers"),
        (lambda: AreaLight(SPOT), "Say one"),
        (lambda: AreaLight(SPOT, radius=1, size=(1, 1)), "Say one"),
        (lambda: AreaLight(SPOT, radius=-1), "above 0"),
        (lambda: AreaLight(SPOT, size=(1, math.inf)), "above 0"),
        (lambda: AreaLight(SUN, radius=1.0), "at most 45 degrees"),
        (lambda: AreaLight(SPOT, radius=1, samples=60), "power of two"),
        (lambda: AreaLight(SPOT, radius=1, seed=-1), "seed"),
        (lambda: AreaLight(Point((0, 0, 0)), radius=1), "made of a spot light"),
        (lambda: checked_resolution(4000), "Take 4096"),
        (lambda: checked_resolution(0), "power of two"),
        (lambda: checked_resolution(1 << 21), "Take 1048576"),
        (lambda: SPOT.projections(scene(), 100), "power of two"),
        (lambda: AreaLight(SPOT, radius=1, samples=64).projections(scene(), 32), "stack of 64 images"),
        (lambda: DAY.projections(scene(), 8), "stack of 11 images"),
        (lambda: SPOT.projections([], 64), "shape"),
        (lambda: SPOT.projections(np.empty((0, 3)), 64), "nothing that the light could fall on"),
        (lambda: SUN.projections([[0, 0, math.nan]], 64), "no number"),
        (lambda: SPOT.projections([[1, 2, 9], [0, 0, 0]], 64), "at a vertex"),
        (lambda: Point((0, 0, 0)).projections([[0, 0, 0], [1, 1, 1]], 64), "at a vertex"),
        (
            lambda: Spot((0, 0, 5), (0, 0, 9), 1.0).projections(scene(), 64),
            "nothing lies in the light's cone",
        ),
        (
            lambda: Spot((0, 0, 50), (0, 40, 0), 0.1).projections(scene(), 64),
            "nothing lies in the light's cone",
        ),
    ],
)
def test_a_sentence_for_what_lights_nothing(make, sentence):
    with pytest.raises(ValueError, match=sentence):
        make()


@pytest.mark.parametrize("name", LIGHTS)
def test_scenes_without_extent_have_a_frame_too(name):
    for positions in ([[0.5, 0.5, 0.5]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 0, 1]]):
        for projection in LIGHTS[name].projections(positions, 64):
            assert np.isfinite(projection.matrix).all()
            assert np.abs(np.linalg.det(projection.matrix)) > 0


def test_unit_keeps_zero():
    np.testing.assert_array_equal(unit(np.array([[0.0, 0, 0], [0, 3, 4]])), [[0, 0, 0], [0, 0.6, 0.8]])
