# mypy: allow-untyped-defs, allow-untyped-calls
"""A tree under construction as a stream of nodes: written from its leaves, read from its root.

`codes` has, for each node, the number of intervals of its set of legal values, with IS_INNER where its
children precede it; `bounds` the intervals. Children are written before parents and the last child first, so
that read from its end the stream gives parents first and children in order.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.jit import lean

from ._kernels_sets import agree, shortest

IS_INNER = 0x80
IS_ELSEWHERE = 0x40
"""The node has children, in a stream of its own."""
COUNT = 0x3F
PUSH_CODES = 24
PUSH_BOUNDS = 24 * 16
"""What one call of `push` may write: a node at each level, of KEPT intervals."""


class Up(NamedTuple):
    """A stream being written, with the children of the nodes that wait for more of them."""

    codes: NDArray[np.uint8]
    bounds: NDArray[np.uint32]
    at: NDArray[np.int64]  # (2,) how much of both is written
    filled: NDArray[np.int64]  # (levels + 1,) children at the level so far
    all_leaves: NDArray[np.bool_]  # (levels + 1,)
    begun: NDArray[np.int64]  # (levels + 1, 2) where in both the first child at the level was put
    counts: NDArray[np.int64]  # (levels + 1, children)
    low: NDArray[np.int64]  # (levels + 1, children, KEPT) sets of the children at the level
    high: NDArray[np.int64]
    ends: NDArray[np.int64]  # (2 * children * KEPT,) scratch
    steps: NDArray[np.int64]
    set_low: NDArray[np.int64]  # (KEPT,) the set to be pushed; afterwards that of the last node written
    set_high: NDArray[np.int64]


@lean
def has_room(up):
    """Whether one more `push` fits."""
    return up.at[0] + PUSH_CODES <= len(up.codes) and up.at[1] + PUSH_BOUNDS <= len(up.bounds)


@lean
def push_one(up, level, low, high, most):
    """Write a leaf of one interval."""
    up.set_low[0] = low
    up.set_high[0] = high
    return push(up, level, 1, 0, most)


@lean
def push(up, level, count, kind, most):
    """Write a node with the set in `set_low`, `set_high`, and every node above it that is now complete.

    `kind` is 0 of a leaf, else IS_INNER or IS_ELSEWHERE. Returns the level of the last node written. Children
    that are leaves and have a value in common become one leaf.
    """
    children = up.counts.shape[1]
    while True:
        if level > 0 and up.filled[level] == 0:
            up.begun[level, 0] = up.at[0]
            up.begun[level, 1] = up.at[1]
            up.all_leaves[level] = True
        up.codes[up.at[0]] = count | kind
        up.at[0] += 1
        bound = up.at[1]
        for i in range(count):
            up.bounds[bound + 2 * i] = up.set_low[i]
            up.bounds[bound + 2 * i + 1] = up.set_high[i]
        up.at[1] = bound + 2 * count
        if level == 0:
            return 0
        slot = up.filled[level]
        up.counts[level, slot] = count
        for i in range(count):
            up.low[level, slot, i] = up.set_low[i]
            up.high[level, slot, i] = up.set_high[i]
        if kind != 0:
            up.all_leaves[level] = False
        up.filled[level] = slot + 1
        if slot + 1 < children:
            return level
        up.filled[level] = 0
        count, shared = agree(
            *(up.counts[level], up.low[level], up.high[level], children, most, up.ends, up.steps),
            *(up.set_low, up.set_high),
        )
        kind = IS_INNER
        if shared == children and up.all_leaves[level]:
            kind = 0
            up.at[0] = up.begun[level, 0]
            up.at[1] = up.begun[level, 1]
        level -= 1


@lean
def before(level, code, bits):
    """Level and number of the node to be written after this one and all below it: level 0 where none is left.

    Children are numbered by the lowest `bits`, and the last child comes first.
    """
    while level > 0 and code & ((1 << bits) - 1) == 0:
        level -= 1
        code >>= bits
    return level, code - 1


class Down(NamedTuple):
    """A stream being read: values are chosen, the lists of a Tree filled. Level 0 is the stream's root."""

    inherited: NDArray[np.int64]  # (levels + 1,) the value that holds above the nodes at the level
    child: NDArray[np.int64]  # (levels + 1,) number of the next child at the level
    parent: NDArray[np.int64]  # (levels + 1,) where in `masks` the parent of the nodes at the level is
    mask_at: NDArray[np.int64]  # (levels + 1,) where in `masks` the level's next is put
    value_at: NDArray[np.int64]  # (levels + 1,)
    masks: NDArray[np.uint16]
    values: NDArray[np.uint32]
    elsewhere: NDArray[np.int64]  # the value that holds at each node that goes on elsewhere, in order
    elsewhere_at: NDArray[np.int64]  # (1,)


@lean
def survey(codes, children, left, nodes, inner):
    """Count the nodes, and those with children here, of each level of a stream. `left` is scratch."""
    level = 0
    left[0] = 0
    for at in range(len(codes) - 1, -1, -1):
        nodes[level] += 1
        left[level] -= 1
        if codes[at] & IS_INNER:
            inner[level] += 1
            level += 1
            left[level] = children
        else:
            while level > 0 and left[level] == 0:
                level -= 1


@lean
def descend(down, codes, bounds, children):
    """Choose the values of a stream; the kind of its root.

    A node keeps the value from above where that is in its set, else it takes the shortest there is. That this
    stores the fewest values is the second half of parsimony (Hartigan 1973).
    """
    level, root = 0, 0
    bound = np.int64(len(bounds))
    for at in range(len(codes) - 1, -1, -1):
        count = np.int64(codes[at] & COUNT)
        bound -= 2 * count
        value = down.inherited[level]
        stays = is_within(bounds, bound, count, value)
        if not stays:
            value = choose(bounds, bound, count)
            down.values[down.value_at[level]] = value
            down.value_at[level] += 1
        is_inner = codes[at] & IS_INNER != 0
        is_elsewhere = codes[at] & IS_ELSEWHERE != 0
        kind = (2 if is_inner or is_elsewhere else 0) + (0 if stays else 1)
        if level == 0:
            root = kind
        else:
            down.masks[down.parent[level]] |= kind << (2 * down.child[level])
            down.child[level] += 1
        if is_elsewhere:
            down.elsewhere[down.elsewhere_at[0]] = value
            down.elsewhere_at[0] += 1
        if is_inner:
            place = down.mask_at[level]
            down.masks[place] = 0
            down.mask_at[level] = place + 1
            level += 1
            down.parent[level] = place
            down.child[level] = 0
            down.inherited[level] = value
        else:
            while level > 0 and down.child[level] == children:
                level -= 1
    return root


@lean
def is_within(bounds, begin, count, value):
    """Whether a value lies in one of the intervals."""
    is_in = False
    for i in range(count):
        is_in |= bounds[begin + 2 * i] <= value <= bounds[begin + 2 * i + 1]
    return is_in


@lean
def choose(bounds, begin, count):
    """The shortest value in the intervals."""
    fewest = 33
    value = np.int64(0)
    for i in range(count):
        bits, candidate = shortest(np.int64(bounds[begin + 2 * i]), np.int64(bounds[begin + 2 * i + 1]))
        if bits < fewest:
            fewest, value = bits, candidate
    return value
