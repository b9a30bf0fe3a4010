"""Trees that no shadow made: any masks that fit each other, any values."""

import numpy as np

from foveal.shadows.tree import FAR, INNER, LEAF, Tree

VALUES = np.array([0, 1, 5, 1 << 31, (1 << 31) - 1, FAR - 1, FAR, 0x3FFFFFFF, 0x12345678], np.uint32)


def random_tree(random, levels, children, most=200):
    """Nodes have children less often once there are `most` on a level."""
    root = INNER if levels and random.random() < 0.9 else LEAF
    masks, values, nodes = [], [1], int(root == INNER)
    for level in range(levels):
        chance = 0 if level == levels - 1 else 0.5 if nodes < most else 0.05
        kinds = random.random((nodes, children)) < 0.5
        kinds = kinds + 2 * (random.random((nodes, children)) < chance)
        blank = ~kinds.any(axis=1)
        kinds[blank, random.integers(0, children, int(blank.sum()))] = 1
        masks.append((kinds << 2 * np.arange(children)).sum(axis=1).astype(np.uint16))
        values.append(int((kinds & 1).sum()))
        nodes = int((kinds >> 1).sum())
    count = sum(values)
    chosen = np.where(
        random.random(count) < 0.7, random.choice(VALUES, count), random.integers(0, 1 << 32, count)
    )
    return Tree(
        levels=levels,
        children=children,
        root=root,
        masks=np.concatenate([np.zeros(0, np.uint16), *masks]),
        mask_starts=np.cumsum([0, *map(len, masks)]),
        values=chosen.astype(np.uint32),
        value_starts=np.cumsum([0, *values]),
    )


def assert_same(a, b):
    """The same numbers, in the same types."""
    assert (a.levels, a.children, a.root, a.spread) == (b.levels, b.children, b.root, b.spread)
    for name in ("masks", "mask_starts", "values", "value_starts"):
        found, wanted = getattr(a, name), getattr(b, name)
        assert found.dtype == wanted.dtype, name
        assert found.tolist() == wanted.tolist(), name
