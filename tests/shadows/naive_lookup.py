"""Slow twins of lookups: words read one by one as spec/shadows.md says, kernels sample by sample."""

import numpy as np

from foveal.shadows.tree import EMPTY, INNER, LEAF, NONE, Tree

STEPS = 1 << 32


def value_in(packed, x, y, z=0, level=None):
    """The value of a pixel of the map that the tree is down to `level`."""
    level = packed.levels if level is None else level
    words = packed.words
    kind, address, value = packed.root, 0, None
    for depth in range(level + 1):
        if kind == LEAF:
            return int(words[address])
        if kind == NONE:
            return value
        if kind == INNER:
            value = int(words[address + 1])
        if depth == level:
            return value
        bit = level - 1 - depth
        child = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2
        mask, pointer = int(words[address]) & 0xFFFF, int(words[address]) >> 16
        kind = mask >> 2 * child & 3
        address += pointer * int(packed.scales[depth]) + (mask & ((1 << 2 * child) - 1)).bit_count()
    raise AssertionError(kind)


def lit_count(packed, x, y, z, step, radius, level=None):
    """How many of the pixels around one are lit; those off the map are."""
    level = packed.levels if level is None else level
    side = range(1 << level)
    return sum(
        i not in side or j not in side or step <= value_in(packed, i, j, z, level)
        for j in range(y - radius, y + radius + 1)
        for i in range(x - radius, x + radius + 1)
    )


def cut(tree, level):
    """The tree down to a level: inner nodes there are leaves, empty ones nothing."""
    masks = [tree.masks[a:b].copy() for a, b in zip(tree.mask_starts, tree.mask_starts[1:], strict=False)]
    values = [tree.values[a:b] for a, b in zip(tree.value_starts, tree.value_starts[1:], strict=False)]
    if level == 0:
        return Tree(0, tree.children, LEAF, tree.masks[:0], np.array([0]), values[0], np.array([0, 1]))
    becomes = {NONE: NONE, LEAF: LEAF, EMPTY: NONE, INNER: LEAF}
    masks = masks[:level]
    masks[-1] = np.array(
        [sum(becomes[int(m) >> 2 * i & 3] << 2 * i for i in range(tree.children)) for m in masks[-1]],
        np.uint16,
    )
    values = values[: level + 1]
    return Tree(
        *(level, tree.children, tree.root),
        *(np.concatenate(masks), np.cumsum([0, *map(len, masks)])),
        *(np.concatenate(values), np.cumsum([0, *map(len, values)])),
    )


def receiver(matrix, levels, point, normal=None, radius=0, level=None):
    """x, y, step of a point, by the page's "Bias"; None behind the light."""
    matrix, point = np.asarray(matrix, float), np.asarray(point, float)
    level = levels if level is None else level
    bias = 0
    if normal is not None:
        normal = np.asarray(normal, float)
        is_parallel = list(matrix[3]) == [0, 0, 0, 1]
        inverse = np.linalg.inv(matrix[[0, 1, 2 if is_parallel else 3], :3])
        half = (radius + (0.5 if level == levels else 1.0) + 1 / 16) / (1 << level)
        slope = half * (abs(normal @ inverse[:, 0]) + abs(normal @ inverse[:, 1]))
        w = matrix[3, :3] @ point + matrix[3, 3]
        point = point + w * slope / max(1 - slope * (normal @ matrix[3, :3]), 0.5) * normal
        bias = 2048
    u, v, depth, w = matrix[:, :3] @ point + matrix[:, 3]
    if not w > 0:
        return None
    step = min(max(int(np.floor(depth * STEPS)) - bias, 0), STEPS - 1)
    return int(np.floor(u / w * (1 << level))), int(np.floor(v / w * (1 << level))), step
