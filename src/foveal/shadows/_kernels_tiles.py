# mypy: allow-untyped-defs, allow-untyped-calls
"""A tree's stream from triangles, without making all pixels: tiles are divided only where depth changes.

Based on: Scandolo, Bauszat, Eisemann 2016, section 3.1, whose tiles have all their pixels made.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.jit import lean

from ._kernels_cover import common_interval
from ._kernels_flat import BACK, FRONT, covers, depth_at, meets
from ._kernels_stream import before, has_room, push_one

FAR = 4294967295
BLOCK_LEVELS = 3
BLOCK = 1 << BLOCK_LEVELS
"""Pixels along the side of a block, whose pixels are made all at once."""
DONE, NO_STREAM, NO_LIST = range(3)


class Work(NamedTuple):
    """Scratch of one thread."""

    lists: NDArray[np.int32]  # triangles of the tiles on the way, one list after the other
    list_starts: NDArray[np.int64]  # (levels + 2,) of each level: the next one's is where it ends
    hits: NDArray[np.int64]  # what rays meet, depth << 2 | side: as much room for each pixel of a block
    hit_count: NDArray[np.int64]  # (BLOCK²,)
    lower: NDArray[np.int64]  # (BLOCK²,) intervals of a block's pixels, in the order of the tree
    upper: NDArray[np.int64]
    least: NDArray[np.int64]  # (MOST,) depths of a tile's triangles
    greatest: NDArray[np.int64]
    near: NDArray[np.int32]  # (MOST + 1,) how many, and which
    stamp: NDArray[np.int64]  # (1,)
    stamps: NDArray[np.int64]  # (SLOTS,)
    keys: NDArray[np.int32]
    sums: NDArray[np.int32]
    slots: NDArray[np.int32]  # (3 MOST,)


@lean
def up_from_triangles(up, flat, work, count, place, levels, bits, is_strict, is_sparse, most):
    """Write the stream of one tile of 2^levels pixels a side; its triangles are `work.lists[:count]`.

    `place` is the number of the tile among all of its size, in the order of the tree. Without `is_sparse`
    every pixel is made. Returns DONE, NO_STREAM or NO_LIST, where there is no room.
    """
    unit = np.int64(1) << bits
    work.list_starts[0] = 0
    work.list_starts[1] = count
    level = 0  # of the node at hand: the tile's is 0
    code = np.int64(place)  # number of the node at hand among all of its size
    while True:
        if not has_room(up):
            return NO_STREAM
        size = levels - level
        span = ((np.int64(1) << size) - 1) * unit
        x0 = (even_bits(code) << size) * unit + (unit >> 1)
        y0 = (even_bits(code >> 1) << size) * unit + (unit >> 1)
        begin, end = work.list_starts[level], work.list_starts[level + 1]
        if level > 0:
            # all of the tile above may meet this one
            if 2 * begin - work.list_starts[level - 1] > len(work.lists):
                return NO_LIST
            end = kept(flat, work, level, x0, y0, x0 + span, y0 + span)
        room = len(work.hits) >> (2 * size)
        low, high = np.int64(FAR), np.int64(FAR)
        if begin < end:
            low, high = np.int64(1), np.int64(0)
            if is_sparse and size > 0:
                low, high = common_interval(
                    flat, work.lists, begin, end, x0, y0, x0 + span, y0 + span, is_strict, work
                )
        if low <= high:
            push_one(up, level, low, high, most)
        elif size <= BLOCK_LEVELS and (end - begin <= room or size == 0):
            if end - begin > room:
                return NO_LIST
            make_pixels(flat, work, begin, end, x0, y0, unit, size, room, is_strict)
            if not push_block(up, work, level, size, most):
                return NO_STREAM
        else:
            level += 1
            code = 4 * code + 3
            continue
        level, code = before(level, code, 2)
        if level == 0:
            return DONE


@lean
def pixels_of_squares(flat, work, starts, squares, size, bits, is_strict, lower, upper):
    """Put the intervals of all pixels of squares of 2^size pixels a side into (side, side) arrays.

    The triangles of a square are `work.lists[starts[square]:starts[square + 1]]`, and there is room for as
    many hits a pixel.
    """
    unit = np.int64(1) << bits
    room = len(work.hits) >> (2 * size)
    for square in squares:
        x = even_bits(np.int64(square)) << size
        y = even_bits(np.int64(square) >> 1) << size
        place = (x * unit + (unit >> 1), y * unit + (unit >> 1))
        make_pixels(
            *(flat, work, starts[square], starts[square + 1], place[0], place[1], unit, size, room, is_strict)
        )
        for pixel in range(1 << (2 * size)):
            lower[y + even_bits(pixel >> 1), x + even_bits(pixel)] = work.lower[pixel]
            upper[y + even_bits(pixel >> 1), x + even_bits(pixel)] = work.upper[pixel]


@lean
def even_bits(code):
    """Every other bit of a number, from the lowest."""
    x = code & 0x5555555555555555
    x = (x | x >> 1) & 0x3333333333333333
    x = (x | x >> 2) & 0x0F0F0F0F0F0F0F0F
    x = (x | x >> 4) & 0x00FF00FF00FF00FF
    x = (x | x >> 8) & 0x0000FFFF0000FFFF
    return (x | x >> 16) & 0x00000000FFFFFFFF


@lean
def kept(flat, work, level, x0, y0, x1, y1):
    """Put behind the list of the tile above what of it meets this one; where that ends."""
    end = work.list_starts[level]
    for i in range(work.list_starts[level - 1], work.list_starts[level]):
        t = work.lists[i]
        if meets(flat.corners, t, x0, y0, x1, y1):
            work.lists[end] = t
            end += 1
    work.list_starts[level + 1] = end
    return end


@lean
def make_pixels(flat, work, begin, end, x0, y0, unit, size, room, is_strict):
    """The intervals of a block's pixels, in the order of the tree, from all triangles that meet it."""
    side = 1 << size
    for pixel in range(side * side):
        work.hit_count[pixel] = 0
    for i in range(begin, end):
        t = work.lists[i]
        c = flat.corners
        first_x = max(0, -((x0 - min(c[t, 0], min(c[t, 2], c[t, 4]))) // unit))
        first_y = max(0, -((y0 - min(c[t, 1], min(c[t, 3], c[t, 5]))) // unit))
        last_x = min(side - 1, (max(c[t, 0], max(c[t, 2], c[t, 4])) - x0) // unit)
        last_y = min(side - 1, (max(c[t, 1], max(c[t, 3], c[t, 5])) - y0) // unit)
        for y in range(first_y, last_y + 1):
            for x in range(first_x, last_x + 1):
                if covers(c, t, x0 + x * unit, y0 + y * unit):
                    pixel = all_bits(x) | all_bits(y) << 1
                    depth = depth_at(flat, t, x0 + x * unit, y0 + y * unit)
                    work.hits[pixel * room + work.hit_count[pixel]] = depth << 2 | np.int64(flat.sides[t])
                    work.hit_count[pixel] += 1
    for pixel in range(side * side):
        low, high = interval_of(work.hits, pixel * room, work.hit_count[pixel], is_strict)
        work.lower[pixel] = low
        work.upper[pixel] = high


@lean
def interval_of(hits, begin, count, is_strict):
    """The legal values of a pixel, from what its ray meets in any order, depth << 2 | side.

    Lowest is where the ray enters. A ray that enters a closed part leaves where it has met as many backs as
    fronts: whatever it meets between is inside. Any other may be said to leave just before the next surface;
    or, strictly, at once, which is right for what moves in the air below it as well.
    """
    if count == 0:
        return np.int64(FAR), np.int64(FAR)
    for i in range(begin + 1, begin + count):
        key = hits[i]
        at = i
        while at > begin and hits[at - 1] > key:
            hits[at] = hits[at - 1]
            at -= 1
        hits[at] = key
    low = hits[begin] >> 2
    if hits[begin] & 3 == FRONT:
        inside = 0
        for i in range(begin, begin + count):
            side = hits[i] & 3
            inside += (1 if side == FRONT else 0) - (1 if side == BACK else 0)
            if inside == 0 and side == BACK:
                return low, max(low, (hits[i] >> 2) - 1)
    if is_strict:
        return low, low
    for i in range(begin + 1, begin + count):
        if hits[i] >> 2 > low:  # surfaces in one place are one
            return low, (hits[i] >> 2) - 1
    return low, np.int64(FAR)


@lean
def push_block(up, work, level, size, most):
    """Write the nodes of a block: squares whose pixels have values in common are leaves."""
    at = 1 << (2 * size)
    while at > 0:
        if not has_room(up):
            return False
        k = 0
        while k < size and at & ((4 << (2 * k)) - 1) == 0:
            k += 1
        while True:
            low, high = work.lower[at - 1], work.upper[at - 1]
            for i in range(at - (1 << (2 * k)), at - 1):
                low = max(low, work.lower[i])
                high = min(high, work.upper[i])
            if low <= high:
                break
            k -= 1
        push_one(up, level + size - k, low, high, most)
        at -= 1 << (2 * k)
    return True


@lean
def deal(flat, bits, size, levels, ends, out):
    """Deal triangles out to the 4^levels squares of 2^size pixels a side that they meet.

    With an empty `out`, `ends` gets how many each square has; else it is where each square's begin in `out`,
    and is advanced to where they end. Squares are numbered in the order of the tree.
    """
    unit = np.int64(1) << bits
    half = unit >> 1
    shift = bits + size
    span = ((np.int64(1) << size) - 1) * unit
    last = (np.int64(1) << levels) - 1
    c = flat.corners
    for t in range(len(c)):
        first_x = max(0, np.int64(min(c[t, 0], min(c[t, 2], c[t, 4]))) >> shift)
        first_y = max(0, np.int64(min(c[t, 1], min(c[t, 3], c[t, 5]))) >> shift)
        last_x = min(last, np.int64(max(c[t, 0], max(c[t, 2], c[t, 4]))) >> shift)
        last_y = min(last, np.int64(max(c[t, 1], max(c[t, 3], c[t, 5]))) >> shift)
        for y in range(first_y, last_y + 1):
            for x in range(first_x, last_x + 1):
                x0 = (x << shift) + half
                y0 = (y << shift) + half
                if meets(c, t, x0, y0, x0 + span, y0 + span):
                    square = all_bits(x) | all_bits(y) << 1
                    if len(out) > 0:
                        out[ends[square]] = t
                    ends[square] += 1


@lean
def all_bits(x):
    """The bits of a number of up to 16 bits, with a gap before each."""
    x = (x | x << 8) & 0x00FF00FF
    x = (x | x << 4) & 0x0F0F0F0F
    x = (x | x << 2) & 0x33333333
    return (x | x << 1) & 0x55555555
