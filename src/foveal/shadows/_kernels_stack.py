# mypy: allow-untyped-defs, allow-untyped-calls
"""A stack's stream from the quadtrees of its images: cubes are divided only where one of their images is.

Based on: Scandolo, Bauszat, Eisemann 2016, section 4, whose images have all their pixels made.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.jit import lean

from ._kernels_stream import COUNT, IS_INNER, before, has_room, push_one

FAR = 4294967295


class Squares(NamedTuple):
    """The quadtrees of all images: squares, and the values that are legal for all of a square's pixels."""

    first: NDArray[np.int64]  # (n,) the first of four children that follow each other; -1 of a leaf
    low: NDArray[np.uint32]  # (n,) of leaves
    high: NDArray[np.uint32]
    roots: NDArray[np.int64]  # (images,)


@lean
def squares_of(codes, bounds, squares, at, stack):
    """Spread a stream's nodes out from number `at` on, the root first; the number after the last."""
    root = at
    at += 1
    depth = 0
    stack[0] = root
    bound = np.int64(len(bounds))
    for i in range(len(codes) - 1, -1, -1):
        count = np.int64(codes[i] & COUNT)
        bound -= 2 * count
        node = stack[depth]
        depth -= 1
        if codes[i] & IS_INNER:
            squares.first[node] = at
            for child in range(4):
                depth += 1
                stack[depth] = at + 3 - child  # they come in order, so the first is taken first
            at += 4
        else:
            squares.first[node] = -1
            squares.low[node] = bounds[bound]
            squares.high[node] = bounds[bound + 1]
    return at


@lean
def up_from_squares(up, squares, levels, spread, nodes, most):
    """Write the stream of a stack of images of 2^levels pixels a side. False where it has no room for more.

    Images are 2^spread apart, with nothing between. `nodes` is scratch, (levels + 1, images): which square of
    each image a cube on the way has.
    """
    images = len(squares.roots)
    level, code = 0, np.int64(0)
    while True:
        if not has_room(up):
            return False
        size = levels - level
        place = third_bits(code) << size
        gap = (1 << spread) - 1
        first = (place + gap) >> spread  # image
        last = min(images, (place + (1 << size) + gap) >> spread)
        low, high = np.int64(0), np.int64(FAR)
        is_leaf = True
        for image in range(first, last):
            if level == 0:
                node = squares.roots[image]
            else:
                node = nodes[level - 1, image]
                if squares.first[node] >= 0:
                    node = squares.first[node] + (code & 3)
            nodes[level, image] = node
            if squares.first[node] >= 0:
                is_leaf = False
            else:
                low = max(low, np.int64(squares.low[node]))
                high = min(high, np.int64(squares.high[node]))
        if is_leaf and low <= high:
            push_one(up, level, low, high, most)
        else:
            level += 1
            code = 8 * code + 7
            continue
        level, code = before(level, code, 3)
        if level == 0:
            return True


@lean
def third_bits(code):
    """The bits of an octree's number that say which half of the images, together."""
    image = np.int64(0)
    bit = 0
    while code >> (3 * bit):
        image |= (code >> (3 * bit + 2) & 1) << bit
        bit += 1
    return image
