"""No surface shades itself, at any angle and any level; nothing floats."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.mesh.trimesh import TriMesh
from foveal.shadows import Projection, ShadowMap
from foveal.shadows.bias import receivers, window_of
from foveal.shadows.moving import Moving
from shadows.golden_lookup import turned
from shadows.naive_lookup import receiver
from shadows.naive_shadows import tree_of_pixels

EXTENT = 4.0
EMPTY_SHADOW = tree_of_pixels(np.full((2, 2), 2**32 - 1), np.full((2, 2), 2**32 - 1))


def parallel(direction, *, stretch=1.0, extent=EXTENT):
    matrix = np.eye(4)
    matrix[:3, :3] = turned(direction) / extent
    matrix[0, :3] *= stretch
    matrix[:3, 3] = 0.5
    return Projection(matrix)


def spot(direction, *, distance=3.0, angle=1.2):
    rows = turned(direction)
    place = -distance * rows[2]
    matrix = np.zeros((4, 4))
    matrix[3, :3], matrix[3, 3] = rows[2], -rows[2] @ place
    for k in (0, 1):
        matrix[k, :3] = rows[k] / (2 * np.tan(angle / 2))
        matrix[k, 3] = -matrix[k, :3] @ place
        matrix[k] += 0.5 * matrix[3]
    matrix[2] = matrix[3] / (2 * distance)
    return Projection(matrix)


def square(normal):
    """The corners of a square of side 2 around the origin."""
    rows = turned(normal)
    return np.array([x * rows[0] + y * rows[1] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


angles = st.floats(0, 2 * np.pi)
slants = st.one_of(st.floats(0, 1.5), st.floats(1e-9, 0.1).map(lambda x: np.pi / 2 - x))


@given(
    light=st.tuples(angles, st.floats(-1, 1)),
    slant=slants,
    turn=angles,
    radius=st.integers(0, 3),
    levels=st.integers(3, 9),
    kind=st.sampled_from(["parallel", "stretched", "spot"]),
)
@settings(max_examples=150, deadline=None)
def test_a_plane_does_not_shade_itself_at_any_angle(light, slant, turn, radius, levels, kind):
    azimuth, height = light
    across = np.sqrt(1 - height**2)
    rows = turned((across * np.cos(azimuth), across * np.sin(azimuth), height))
    projection = {
        "parallel": parallel,
        "stretched": lambda d: parallel(d, stretch=0.37),
        "spot": spot,
    }[kind](rows[2])
    normal = np.sin(slant) * (np.cos(turn) * rows[0] + np.sin(turn) * rows[1]) - np.cos(slant) * rows[2]
    corners = square(normal)
    random = np.random.default_rng(levels)
    weights = random.dirichlet([1, 1, 1], 400)
    points = np.concatenate([weights @ corners[[0, 1, 2]], weights @ corners[[0, 2, 3]]])
    moving = Moving.of(TriMesh.of(corners, [[0, 1, 2], [0, 2, 3]]), [projection], 1 << levels)
    shares = np.ones(len(points), np.float32)
    if kind == "spot":  # that is the page's proof: of points that the light sees from the front
        to_light = -3 * rows[2] - points
        seen = to_light @ normal > 0
        points, shares = points[seen], shares[seen]
    moving.darken(0, points, np.broadcast_to(normal, points.shape).copy(), radius, shares)
    assert (shares == 1).all()


@pytest.mark.parametrize("slant", [0.3, 1.0, 1.4, 1.55])
@pytest.mark.parametrize("thickness", [0.0, 0.02])
def test_a_plane_does_not_shade_itself_at_coarser_levels(slant, thickness):
    side = 32
    projection = parallel((0, 0, -1), extent=2.0)
    normal = np.array([np.sin(slant), 0, np.cos(slant)])
    x = (np.arange(side) + 0.5) / side * 2 - 1
    z = np.broadcast_to(x * normal[0] / normal[2], (side, side))
    turned_rows = projection.matrix[0, :3]
    assert abs(turned_rows[0]) == 0.5  # u grows along x, or against it
    depths = 0.5 + np.sign(turned_rows[0]) * z / 2
    lower = np.floor(depths * 2.0**32).clip(0, 2**32 - 2).astype(np.int64)
    tree = tree_of_pixels(lower, (lower + int(thickness * 2**32)).clip(0, 2**32 - 2))
    shadow = ShadowMap(None, (projection,), (tree,))
    points = np.random.default_rng(3).uniform(-0.9, 0.9, (500, 3))
    points[:, 2] = -points[:, 0] * normal[0] / normal[2]
    inside = np.abs(points[:, 2]) < 0.9
    points = points[inside]
    normals = np.broadcast_to(normal, points.shape)
    for level in range(tree.levels + 1):
        found = shadow._shares(points, normals, 0, radius=1, level=level)
        assert (found[inside_of_map(shadow, points, normals, level)] == 1).all()


def inside_of_map(shadow, points, normals, level):
    """Whose depth, where they are looked up, is on the map's range: beyond it steps are clamped."""
    steps = receivers(shadow.windows[0], points, normals=normals, radius=1, level=level)[:, 2]
    return (steps > 0) & (steps < 2**32 - 1)


def test_a_receiver_moves_at_most_a_texel_or_two():
    rng = np.random.default_rng(1)
    projection, levels = parallel((0.3, -0.4, -0.8)), 8
    window, texel = window_of(projection, levels), EXTENT / (1 << levels)
    normals = rng.normal(size=(500, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    sines = np.linalg.norm(np.cross(normals, turned((0.3, -0.4, -0.8))[2]), axis=1)
    from foveal.shadows import _kernels_lookup_points as kernels

    for radius in range(4):
        half = (radius + 0.5 + 1 / 16) / (1 << levels)
        shifts = [kernels.shift_of(window, np.zeros(3), normal, half) for normal in normals]
        bound = (radius + 0.5 + 1 / 16) * np.sqrt(2) * texel * sines
        assert (shifts <= bound * (1 + 1e-12)).all()
        assert (shifts >= bound / np.sqrt(2) * (1 - 1e-12)).all()


def test_the_shadow_of_a_box_begins_at_its_foot():
    """On a floor, beside a box, away from the light: dark but for what the bias is."""
    levels, direction = 9, np.array([1.0, 0, -0.7])
    projection, texel = parallel(direction), EXTENT / (1 << 9)
    box = [[x, y, z] for z in (0, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.0)]
    faces = [[4, 5, 7], [4, 7, 6], [1, 3, 7], [1, 7, 5], [0, 4, 6], [0, 6, 2], [0, 1, 5], [0, 5, 4]]
    faces += [[2, 6, 7], [2, 7, 3]]
    floor = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
    mesh = TriMesh.of(box + floor, [*faces, [8, 9, 10], [8, 10, 11]])
    moving = Moving.of(mesh, [projection], 1 << levels)
    for radius in range(3):
        shift = (radius + 0.5 + 1 / 16) * np.sqrt(2) * texel
        length = 0.5 / 0.7
        for gap, expected in ((2 * shift + texel * (radius + 1), 0.0), (length + 2 * shift + texel * 4, 1.0)):
            y = np.linspace(-0.3, 0.3, 101)
            points = np.stack([np.full_like(y, gap), y, np.zeros_like(y)], axis=1)
            shares = np.ones(len(points), np.float32)
            moving.darken(0, points, np.broadcast_to([0.0, 0, 1], points.shape).copy(), radius, shares)
            assert (shares == expected).all()


def test_receivers_are_those_of_the_slow_twin():
    rng = np.random.default_rng(8)
    for projection in (parallel((0.1, 0.2, -1)), spot((0.5, 0.5, -1))):
        window, points = window_of(projection, 12), rng.uniform(-3.5, 3.5, (200, 3))
        normals = rng.normal(size=(200, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        for level, given_normals in ((12, normals), (7, normals), (12, None)):
            found = receivers(window, points, normals=given_normals, radius=2, level=level)
            for k, (point, row) in enumerate(zip(points, found.tolist(), strict=True)):
                normal = None if given_normals is None else given_normals[k]
                expected = receiver(projection.matrix, 12, point, normal, 2, level)
                if expected is None:
                    assert row == [-(1 << 30), -(1 << 30), 0]
                else:
                    np.testing.assert_allclose(row, expected, atol=1, rtol=0)
