# mypy: allow-untyped-defs, allow-untyped-calls
"""Walks down a packed tree, by `spec/shadows.md`.

A walk leaves its path behind: for each level down to where it ended the address of the node's link (NOWHERE
if it ended there, at a leaf or nothing) and of the last value. The next walk begins at the last node that
both have in common: neighbours in a picture share most of their path, and 120 million of them a second
are looked up instead of 14 million at random places.
"""

import numpy as np

from foveal.base.jit import inlined, kernel, lean

NOWHERE = -1  # instead of a link
STACKED = 96  # nodes that wait at most: 3 a level and one, and files have at most 24 levels
IN_STACK = 5  # link, whether the last value is lit, level, x, y


@inlined
def _ones(v):
    """Bits set in 16 bits."""
    v = v - (v >> 1 & 0x5555)
    v = (v & 0x3333) + (v >> 2 & 0x3333)
    v = (v + (v >> 4)) & 0x0F0F
    return (v + (v >> 8)) & 0x1F


@inlined
def shared_level(difference, level):
    """The last level whose node holds two pixels of the map of `level`, by the bits in which they differ."""
    up = 0
    while difference >> up:
        up += 1
    return level - up


@kernel
def begin(packed, level):
    """A path that is the root alone, for the map of `level`."""
    links, valued = np.empty(level + 1, np.int64), np.empty(level + 1, np.int64)
    has_children = packed.root == 3
    links[0] = 0 if has_children else NOWHERE
    valued[0] = 1 if has_children else 0
    return links, valued


@lean
def descend(packed, map_level, level, stop, x, y, z, links, valued):
    """Walk on from `level` of the path to a pixel's node at level `stop`, if there is one; where it ended."""
    words, scales = packed.words, packed.scales
    address, value = links[level], valued[level]
    while level < stop:
        bit = map_level - 1 - level
        at = ((x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2) << 1
        link = np.int64(words[address])
        kind = link >> at & 3
        level += 1
        if kind == 0:
            links[level], valued[level] = NOWHERE, value
            return level
        address += (link >> 16) * scales[level - 1] + _ones(link & ((1 << at) - 1))
        if kind == 1:
            links[level], valued[level] = NOWHERE, address
            return level
        if kind == 3:
            value = address + 1
        links[level], valued[level] = address, value
    return level


@kernel
def values_at(packed, pixels, level, out):
    """The value of each pixel (x, y, image) of the map that the tree is down to `level`."""
    links, valued = begin(packed, level)
    reached, last_x, last_y, last_z = 0, 0, 0, 0
    for i in range(len(pixels)):
        x, y, z = pixels[i, 0], pixels[i, 1], pixels[i, 2]
        shared = shared_level((x ^ last_x) | (y ^ last_y) | (z ^ last_z), level)
        reached = min(shared, reached)
        if links[reached] >= 0:
            reached = descend(packed, level, reached, level, x, y, z, links, valued)
        last_x, last_y, last_z = x, y, z
        out[i] = packed.words[valued[reached]]


@lean
def lit_in(packed, map_level, x0, y0, x1, y1, z, step, path, stack):
    """How many pixels of x0 <= x <= x1, y0 <= y <= y1 are lit for a receiver at a step.

    `path` is that of the last walk: links, values, and (reached, x, y, z), which are brought up to date.
    One value for all is one comparison; else the children of the last node that holds them all are gone
    through, each with the part of the rectangle that is its own.
    """
    links, valued, last = path
    common = shared_level((x0 ^ x1) | (y0 ^ y1), map_level)
    shared = shared_level((x0 ^ last[1]) | (y0 ^ last[2]) | (z ^ last[3]), map_level)
    level = min(shared, last[0], common)
    if links[level] >= 0:
        level = descend(packed, map_level, level, common, x0, y0, z, links, valued)
    last[0], last[1], last[2], last[3] = level, x0, y0, z
    is_lit = np.int64(step <= packed.words[valued[level]])
    if links[level] < 0 or level == map_level:
        return (x1 - x0 + 1) * (y1 - y0 + 1) if is_lit else 0
    mask = -1 << (map_level - level)
    stack[0] = links[level], is_lit, level, x0 & mask, y0 & mask
    return _lit_below(packed, map_level, x0, y0, x1, y1, z, step, stack)


@lean
def _lit_below(packed, map_level, x0, y0, x1, y1, z, step, stack):
    """The same below the node that is on the stack."""
    words, scales = packed.words, packed.scales
    waiting, count = 1, 0
    while waiting:
        waiting -= 1
        address, is_lit, level = stack[waiting, 0], stack[waiting, 1], stack[waiting, 2]
        left, top = stack[waiting, 3], stack[waiting, 4]
        link, half = np.int64(words[address]), 1 << (map_level - 1 - level)
        block = address + (link >> 16) * scales[level]
        image = (z >> (map_level - 1 - level) & 1) << 3
        for child in range(4):
            x, y = left + (half if child & 1 else 0), top + (half if child & 2 else 0)
            wide = min(x1, x + half - 1) - max(x0, x) + 1
            high = min(y1, y + half - 1) - max(y0, y) + 1
            if wide <= 0 or high <= 0:
                continue
            at = child << 1 | image
            kind = link >> at & 3
            child_lit, place = is_lit, 0
            if kind:
                place = block + _ones(link & ((1 << at) - 1))
                if kind & 1:
                    child_lit = np.int64(step <= words[place + (kind >> 1)])
            if kind < 2 or half == 1:
                count += wide * high if child_lit else 0
            else:
                stack[waiting] = place, child_lit, level + 1, x, y
                waiting += 1
    return count


@kernel
def lit_counts(packed, pixels, steps, radius, level, out):
    """Of the square of pixels around each (x, y, image) how many are lit, at the map of `level`.

    Pixels off the map are lit.
    """
    links, valued = begin(packed, level)
    path = (links, valued, np.zeros(4, np.int64))
    stack = np.empty((STACKED, IN_STACK), np.int64)
    most, samples = (1 << level) - 1, (2 * radius + 1) ** 2
    for i in range(len(pixels)):
        x, y, z = pixels[i, 0], pixels[i, 1], pixels[i, 2]
        x0, y0 = max(x - radius, 0), max(y - radius, 0)
        x1, y1 = min(x + radius, most), min(y + radius, most)
        if x0 > x1 or y0 > y1:
            out[i] = samples
            continue
        on_map = (x1 - x0 + 1) * (y1 - y0 + 1)
        out[i] = samples - on_map + lit_in(packed, level, x0, y0, x1, y1, z, steps[i], path, stack)
