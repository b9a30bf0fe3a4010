# mypy: allow-untyped-defs, allow-untyped-calls
"""From a grown region to operations of the range coder.

An event is a context (with the state it is coded in) and a value; the context's table and shift turn it
into operations. NUMBER in place of a context: the value is coded as a number, in state A.
"""

import numpy as np

from foveal.base.jit import kernel
from foveal.coding._kernels_rans import RAW, STATE_B, put_number

from ._kernels_geometry import across, degree_class, frame, predict, scale, wrap
from ._kernels_layout import (
    ACROSS_AT,
    ALONG_AT,
    COARSE_AT,
    CODE_AT,
    COLOUR_AT,
    ESCAPE,
    FIRST,
    MET,
    MIDDLE,
    NORMAL_AT,
    SCALES,
    SMALL_SCALES,
    SPLIT,
    START,
    WALK_AT,
    WALK_FAR,
)

NUMBER = -1


@kernel
def zigzag(x):
    return ((x << 1) ^ (x >> 63)) & 0xFFFFFFFF


@kernel
def coarse_counts(positions, vertices, counts):
    """counts[k] = the vertices whose coordinates are all multiples of 2^k."""
    counts[:] = 0
    for v in range(vertices):
        bits = positions[v, 0] | positions[v, 1] | positions[v, 2]
        k = 0
        while k < len(counts) and bits & ((1 << k) - 1) == 0:
            counts[k] += 1
            k += 1


@kernel
def position_events(positions, degree, corners, vertices, weights, coarse, contexts, values):
    """Events of a vertex: whether it lies on the patch's coarse grid, residuals along, aside, across.

    Without a coarse grid (0) the first is left out. A component's first vertices are plain differences.
    """
    count = 0
    was_coarse = 0
    for v in range(vertices):
        if corners[v, 5] == FIRST:
            for axis in range(3):
                before = np.int64(positions[v - 1, axis]) if v > 0 else 0
                contexts[count] = NUMBER
                values[count] = zigzag(wrap(positions[v, axis] - before))
                count += 1
            continue
        x, y, z, cx, cy, cz, size = predict(positions, degree, v, corners[v], weights)
        k, n0, n1, n2 = frame(cx, cy, cz)
        c = 0
        if coarse > 0:
            bits = positions[v, 0] | positions[v, 1] | positions[v, 2]
            is_coarse = int(bits & ((1 << coarse) - 1) == 0)
            contexts[count] = (COARSE_AT + was_coarse) | STATE_B
            values[count] = was_coarse = is_coarse
            count += 1
            c = coarse * is_coarse
        half = (1 << c) >> 1
        rx = (positions[v, 0] >> c) - ((x + half) >> c)
        ry = (positions[v, 1] >> c) - ((y + half) >> c)
        rz = (positions[v, 2] >> c) - ((z + half) >> c)
        size >>= c
        if k == 0:
            r, s, t = ry, rz, rx
        elif k == 1:
            r, s, t = rz, rx, ry
        else:
            r, s, t = rx, ry, rz
        r, s = wrap(r), wrap(s)
        t = wrap(t - across(n0, n1, n2, r, s))
        d = degree_class(degree[v])
        # One scale for all three, so that a decoder need not wait for one to read the next: 0.5 % larger
        # than with scales that know the residuals before, and positions a quarter faster.
        e = scale(size)
        contexts[count] = ALONG_AT + d * SCALES + e
        contexts[count + 1] = (ALONG_AT + d * SCALES + e) | STATE_B
        contexts[count + 2] = ACROSS_AT + e
        values[count], values[count + 1], values[count + 2] = r, s, t
        count += 3
    return count


@kernel
def small_scale(x):
    return min(scale(x), SMALL_SCALES - 1)


@kernel
def colour_events(colours, corners, vertices, ycc, contexts, values):
    """Three events a vertex: residuals of luma, orange and green. `ycc` (n, 3) is scratch."""
    count = 0
    for v in range(vertices):
        red, green, blue = np.int64(colours[v, 0]), np.int64(colours[v, 1]), np.int64(colours[v, 2])
        orange = red - blue
        middle = blue + (orange >> 1)
        ycc[v, 1] = orange
        ycc[v, 2] = green - middle
        ycc[v, 0] = middle + ((green - middle) >> 1)
        contrast = 0
        y = o = g = 0
        if corners[v, 5] != FIRST:
            a, b = corners[v, 0], corners[v, 1]
            y = (ycc[a, 0] + ycc[b, 0]) >> 1
            o = (ycc[a, 1] + ycc[b, 1]) >> 1
            g = (ycc[a, 2] + ycc[b, 2]) >> 1
            contrast = abs(ycc[a, 0] - ycc[b, 0])
        elif v > 0:
            y, o, g = ycc[v - 1, 0], ycc[v - 1, 1], ycc[v - 1, 2]
        y, o, g = ycc[v, 0] - y, ycc[v, 1] - o, ycc[v, 2] - g
        contexts[count] = COLOUR_AT + small_scale(contrast)
        contexts[count + 1] = (COLOUR_AT + SMALL_SCALES + small_scale(abs(y))) | STATE_B
        contexts[count + 2] = COLOUR_AT + 2 * SMALL_SCALES + small_scale(abs(o) + (abs(y) >> 1))
        values[count], values[count + 1], values[count + 2] = y, o, g
        count += 3
    return count


@kernel
def normal_events(normals, predicted, is_edge, vertices, contexts, values):
    """Two events a vertex: differences from the predicted pair; apart where the patch's boundary cuts."""
    count = 0
    before = 0
    for v in range(vertices):
        apart = 2 * SMALL_SCALES if is_edge[v] else 0
        u = np.int64(normals[v, 0]) - predicted[v, 0]
        w = np.int64(normals[v, 1]) - predicted[v, 1]
        contexts[count] = NORMAL_AT + apart + small_scale(before)
        contexts[count + 1] = (NORMAL_AT + apart + SMALL_SCALES + small_scale(abs(u))) | STATE_B
        values[count], values[count + 1] = u, w
        before = abs(u) + abs(w)
        count += 2
    return count


@kernel
def connectivity_operations(codes, code_contexts, count, extra, table_of, operations):
    """Operations for the codes and the numbers that belong to them; returns how many."""
    at = e = 0
    for i in range(count):
        code = codes[i]
        if code == START:
            pattern = extra[e]
            operations[at] = RAW | 3 << 16 | pattern
            at += 1
            e += 1
            for k in range(3):
                if not pattern >> k & 1:
                    at = put_number(np.int64(extra[e]), 0, operations, at)
                    e += 1
            continue
        operations[at] = np.int64(table_of[CODE_AT + code_contexts[i]]) << 8 | code
        at += 1
        if code == MET:
            at = put_number(np.int64(extra[e]), 0, operations, at)
            e += 1
        elif code == SPLIT:
            walk = extra[e]
            operations[at] = np.int64(table_of[WALK_AT]) << 8 | walk
            at += 1
            e += 1
            if walk == WALK_FAR:
                at = put_number(np.int64(extra[e]), 0, operations, at)
                e += 1
    return at


@kernel
def value_operations(contexts, values, count, table_of, shift_of, frequencies, operations, at):
    """Operations for events; returns how many operations there are now."""
    for i in range(count):
        if contexts[i] == NUMBER:
            at = put_number(values[i], 0, operations, at)
            continue
        state = contexts[i] & STATE_B
        context = contexts[i] & ~STATE_B
        table = np.int64(table_of[context])
        shift = np.int64(shift_of[context])
        symbol = (values[i] >> shift) + MIDDLE
        if symbol < 0 or symbol >= ESCAPE or frequencies[table, symbol] == 0:
            operations[at] = state | table << 8 | ESCAPE
            at = put_number(zigzag(values[i]), state, operations, at + 1)
            continue
        operations[at] = state | table << 8 | symbol
        at += 1
        if shift > 0:
            operations[at] = state | RAW | shift << 16 | (values[i] & ((1 << shift) - 1))
            at += 1
    return at


@kernel
def lone_events(positions, first, contexts, values):
    """Vertices that no triangle uses, from `first` on: differences, as numbers."""
    count = 0
    for v in range(first, len(positions)):
        for axis in range(3):
            before = np.int64(positions[v - 1, axis]) if v > 0 else 0
            contexts[count] = NUMBER
            values[count] = zigzag(wrap(positions[v, axis] - before))
            count += 1
    return count
