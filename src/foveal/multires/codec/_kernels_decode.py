# mypy: allow-untyped-defs, allow-untyped-calls
"""Words to a patch, whatever the words: every index that comes from them is checked before it is used.

Each kernel goes on where the one before left the states a, b and the place `at` in the words. A place
past the end reads as zeros; whoever called compares `at` and the states when all is read.
"""

import numpy as np

from foveal.base.jit import inlined, kernel
from foveal.coding._kernels_rans import number, raw, symbol

from ._kernels_connectivity import (
    DEAD,
    FREE,
    LIVE,
    close_edge,
    code_context,
    kind_after,
    link,
)
from ._kernels_encode import small_scale
from ._kernels_geometry import across, degree_class, frame, predict, scale, wrap
from ._kernels_layout import (
    ACROSS_AT,
    ALONG_AT,
    AT_DEAD,
    BOUNDARY,
    COARSE_AT,
    CODE_AT,
    COLOUR_AT,
    END,
    ESCAPE,
    FIRST,
    FRESH,
    LEFT,
    MET,
    MIDDLE,
    NEW,
    NORMAL_AT,
    PROBABILITY_BITS,
    RIGHT,
    SCALES,
    SMALL_SCALES,
    SPLIT,
    SPLIT_NEXT,
    START,
    WALK_AT,
    WALK_FAR,
    WALK_NEXT,
)


@kernel
def connectivity(words, a, at, slots, table_of, faces, corners, degree, is_edge, front, state, stack):
    """Fill faces, corners, degree and is_edge; the twin of `_kernels_connectivity.grow`.

    `front` (s, 4) int32, `state` (s) zeros and `stack` (s) are scratch, s = 3 m + 4; degree and is_edge
    come cleared. Returns (vertices, a, at), vertices = -1 if the words are no patch.
    """
    following, previous, origin, opposite = front[:, 0], front[:, 1], front[:, 2], front[:, 3]
    most, triangles = len(degree), len(faces)
    t = vertices = used = top = 0
    kind = FIRST
    gate = -1
    last = START
    while t < triangles or gate >= 0:
        if gate < 0:
            if vertices > 0:
                corners[vertices - 1, 5] = kind = kind_after(kind, START)
            pattern, a, at = raw(3, a, words, at)
            for k in range(3):
                if pattern >> k & 1:
                    v = vertices
                    if v >= most:
                        return -1, a, at
                    corners[v, 5] = kind = FIRST
                    vertices += 1
                else:
                    back, a, at = number(a, words, at)
                    v = vertices - 1 - back
                    if v < 0:
                        return -1, a, at
                faces[t, k] = v
                degree[v] += 1
                s = used + k
                following[s] = used + (k + 1) % 3
                previous[s] = used + (k + 2) % 3
                origin[s] = v
                state[s] = LIVE
            for k in range(3):
                opposite[used + k] = faces[t, (k + 2) % 3]
            t += 1
            gate = used
            used += 3
            last = START
            continue
        nxt, prv = following[gate], previous[gate]
        tail, head = origin[gate], origin[nxt]
        context = code_context(
            degree[head], degree[tail], last, int(state[nxt] == DEAD), int(state[prv] == DEAD)
        )
        last, a, at = symbol(slots, np.int64(table_of[CODE_AT + context]), a, PROBABILITY_BITS, words, at)
        corners[vertices - 1, 5] = kind = kind_after(kind, last)
        if last == BOUNDARY:
            is_edge[tail] = is_edge[head] = 1
            gate = close_edge(following, previous, state, gate)
        else:
            if t >= triangles:
                return -1, a, at
            faces[t, 0] = head
            faces[t, 1] = tail
            if last == RIGHT:
                if nxt == gate or state[nxt] != LIVE:
                    return -1, a, at
                beyond = following[nxt]
                v = origin[beyond]
                state[nxt] = FREE
                following[gate] = beyond
                previous[beyond] = gate
                opposite[gate] = head
            elif last == NEW:
                v = vertices
                if v >= most:
                    return -1, a, at
                is_alive = state[nxt] == LIVE and nxt != gate
                kind = FRESH if is_alive else AT_DEAD
                corners[v, 0] = tail
                corners[v, 1] = head
                corners[v, 2] = opposite[gate]
                corners[v, 3] = origin[following[nxt]] if is_alive else tail
                corners[v, 4] = opposite[nxt] if is_alive else tail
                corners[v, 5] = kind
                vertices += 1
                link(following, previous, gate, used, nxt, -1)
            elif last == LEFT:
                if prv == gate or state[prv] != LIVE:
                    return -1, a, at
                v = origin[prv]
                state[gate] = FREE
                following[prv] = nxt
                previous[nxt] = prv
                opposite[prv] = tail
                gate = prv
            elif last == END:
                if state[nxt] != LIVE or state[prv] != LIVE or following[nxt] != prv:
                    return -1, a, at
                if (nxt == gate) | (prv == gate) | (nxt == prv):
                    return -1, a, at
                v = origin[prv]
                state[gate] = state[nxt] = state[prv] = FREE
                gate = -1
            else:
                met = -1
                if last == MET:
                    back, a, at = number(a, words, at)
                    v = vertices - 1 - back
                else:
                    if last == SPLIT_NEXT:
                        met = following[following[nxt]]
                    elif last == SPLIT:
                        walk, a, at = symbol(
                            slots, np.int64(table_of[WALK_AT]), a, PROBABILITY_BITS, words, at
                        )
                        if walk == WALK_FAR:
                            back, a, at = number(a, words, at)
                            met = used - 1 - back
                        else:
                            met = _step(following, previous, gate, walk)
                    else:
                        met = previous[prv]
                    if met < 0 or state[met] == FREE or (met == gate) | (met == nxt):
                        return -1, a, at
                    v = origin[met]
                    stack[top] = gate
                    top += 1
                if v < 0:
                    return -1, a, at
                link(following, previous, gate, used, nxt, met)
            if last == NEW or last >= SPLIT:
                state[used] = LIVE
                origin[used] = v
                opposite[used] = tail
                opposite[gate] = head
                gate = used
                used += 1
            faces[t, 2] = v
            degree[tail] += 1
            degree[head] += 1
            degree[v] += 1
            t += 1
        while gate < 0 and top > 0:
            top -= 1
            if state[stack[top]] == LIVE:
                gate = stack[top]
    return vertices, a, at


@kernel
def _step(following, previous, gate, walk):
    """The slot that `walk` leads to from the gate; see `_kernels_connectivity._walk`."""
    s = gate
    if walk < WALK_NEXT:
        for _ in range(walk + 4):
            s = following[s]
    else:
        for _ in range(walk - WALK_NEXT + 1):
            s = previous[s]
    return s


@inlined
def _value(context, slots, table_of, shift_of, x, words, at):
    """One value in its context: (value, x, at)."""
    s, x, at = symbol(slots, np.int64(table_of[context]), x, PROBABILITY_BITS, words, at)
    if s == ESCAPE:
        value, x, at = number(x, words, at)
        return (value >> 1) ^ -(value & 1), x, at
    value = s - MIDDLE
    shift = np.int64(shift_of[context])
    if shift > 0:
        low, x, at = raw(shift, x, words, at)
        value = value << shift | low
    return value, x, at


@kernel
def _rare_value(context, slots, table_of, shift_of, x, words, at):
    """`_value` as a call: slower, but quick to compile."""
    return _value(context, slots, table_of, shift_of, x, words, at)


@kernel
def geometry(
    words, a, b, at, slots, table_of, shift_of, weights, coarse, corners, degree, vertices, positions
):
    """Fill positions, those of vertices that no triangle uses too. Returns (a, b, at)."""
    was_coarse = 0
    for v in range(len(positions)):
        if v >= vertices or corners[v, 5] == FIRST:
            for axis in range(3):
                before = np.int64(positions[v - 1, axis]) if v > 0 else 0
                value, a, at = number(a, words, at)
                positions[v, axis] = wrap(before + ((value >> 1) ^ -(value & 1)))
            continue
        x, y, z, cx, cy, cz, size = predict(positions, degree, v, corners[v], weights)
        c = 0
        if coarse > 0:
            flag, b, at = _rare_value(COARSE_AT + was_coarse, slots, table_of, shift_of, b, words, at)
            was_coarse = int(flag != 0)
            c = coarse * was_coarse
        half = (1 << c) >> 1
        x, y, z, size = (x + half) >> c, (y + half) >> c, (z + half) >> c, size >> c
        d = degree_class(degree[v])
        e = scale(size)
        r, a, at = _value(ALONG_AT + d * SCALES + e, slots, table_of, shift_of, a, words, at)
        s, b, at = _value(ALONG_AT + d * SCALES + e, slots, table_of, shift_of, b, words, at)
        q, a, at = _value(ACROSS_AT + e, slots, table_of, shift_of, a, words, at)
        k, n0, n1, n2 = frame(cx, cy, cz)
        q += across(n0, n1, n2, r, s)
        is_x, is_y = k == 0, k == 1
        positions[v, 0] = wrap((x + (q if is_x else (s if is_y else r))) << c)
        positions[v, 1] = wrap((y + (r if is_x else (q if is_y else s))) << c)
        positions[v, 2] = wrap((z + (s if is_x else (r if is_y else q))) << c)
    return a, b, at


@kernel
def normals(words, a, b, at, slots, table_of, shift_of, is_edge, most, pairs):
    """Turn predicted pairs into the coded ones, in place. Returns (a, b, at)."""
    before = 0
    for v in range(len(pairs)):
        context = NORMAL_AT + (2 * SMALL_SCALES if is_edge[v] else 0)
        u, a, at = _rare_value(context + small_scale(before), slots, table_of, shift_of, a, words, at)
        context += SMALL_SCALES + small_scale(abs(u))
        w, b, at = _rare_value(context, slots, table_of, shift_of, b, words, at)
        before = abs(u) + abs(w)
        # A valid patch has nothing to clip; damaged ones must still give pairs that mean something.
        pairs[v, 0] = min(max(pairs[v, 0] + u, -most - 1), most)
        pairs[v, 1] = min(max(pairs[v, 1] + w, -most - 1), most)
    return a, b, at


@kernel
def colours(words, a, b, at, slots, table_of, shift_of, corners, vertices, ycc, out):
    """Fill `out`; `ycc` (n, 3) int32 is scratch. Returns (a, b, at)."""
    for v in range(len(out)):
        y = o = g = contrast = np.int64(0)
        if v < vertices and corners[v, 5] != FIRST:
            i, j = corners[v, 0], corners[v, 1]
            y = (np.int64(ycc[i, 0]) + ycc[j, 0]) >> 1
            o = (np.int64(ycc[i, 1]) + ycc[j, 1]) >> 1
            g = (np.int64(ycc[i, 2]) + ycc[j, 2]) >> 1
            contrast = abs(np.int64(ycc[i, 0]) - ycc[j, 0])
        elif v > 0:
            y, o, g = np.int64(ycc[v - 1, 0]), np.int64(ycc[v - 1, 1]), np.int64(ycc[v - 1, 2])
        r, a, at = _rare_value(COLOUR_AT + small_scale(contrast), slots, table_of, shift_of, a, words, at)
        context = COLOUR_AT + SMALL_SCALES + small_scale(abs(r))
        s, b, at = _rare_value(context, slots, table_of, shift_of, b, words, at)
        context = COLOUR_AT + 2 * SMALL_SCALES + small_scale(abs(s) + (abs(r) >> 1))
        q, a, at = _rare_value(context, slots, table_of, shift_of, a, words, at)
        y, o, g = wrap(y + r), wrap(o + s), wrap(g + q)
        ycc[v, 0], ycc[v, 1], ycc[v, 2] = y, o, g
        middle = y - (g >> 1)
        blue = middle - (o >> 1)
        out[v, 0] = (blue + o) & 255
        out[v, 1] = (middle + g) & 255
        out[v, 2] = blue & 255
    return a, b, at
