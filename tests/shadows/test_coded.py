"""The coded tree: lossless for every tree, coarser by any prefix of its chunks, safe on any bytes."""

from itertools import chain

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.shadows.coded import Counts, coarser, decode, encode, parts_of
from foveal.shadows.tree import EMPTY, FAR, INNER, LEAF, Tree
from shadows import naive_coded
from shadows.naive_shadows import tree_of_pixels, value_at
from shadows.random_trees import assert_same, random_tree

seeds = st.integers(0, 2**32 - 1)


def scene(side, images=None):
    """Intervals of spheres over a slanting floor that does not reach everywhere, at 32 bits."""
    random = np.random.default_rng(7)
    y, x = (np.mgrid[:side, :side] + 0.5) / side
    maps = []
    for image in range(images or 1):
        near = np.where(x + y < 1.7, 0.8 + 0.1 * x, 1.0)
        far = np.where(near < 1, near + 0.01, 1.0)
        for _ in range(5):
            (u, v), radius = random.random(2), 0.05 + 0.15 * random.random()
            under = radius**2 - (x - u - 0.02 * image) ** 2 - (y - v) ** 2
            depth = np.sqrt(np.maximum(under, 0))
            is_hit = (under > 0) & (0.5 - depth < near)
            near = np.where(is_hit, 0.5 - depth, near)
            far = np.where(is_hit, 0.5 + depth, far)
        random = np.random.default_rng(7)
        lower = np.where(near < 1, near * 2**32, FAR).astype(np.int64)
        upper = np.maximum(np.where(near < 1, far * 2**32 - 1, FAR).astype(np.int64), lower)
        maps.append((lower, upper))
    lower, upper = (np.stack([pair[k] for pair in maps]) for k in range(2))
    return (lower, upper) if images else (lower[0], upper[0])


@pytest.fixture(scope="module")
def shadow():
    return tree_of_pixels(*scene(64))


@settings(deadline=None)
@given(seeds, st.integers(0, 6), st.sampled_from([4, 8]), st.data())
def test_any_tree_comes_back_whatever_its_parts(seed, levels, children, data):
    tree = random_tree(np.random.default_rng(seed), levels, children)
    ends = data.draw(st.sets(st.integers(0, levels)))
    parts = sorted(ends | {levels})
    chunks = encode(tree, parts)
    assert len(chunks) == len(parts)
    assert_same(decode(Counts.of(tree), parts, chunks), tree)


@settings(deadline=None, max_examples=30)
@given(seeds, st.integers(0, 5), st.sampled_from([4, 8]))
def test_the_bytes_are_those_of_the_spec(seed, levels, children):
    tree = random_tree(np.random.default_rng(seed), levels, children, most=30)
    parts = sorted({levels // 2, levels})
    masks, values = naive_coded.decode(levels, children, tree.root, parts, encode(tree, parts))
    assert list(chain(*masks)) == tree.masks.tolist()
    assert list(chain(*values)) == tree.values.tolist()


def test_the_bytes_of_real_trees_are_those_of_the_spec(shadow):
    for tree in (shadow, tree_of_pixels(*scene(16, images=13))):
        parts = [3, tree.levels]
        masks, values = naive_coded.decode(tree.levels, tree.children, tree.root, parts, encode(tree, parts))
        assert list(chain(*masks)) == tree.masks.tolist()
        assert list(chain(*values)) == tree.values.tolist()


@settings(deadline=None)
@given(seeds, st.integers(1, 5), st.sampled_from([4, 8]))
def test_a_prefix_of_the_chunks_is_the_map_so_far(seed, levels, children):
    tree = random_tree(np.random.default_rng(seed), levels, children, most=30)
    parts = list(range(levels + 1))
    chunks = encode(tree, parts)
    for level in parts:
        found = decode(Counts.of(tree), parts, chunks[: level + 1])
        assert found.levels == level
        assert (found.masks > 0).all()
        if level == levels:
            assert_same(found, tree)
            continue
        assert found.values.tolist() == tree.values[: tree.value_starts[level + 1]].tolist()
        random = np.random.default_rng(1)
        for x, y, z in random.integers(0, 1 << level, (20, 3)):
            assert value_at(found, x, y, z) == value_so_far(tree, level, x, y, z)


def value_so_far(tree, level, x, y, z):
    """The last value down to a level, by hiding what is below it from the slow twin."""
    deep = tree.levels - level
    hidden = Tree(
        levels=tree.levels,
        children=tree.children,
        root=tree.root,
        masks=np.concatenate(
            [
                tree.masks[: tree.mask_starts[level]],
                np.zeros(len(tree.masks) - tree.mask_starts[level], np.uint16),
            ]
        ),
        mask_starts=tree.mask_starts,
        values=tree.values,
        value_starts=tree.value_starts,
    )
    return value_at(hidden, int(x) << deep, int(y) << deep, int(z) << deep)


def test_what_is_cut_off_goes_upwards_too():
    """An empty node whose one child is empty is a mask 0 once that is cut, and then is nothing at all."""
    tree = Tree(
        levels=3,
        children=4,
        root=INNER,
        masks=np.array([EMPTY, EMPTY << 6, LEAF | LEAF << 2], np.uint16),
        mask_starts=np.array([0, 1, 2, 3]),
        values=np.array([9, 7, 8], np.uint32),
        value_starts=np.array([0, 1, 1, 1, 3]),
    )
    chunks = encode(tree, [0, 1, 2, 3])
    for level in range(3):
        found = decode(Counts.of(tree), [0, 1, 2, 3], chunks[: level + 1])
        assert (found.root, found.masks.tolist(), found.values.tolist()) == (LEAF, [], [9])
    assert_same(decode(Counts.of(tree), [0, 1, 2, 3], chunks), tree)


def test_a_real_map_comes_back_and_is_small(shadow):
    parts = parts_of([shadow])
    chunks = encode(shadow, parts)
    assert_same(decode(Counts.of(shadow), parts, chunks), shadow)
    in_memory = 4 * (len(shadow.masks) + len(shadow.values))
    assert sum(map(len, chunks)) < 0.4 * in_memory  # 0.28: what is learnt on a small map is little


def test_a_real_stack_comes_back_and_is_small():
    tree = tree_of_pixels(*scene(16, images=13))
    parts = parts_of([tree])
    chunks = encode(tree, parts)
    assert_same(decode(Counts.of(tree), parts, chunks), tree)
    assert sum(map(len, chunks)) < 0.5 * 4 * (len(tree.masks) + len(tree.values))


def test_parts_join_small_levels_only():
    def tree(*masks):
        starts = np.cumsum([0, *masks])
        return Tree(
            len(masks), 4, INNER, np.zeros(starts[-1], np.uint16), starts, np.zeros(0, np.uint32), starts
        )

    assert parts_of([tree(1, 4, 4000, 9000, 1)]) == [3, 4, 5]
    assert parts_of([tree(1, 4, 4091)]) == [3]
    assert parts_of([tree(1, 4, 2000), tree(1, 4, 2087)]) == [2, 3]


def test_every_byte_flipped_and_every_prefix_is_refused_or_a_tree(shadow):
    parts = [3, 6]
    counts, chunks = Counts.of(shadow), encode(shadow, parts)
    for number, chunk in enumerate(chunks):
        for end in range(0, len(chunk), 1 if number == 0 else 5):
            with pytest.raises(FovealError, match="damaged"):
                decode(counts, parts, [*chunks[:number], chunk[:end], *chunks[number + 1 :]])
        for at in range(0, len(chunk), 1 if number == 0 else 5):
            flipped = bytearray(chunk)
            flipped[at] ^= 1 << at % 8
            try:
                found = decode(counts, parts, [*chunks[:number], bytes(flipped), *chunks[number + 1 :]])
            except FovealError:
                continue
            assert_same(decode(Counts.of(found), parts, encode(found, parts)), found)


@settings(deadline=None, max_examples=200)
@given(st.binary(max_size=60), st.lists(st.integers(0, 40), min_size=7, max_size=7), st.sampled_from([4, 8]))
def test_no_bytes_do_harm(data, numbers, children):
    masks, values = np.array([1, *numbers[:2]]), np.array([1, *numbers[2:5]])
    counts = Counts(3, children, INNER, masks, values)
    with pytest.raises(FovealError, match="damaged"):
        decode(counts, [3], [data])


@pytest.mark.parametrize(
    ("masks", "values"),
    [
        ([0, 0], [1, 0, 0]),  # an inner root has a mask
        ([1, 5], [1, 0, 9]),  # more nodes than places
        ([1, 4], [1, 5, 9]),
        ([1, 1 << 40], [1, 0, 0]),
        ([1, 1], [2, 0, 1]),
        ([1, 1, 1], [1, 0, 0]),
        ([1, -1], [1, 0, 0]),
    ],
)
def test_counts_that_no_tree_has_are_refused(masks, values):
    with pytest.raises(FovealError, match="damaged"):
        decode(Counts(2, 4, INNER, np.array(masks), np.array(values)), [2], [b"\0" * 100])


def test_counts_ask_for_no_more_memory_than_bytes_can_fill():
    masks = 4 ** np.arange(20)
    counts = Counts(20, 4, INNER, masks, np.array([1, *masks * 3]))
    with pytest.raises(FovealError, match="damaged"):
        decode(counts, [20], [bytes(range(250))])


@pytest.mark.parametrize(
    "change",
    [
        {"masks": np.array([0, 1], np.uint16)},
        {"masks": np.array([EMPTY, 0], np.uint16)},
        {"masks": np.array([LEAF, LEAF], np.uint16)},
        {"values": np.array([5], np.uint32), "value_starts": np.array([0, 1, 1, 1])},
        {"values": np.array([5, 6, 7], np.uint32), "value_starts": np.array([0, 1, 1, 3])},
        {"root": LEAF},
        {"levels": 25},
    ],
)
def test_what_is_no_tree_is_not_written(change):
    good = {
        "levels": 2,
        "children": 4,
        "root": INNER,
        "masks": np.array([EMPTY, LEAF], np.uint16),
        "mask_starts": np.array([0, 1, 2]),
        "values": np.array([5, 6], np.uint32),
        "value_starts": np.array([0, 1, 1, 2]),
    }
    encode(Tree(**good), [2])
    with pytest.raises(ValueError):
        encode(Tree(**{**good, **change}), [2])


def test_coarser_keeps_what_is_whole():
    tree = random_tree(np.random.default_rng(3), 4, 4)
    assert_same(coarser(tree), tree)
