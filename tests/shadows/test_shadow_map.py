"""What a shadow map says of points: that of its pixels, of their kernels, of its images."""

import itertools

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh
from foveal.shadows import AreaLight, Directional, Point, ShadowMap, Spot, build, intervals
from foveal.shadows.moving import Moving
from shadows.naive_lookup import lit_count, receiver, value_in

STEPS = 1 << 32


def slab(z=0.0, half=2.0, thickness=0.2):
    """A closed box, its top at z."""
    corners = np.array(list(itertools.product((-half, half), (-half, half), (z - thickness, z))))
    faces = [[0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3], [0, 4, 5], [0, 5, 1]]
    faces += [[2, 3, 7], [2, 7, 6], [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]]
    return TriMesh.of(corners, faces)


def ball(at, radius=0.5):
    mesh = icosphere(2)
    return TriMesh(mesh.positions * radius + at, mesh.faces)


SCENE = [slab(), ball((0.3, 0.2, 1.0)), ball((-0.8, 0.5, 0.7), 0.3)]
SUN, LAMP = Directional((0.3, 0.2, -1.0)), Spot((0.5, -0.4, 5.0), (0, 0, 0), np.radians(70))


@pytest.fixture(scope="module")
def sunlit():
    return build(SCENE, SUN, resolution=64)


def points_of(seed, count=400):
    random = np.random.default_rng(seed)
    points = random.uniform([-2.4, -2.4, -0.4], [2.4, 2.4, 1.8], (count, 3))
    normals = random.normal(size=(count, 3))
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_every_pixel_is_tested_as_by_the_uncompressed_map(sunlit):
    lower, upper = intervals(SCENE, SUN, resolution=64)
    matrix = sunlit.projections[0].matrix
    u, v, z = np.meshgrid(*[(np.arange(64) + 0.5) / 64] * 2, np.linspace(0.01, 0.99, 23), indexing="ij")
    there = np.stack([u, v, z], axis=-1).reshape(-1, 3)
    points = np.linalg.solve(matrix[:3, :3], (there - matrix[:3, 3]).T).T
    steps = np.floor(sunlit.projections[0].project(points)[:, 2] * STEPS)
    x, y = np.floor(there[:, 0] * 64).astype(int), np.floor(there[:, 1] * 64).astype(int)
    found = sunlit.lookup(points)
    assert found[steps <= lower[0, y, x]].all()
    assert not found[steps > upper[0, y, x]].any()


@pytest.mark.parametrize("footprint", [1, 3, 5, 9])
@pytest.mark.parametrize("light", [SUN, LAMP], ids=["sun", "lamp"])
@pytest.mark.parametrize("has_normals", [False, True])
def test_pcf_is_the_share_of_lit_pixels(footprint, light, has_normals):
    shadow = build(SCENE, light, resolution=64)
    points, normals = points_of(footprint, 150)
    found = shadow.pcf(points, footprint=footprint, normals=normals if has_normals else None)
    for k, point in enumerate(points):
        normal = normals[k] if has_normals else None
        place = receiver(shadow.projections[0].matrix, 6, point, normal, footprint // 2)
        if place is None:
            assert found[k] == 1
            continue
        x, y, step = place
        lit = lit_count(shadow.packed[0], x, y, 0, step, footprint // 2)
        assert found[k] == np.float32(lit / footprint**2)
    if footprint == 1:
        answers = shadow.lookup(points, normals=normals if has_normals else None)
        np.testing.assert_array_equal(answers, found > 0.5)


def test_filtered_blends_two_levels(sunlit):
    points, normals = points_of(3, 200)
    by_level = [sunlit._shares(points, normals, 0, radius=1, level=level) for level in range(6, -1, -1)]
    for footprint, expected in (
        (0.01, by_level[0]),
        (1, by_level[0]),
        (4, by_level[2]),
        (2**1.25, 0.75 * by_level[1] + 0.25 * by_level[2]),
        (1e9, by_level[6]),
        (np.nan, by_level[0]),
    ):
        found = sunlit.filtered(points, footprint_px=footprint, normals=normals)
        np.testing.assert_allclose(found, expected, atol=1e-6)
    each = np.random.default_rng(1).uniform(0.5, 100, len(points))
    found = sunlit.filtered(points, footprint_px=each, normals=normals)
    for k in range(0, len(points), 17):
        one = sunlit.filtered(points[k : k + 1], footprint_px=each[k], normals=normals[k : k + 1])
        assert found[k] == one[0]


def test_footprints_are_steps_in_pixels():
    random = np.random.default_rng(2)
    for light in (SUN, LAMP):
        shadow = build(SCENE, light, resolution=64)
        points, _ = points_of(4, 50)
        spans = random.normal(size=(50, 2, 3)) * 1e-5
        here = shadow.projections[0].project(points)[:, None, :2]
        there = shadow.projections[0].project((points[:, None] + spans).reshape(-1, 3))
        moved = (there[:, :2].reshape(50, 2, 2) - here) * 64
        expected = np.linalg.norm(moved, axis=2).max(axis=1)
        np.testing.assert_allclose(shadow.footprints(points, spans), expected, rtol=1e-3)


def test_a_point_light_asks_the_map_that_sees_the_point():
    light = Point((0.0, 0.0, 0.0))
    walls = [ball(4 * axis * sign, 0.5) for axis in np.eye(3) for sign in (-1, 1)]
    shadow = build(walls, light, resolution=64)
    directions = np.random.default_rng(6).normal(size=(400, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    reach = np.abs(directions).max(axis=1)
    sine = np.sqrt(1 - reach**2)
    found = shadow.lookup(5 * directions)
    clear = np.abs(sine - 0.5 / 4) > 0.04  # not beside a silhouette
    np.testing.assert_array_equal(found[clear], (sine > 0.5 / 4)[clear])
    seam = np.array([[1.0, 1.0, 0.3], [-1, 1, 1], [1, -1.0, -1.0], [1, 1 + 1e-9, 0]]) * 3
    assert (shadow.pcf(seam, footprint=5) == 1).all()


@pytest.fixture(scope="module")
def stack():
    return build(SCENE, AreaLight(LAMP, radius=0.8, samples=16), resolution=64)


def test_an_image_of_a_stack_is_a_map(stack):
    assert stack.is_stack
    assert stack.images == 16
    points, _ = points_of(7, 60)
    for image in (0, 5, 15):
        found = stack.lookup(points, image=image)
        for k, point in enumerate(points):
            x, y, step = receiver(stack.projections[image].matrix, 6, point)
            is_on_map = 0 <= x < 64 and 0 <= y < 64
            assert found[k] == (not is_on_map or step <= value_in(stack.packed[0], x, y, stack._place(image)))


def test_soft_is_the_mean_of_images(stack):
    points, normals = points_of(8)
    images = [stack.lookup(points, normals=normals, image=image) for image in range(16)]
    np.testing.assert_allclose(stack.soft(points, normals=normals), np.mean(images, axis=0), atol=1e-6)
    found = stack.soft(points, normals=normals, samples=4)
    np.testing.assert_allclose(found, np.mean(images[::4], axis=0), atol=1e-6)
    soft = stack.soft(points, normals=normals)
    assert ((soft > 0) & (soft < 1)).any()


def test_what_cannot_be_asked_is_said(sunlit, stack):
    points, normals = points_of(9, 5)
    with pytest.raises(FovealError, match="mix its images"):
        stack.filtered(points, footprint_px=3)
    with pytest.raises(ValueError, match="image must be from 0 to 15"):
        stack.lookup(points, image=16)
    with pytest.raises(ValueError, match="odd"):
        sunlit.pcf(points, footprint=4)
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        sunlit.lookup(points[0])
    with pytest.raises(ValueError, match="a normal for each"):
        sunlit.lookup(points, normals=normals[:3])
    with pytest.raises(ValueError, match="samples"):
        stack.soft(points, samples=0)
    with pytest.raises(ValueError, match="power of two"):
        sunlit.with_moving(SCENE[1], resolution=100)
    assert len(sunlit.lookup(np.empty((0, 3)))) == 0


@pytest.mark.parametrize("light", [SUN, LAMP], ids=["sun", "lamp"])
def test_what_moves_casts_and_is_cast_on(light):
    still = [slab(), slab(2.0, 0.6, 0.1)]
    shadow = build(still, light, resolution=512)
    below_roof = np.array([[0.3, 0.2, 0.6]])
    up = np.array([[0.0, 0.0, 1.0]])
    for place in ((1.3, 1.3, 0.5), (-1.3, 0.4, 0.6)):
        moved = shadow.with_moving(ball(place, 0.2), resolution=256)
        assert moved.packed is shadow.packed
        center = np.array(place)
        to_light = light.towards(center[None])[0]
        foot = center - to_light * (center[2] / to_light[2])
        on_floor, top = foot[None] * [1, 1, 0], (center + 0.21 * to_light)[None]
        assert shadow.lookup(on_floor, normals=up)[0]
        assert not moved.lookup(on_floor, normals=up)[0]  # it casts on what is static
        assert moved.lookup(top, normals=to_light[None])[0]
        assert moved.with_moving(None).lookup(on_floor, normals=up)[0]
    assert not shadow.with_moving(ball(below_roof[0], 0.1)).lookup(below_roof)[0]  # the roof casts on it


def test_depths_of_what_moves_are_those_of_rays():
    mesh = ball((0.2, 0.1, 0.5), 0.7)
    for projection in (build(SCENE, light, resolution=64).projections[0] for light in (SUN, LAMP)):
        depths = Moving.of(mesh, [projection], 32).depths[0]
        matrix = projection.matrix
        for y, x in itertools.product(range(1, 32, 3), repeat=2):
            u, v = (x + 0.5) / 32, (y + 0.5) / 32
            # The ray is where (row X - u row W) p = 0 and (row Y - v row W) p = 0.
            planes = np.array([matrix[0] - u * matrix[3], matrix[1] - v * matrix[3]])
            nearest = 1.0
            for a, b, c in mesh.positions[mesh.faces]:
                system = np.stack([planes[:, :3] @ p + planes[:, 3] for p in (a, b, c)], axis=1)
                weights = np.cross(system[0], system[1])
                if (weights >= 0).all() or (weights <= 0).all():
                    weights = weights / weights.sum()
                    nearest = min(nearest, matrix[2, :3] @ (weights @ [a, b, c]) + matrix[2, 3])
            assert abs(int(depths[y, x]) - min(nearest * STEPS, STEPS - 1)) <= 64


def test_a_map_is_itself_after_what_moves_has_gone(sunlit):
    assert sunlit.with_moving(SCENE[1]) == sunlit
    assert isinstance(sunlit, ShadowMap)
