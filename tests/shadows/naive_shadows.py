"""Slow twins of the shadow trees: pixels one by one, sets of values as plain lists."""

import itertools

import numpy as np

from foveal.shadows.tree import EMPTY, FAR, INNER, LEAF, NONE, Tree


def best_set(sets):
    """The values that lie in the most of some sets (lists of inclusive intervals), as such a list."""
    ends = sorted({low for s in sets for low, _ in s} | {high + 1 for s in sets for _, high in s})
    segments = [
        (sum(any(low <= begin and end - 1 <= high for low, high in s) for s in sets), begin, end - 1)
        for begin, end in itertools.pairwise(ends)
    ]
    most = max(count for count, _, _ in segments)
    merged = []
    for count, low, high in segments:
        if count == most:
            if merged and merged[-1][1] == low - 1:
                merged[-1] = (merged[-1][0], high)
            else:
                merged.append((low, high))
    return merged, most == len(sets)


def shortest(low, high):
    """The value v with low <= v <= high whose v + 1 has the fewest bits after the point of (v + 1) / 2^32."""
    for bits in range(33):
        unit = 1 << (32 - bits)
        k = -(-(low + 1) // unit)
        if k * unit <= high + 1:
            return bits, k * unit - 1
    raise AssertionError((low, high))


def tree_of_pixels(lower, upper):
    """The optimal tree of (side, side) or (images, side, side) intervals, both ends legal values.

    Images past the last of a stack may be anything.
    """
    lower, upper = np.asarray(lower), np.asarray(upper)
    side = lower.shape[-1]
    levels = side.bit_length() - 1
    is_stack = lower.ndim == 3
    children = 8 if is_stack else 4

    def up(level, x, y, z):
        if level == levels:
            if is_stack and z >= len(lower):
                return ([(0, FAR)], None)
            at = (z, y, x) if is_stack else (y, x)
            return ([(int(lower[at]), int(upper[at]))], None)
        kids = [
            up(level + 1, 2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2)) for i in range(children)
        ]
        values, is_common = best_set([kid[0] for kid in kids])
        return (values, None if is_common and all(kid[1] is None for kid in kids) else kids)

    masks = [[] for _ in range(levels + 1)]
    values = [[] for _ in range(levels + 1)]

    def down(node, level, inherited):
        """Kind of the node, given the value from above."""
        options, kids = node
        stays = inherited is not None and any(low <= inherited <= high for low, high in options)
        if not stays:
            inherited = min(shortest(low, high) for low, high in options)[1]
            values[level].append(inherited)
        if kids is None:
            return NONE if stays else LEAF
        place = len(masks[level])
        masks[level].append(0)
        for i, kid in enumerate(kids):
            masks[level][place] |= down(kid, level + 1, inherited) << (2 * i)
        return EMPTY if stays else INNER

    root = down(up(0, 0, 0, 0), 0, None)
    counts = [len(m) for m in masks]
    assert counts.pop() == 0
    return Tree(
        levels=levels,
        children=children,
        root=root,
        masks=np.array([m for level in masks for m in level], np.uint16),
        mask_starts=np.cumsum([0, *counts]),
        values=np.array([v for level in values for v in level], np.uint32),
        value_starts=np.cumsum([0, *map(len, values)]),
    )


def value_at(tree, x, y, z=0):
    """The value of a pixel, straight from the lists of a tree."""
    at = {LEAF: (0, 0), INNER: (0, 0)}[tree.root]  # numbers of the node's mask and value within its level
    kind, value = tree.root, None
    for level in range(tree.levels + 1):
        if kind in (LEAF, INNER):
            value = int(tree.values[tree.value_starts[level] + at[1]])
        if kind in (NONE, LEAF):
            return value
        bit = tree.levels - 1 - level
        child = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2
        start = tree.mask_starts[level]
        mask_number = value_number = 0
        for place in range(at[0] + 1):
            mask = int(tree.masks[start + place])
            for i in range(tree.children if place < at[0] else child):
                value_number += mask >> 2 * i & 3 in (LEAF, INNER)
                mask_number += mask >> 2 * i & 3 in (EMPTY, INNER)
        kind, at = mask >> 2 * child & 3, (mask_number, value_number)
    return value


def decoded(tree):
    """(images, side, side) int64: the value of every pixel; one image of a quadtree."""
    side = 1 << tree.levels
    is_stack = tree.children == 8
    out = np.empty((side if is_stack else 1, side, side), np.int64)
    nodes = [(0, 0, 0, tree.root)]
    for level in range(tree.levels + 1):
        size = 1 << (tree.levels - level)
        values = iter(tree.values[tree.value_starts[level] : tree.value_starts[level + 1]].tolist())
        begin, end = tree.mask_starts[min(level, tree.levels) : level + 2] if level < tree.levels else (0, 0)
        masks = iter(tree.masks[begin:end].tolist())
        below = []
        for x, y, z, kind in nodes:
            if kind in (LEAF, INNER):
                images = slice(z * size, (z + 1) * size) if is_stack else slice(None)
                out[images, y * size : (y + 1) * size, x * size : (x + 1) * size] = next(values)
            if kind in (EMPTY, INNER):
                mask = next(masks)
                assert mask
                below += [
                    (2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2), mask >> 2 * i & 3)
                    for i in range(tree.children)
                    if mask >> 2 * i & 3 != NONE
                ]
        assert next(values, None) is None
        assert next(masks, None) is None
        nodes = below
    assert not nodes
    return out


def interval(hits, is_strict=False):
    """Lowest and highest legal value where a ray meets these (depth, side), 0 front, 1 sheet, 2 back."""
    hits = sorted(hits)
    if not hits:
        return FAR, FAR
    first, side = hits[0]
    inside = 0
    for depth, kind in hits if side == 0 else []:
        inside += {0: 1, 1: 0, 2: -1}[kind]
        if inside == 0 and kind == 2:
            return first, max(first, depth - 1)
    if is_strict:
        return first, first
    return first, min((depth for depth, _ in hits if depth > first), default=FAR + 1) - 1


def hits_at(flat, x, y):
    """What the ray at a place in whole numbers meets: (depth, side)."""
    hits = []
    for t in range(len(flat.corners)):
        corners = [tuple(map(int, flat.corners[t, 2 * k : 2 * k + 2])) for k in range(3)]
        is_in = True
        for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
            e = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            is_in &= e > 0 or (e == 0 and (by < ay or (by == ay and bx > ax)))
        if is_in:
            at, along_x, along_y = flat.planes[t]
            measure = at + along_x * float(x - corners[0][0]) + along_y * float(y - corners[0][1])
            is_perspective, scale, shift = flat.lens
            depth = (scale / measure + shift) if is_perspective else measure
            low, high = map(int, flat.depths[t])
            hits.append((int(min(max(depth * 2.0**32, low), high)), int(flat.sides[t])))
    return hits
