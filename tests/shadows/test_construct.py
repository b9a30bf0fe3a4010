"""Trees of shadow maps: legal at every pixel, whatever they are made from, and as small as can be."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.base.tasks import threads
from foveal.shadows import Directional, Point, Spot, build, intervals
from foveal.shadows import _kernels_sets as sets
from foveal.shadows import _kernels_tiles as tiles
from foveal.shadows.casters import casters_of
from foveal.shadows.construct import pixels_of_triangles, tree_of_pixels, tree_of_triangles
from foveal.shadows.flat import PLACE_BITS, flatten
from foveal.shadows.stack import tree_of_stack
from foveal.shadows.topdown import tree_from_the_root

from . import naive_shadows as naive
from .scenes import ball, box, mixed, sheet, solids

SLANTING = Directional((0.4, 0.3, -0.8))
LIGHTS = {
    "slanting": SLANTING,
    "down": Directional((0, 0, -1)),
    "level": Directional((1, 0.1, -0.05)),
    "spot": Spot((5.0, -6.0, 7.0), (0.0, 0.0, 0.5), np.radians(50)),
    "spot within": Spot((-2.0, 0.0, 2.2), (2.0, 1.0, 0.5), np.radians(110)),
}


@pytest.fixture(scope="module")
def pool():
    with threads(2) as executor:
        yield executor


def same(one, other):
    return one.root == other.root and all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in ("masks", "mask_starts", "values", "value_starts")
    )


def size(tree):
    return len(tree.masks) + len(tree.values)


def illegal(tree, lower, upper):
    values = naive.decoded(tree)[: len(np.atleast_3d(lower))]
    return int(((values < lower) | (values > upper)).sum())


ends = st.integers(0, 30) | st.integers(0, naive.FAR)


@given(ends, ends)
def test_the_shortest_value(a, b):
    low, high = sorted((a, b))
    assert sets.shortest(low, high) == naive.shortest(low, high)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([(8, 8), (4, 4, 4), (3, 8, 8), (1, 1), (2, 2)]))
def test_a_tree_of_pixels_is_that_of_its_slow_twin(pool, seed, shape):
    rng = np.random.default_rng(seed)
    lower = rng.integers(0, 20, shape)
    upper = lower + rng.integers(0, 20, shape)
    tree = tree_of_pixels(lower, upper, executor=pool)
    assert same(tree, naive.tree_of_pixels(lower, upper))
    assert illegal(tree, lower, upper) == 0


def test_no_tree_keeps_fewer_values(pool):
    """Against the fewest by trying all of three depths at each node of a map of 4 x 4."""
    rng = np.random.default_rng(3)
    for _ in range(50):
        lower = rng.integers(0, 3, (4, 4))
        upper = np.minimum(2, lower + rng.integers(0, 2, (4, 4)))
        tree = tree_of_pixels(lower, upper, executor=pool)

        def fewest(x, y, side, above, lower=lower, upper=upper):
            costs = []
            for value in range(3):
                cost = int(value != above)
                if side == 1:
                    cost = cost if lower[y, x] <= value <= upper[y, x] else 99
                else:
                    half = side // 2
                    cost += sum(
                        fewest(x + i * half, y + j * half, half, value) for j in (0, 1) for i in (0, 1)
                    )
                costs.append(cost)
            return min(costs)

        assert len(tree.values) == fewest(0, 0, 4, -1)


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("is_strict", [False, True])
def test_pixels_are_what_their_rays_meet(pool, light, is_strict):
    casters = casters_of(mixed())
    levels = 3
    unit = 1 << (PLACE_BITS - levels)
    for projection in LIGHTS[light].projections(casters.positions, 1 << levels):
        flat = flatten(casters, projection)
        lower, upper = pixels_of_triangles(flat, levels, executor=pool, is_strict=is_strict)
        for y in range(1 << levels):
            for x in range(1 << levels):
                hits = naive.hits_at(flat, x * unit + unit // 2, y * unit + unit // 2)
                assert (lower[y, x], upper[y, x]) == naive.interval(hits, is_strict)


@pytest.mark.parametrize("scene", [solids, mixed])
@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("is_strict", [False, True])
def test_without_all_pixels_every_pixel_is_legal_and_nodes_are_as_few(pool, scene, light, is_strict):
    casters = casters_of(scene())
    levels = 8
    flat = flatten(casters, LIGHTS[light].projections(casters.positions, 1 << levels)[0])
    lower, upper = pixels_of_triangles(flat, levels, executor=pool, is_strict=is_strict)
    options = {"executor": pool, "is_strict": is_strict}
    all_pixels = tree_of_pixels(lower.astype(np.int64), upper.astype(np.int64), executor=pool)
    assert same(tree_of_triangles(flat, levels, is_sparse=False, **options), all_pixels)
    sparse = tree_of_triangles(flat, levels, **options)
    assert illegal(sparse, lower, upper) == 0
    assert size(sparse) <= 1.02 * size(all_pixels)
    greedy = tree_of_triangles(flat, levels, most=1, **options)
    assert illegal(greedy, lower, upper) == 0
    assert len(sparse.values) <= len(greedy.values)


def test_from_the_root_down(pool):
    lower, upper = (a[0] for a in intervals(mixed(), SLANTING, resolution=128, executor=pool))
    tree = tree_from_the_root(lower, upper)
    assert illegal(tree, lower, upper) == 0
    assert size(tree) >= size(tree_of_pixels(lower.astype(np.int64), upper.astype(np.int64), executor=pool))
    assert same(build(mixed(), SLANTING, resolution=128, method="top-down", executor=pool).trees[0], tree)


def test_the_tree_does_not_depend_on_threads_or_on_how_meshes_are_joined(pool):
    tree = build(mixed(), SLANTING, resolution=1024, executor=pool).trees[0]
    with threads(1) as single:
        assert same(build(mixed(), SLANTING, resolution=1024, executor=single).trees[0], tree)
    turned = list(reversed(mixed()))
    assert same(build(turned, SLANTING, resolution=1024, executor=pool).trees[0], tree)


def test_scratch_grows_where_much_lies_over_one_pixel(pool):
    """More triangles over one pixel than there is room for at first."""
    meshes = [ball((0, 0, 3 * i), 1, level=1) for i in range(300)]
    casters = casters_of(meshes)
    flat = flatten(casters, Directional((0, 0, -1)).projections(casters.positions, 8)[0])
    lower, upper = pixels_of_triangles(flat, 3, executor=pool)
    assert illegal(tree_of_triangles(flat, 3, executor=pool), lower, upper) == 0
    assert len(flat.corners) > tiles.BLOCK**2 * 64


def test_edges_and_corners_on_samples_are_counted_once(pool):
    """Boxes whose corners are at samples: every line enters as often as it leaves, so no pixel is open."""
    meshes = [box((i, j, 0), (i + 1, j + 1, 1 + (i + j) % 3)) for i in range(7) for j in range(7)]
    casters = casters_of(meshes)
    assert casters.is_closed.all()
    flat = flatten(casters, Directional((0, 0, -1)).projections(casters.positions, 8)[0])
    grid = flat._replace(corners=np.ascontiguousarray(np.rint(flat.corners / 2**26).astype(np.int32)) << 26)
    unit = 1 << 27
    for y in range(8):
        for x in range(8):
            hits = naive.hits_at(grid, x * unit + unit // 2, y * unit + unit // 2)
            sides = [side for _, side in hits]
            assert sides.count(0) == sides.count(2)


def test_coordinates_far_from_the_origin(pool):
    """UTM: what is legal near the origin is so there, but for the coordinates' own rounding."""
    scene = solids()[:3]  # where solids touch, rounding says whether a ray leaves the one before the other
    far = np.array([4.0e5, 5.4e6, 30.0])
    near_lower, near_upper = intervals(scene, SLANTING, resolution=64, executor=pool)
    moved = [type(m)(m.positions + far, m.faces) for m in scene]
    tree = build(moved, SLANTING, resolution=64, executor=pool).trees[0]
    values = naive.decoded(tree)
    slack = 64  # steps of 2^-32 of the depth
    assert (values >= near_lower.astype(np.int64) - slack).all()
    assert (values <= near_upper.astype(np.int64) + slack).all()


def test_a_stack_is_legal_in_every_image(pool):
    casters = casters_of(mixed())
    directions = [(0.4 + 0.02 * i, 0.3, -0.8) for i in range(5)]
    flats = [flatten(casters, Directional(d).projections(casters.positions, 32)[0]) for d in directions]
    tree = tree_of_stack([lambda flat=flat: flat for flat in flats], 5, executor=pool)
    assert tree.children == 8
    bounds = [pixels_of_triangles(flat, 5, executor=pool) for flat in flats]
    lower, upper = (np.stack(b) for b in zip(*bounds, strict=True))
    assert illegal(tree, lower, upper) == 0
    pixels = tree_of_pixels(lower.astype(np.int64), upper.astype(np.int64), executor=pool)
    assert size(tree) <= 1.1 * size(pixels)
    separate = [tree_of_triangles(flat, 5, executor=pool) for flat in flats]
    assert size(tree) < sum(map(size, separate))


def test_a_point_light_has_six_trees(pool):
    point = Point((0.3, -2.0, 2.6))
    shadow = build(mixed(), point, resolution=64, executor=pool)
    lower, upper = intervals(mixed(), point, resolution=64, executor=pool)
    assert len(shadow.trees) == 6
    for tree, low, high in zip(shadow.trees, lower, upper, strict=True):
        assert illegal(tree, low, high) == 0


def test_below_one_sheet_there_is_no_light(pool):
    """A table below a roof, and a ceiling's underside below it: a count of sides would light the table."""
    table = box((-1, -1, 0), (1, 1, 1))
    scene = [table, sheet((-2, -2), (2, 2), 3.0), sheet((-2, -2), (2, 2), -1.0, is_turned=True)]
    shadow = build(scene, Directional((0.1, 0.1, -1)), resolution=64, executor=pool)
    assert not shadow.lookup([[0, 0, 1.001], [0.5, 0.5, 1.001], [1.3, 1.3, -0.9]]).any()
    assert shadow.lookup([[0, 0, 3.001], [0, 0, 3.5]]).all()
    strict = build(scene, Directional((0.1, 0.1, -1)), resolution=64, exits="strict", executor=pool)
    assert not strict.lookup([[0, 0, 2.99], [0, 0, 1.5]]).any()


def test_a_part_inside_out_is_no_solid(pool):
    """Its first side is a back; it casts as a sheet does."""
    inside_out = ball((0, 0, 1))
    inside_out = type(inside_out)(inside_out.positions, np.ascontiguousarray(inside_out.faces[:, ::-1]))
    scene = [inside_out, sheet((-2, -2), (2, 2), -1.0)]
    shadow = build(scene, Directional((0, 0, -1)), resolution=64, executor=pool)
    assert shadow.lookup([[0, 0, 2.01], [0, 0, -0.99], [1.8, 1.8, -0.99]]).tolist() == [True, False, True]


def test_images_that_differ_much_are_set_apart(pool):
    """The sun of a day: as a cube of neighbours the stack would take more than its images one by one."""
    directions = [(1.5 - 0.4 * i, 0.3, -0.8) for i in range(8)]
    casters = casters_of(solids())
    flats = [flatten(casters, Directional(d).projections(casters.positions, 64)[0]) for d in directions]
    tree = tree_of_stack([lambda flat=flat: flat for flat in flats], 6, executor=pool)
    assert tree.spread > 0
    separate = [tree_of_triangles(flat, 6, executor=pool) for flat in flats]
    assert size(tree) < 1.1 * sum(map(size, separate))
    values = naive.decoded(tree)[:: 1 << tree.spread]
    for image, flat in zip(values, flats, strict=False):
        lower, upper = pixels_of_triangles(flat, 6, executor=pool)
        assert ((lower <= image) & (image <= upper)).all()
