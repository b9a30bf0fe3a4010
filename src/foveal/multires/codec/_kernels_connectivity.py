# mypy: allow-untyped-defs, allow-untyped-calls
"""Connectivity, the encoder's side: which triangles are neighbours, and growing a region over them."""

import math

import numpy as np

from foveal.base.jit import inlined, kernel

from ._kernels_layout import (
    AT_DEAD,
    BOUNDARY,
    DEAD_CONTEXTS,
    END,
    FIRST,
    FOLLOWED_NEW,
    FOLLOWED_OTHER,
    FOLLOWED_RIGHT,
    FOLLOWED_RIGHTS,
    FRESH,
    FRESH_RIGHT,
    HEAD_DEGREES,
    LAST_CODES,
    LEFT,
    MET,
    NEW,
    RIGHT,
    SPLIT,
    SPLIT_NEXT,
    SPLIT_PREVIOUS,
    START,
    TAIL_DEGREES,
    WALK_FAR,
    WALK_NEXT,
    WALK_PREVIOUS,
)

FREE, LIVE, DEAD = 0, 1, 2
_MOST_SHEETS = 16  # triangles at an edge that one is compared with
_MOST_TURNS = 256  # triangles looked at around a vertex to find it on the front


@kernel
def sort_edges(faces, starts, keys):
    """Sort half-edges 3 t + k by their two ends: a counting sort by the lesser, shell sorts by the greater.

    keys[starts[v]:starts[v + 1]] = greater end << 32 | half-edge << 1 | (runs from the greater end), for
    the half-edges whose lesser end is v; starts has two more than the vertices. Triangles that name a
    vertex twice are left out.
    """
    starts[:] = 0
    for t in range(len(faces)):
        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
        if a != b and b != c and c != a:
            starts[min(a, b) + 2] += 1
            starts[min(b, c) + 2] += 1
            starts[min(c, a) + 2] += 1
    for v in range(2, len(starts)):
        starts[v] += starts[v - 1]
    for t in range(len(faces)):
        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
        if a != b and b != c and c != a:
            for k in range(3):
                low, high = min(a, b), max(a, b)
                keys[starts[low + 1]] = np.int64(high) << 32 | (3 * t + k) << 1 | (a > b)
                starts[low + 1] += 1
                a, b, c = b, c, a
    for v in range(len(starts) - 2):
        begin, end = starts[v], starts[v + 1]
        gap = 1
        while 3 * gap < end - begin:
            gap = 3 * gap + 1
        while gap > 0:
            for i in range(begin + gap, end):
                key = keys[i]
                j = i - gap
                while j >= begin and keys[j] > key:
                    keys[j + gap] = keys[j]
                    j -= gap
                keys[j + gap] = key
            gap //= 3


@kernel
def _crease(positions, faces, s, t):
    """Cosine of the angle between the normals of triangles s and t; -2 where one has none."""
    total = 0.0
    lengths = 1.0
    u0 = u1 = u2 = 0.0
    for turn in range(2):
        face = s if turn == 0 else t
        a, b, c = faces[face, 0], faces[face, 1], faces[face, 2]
        x = float(positions[b, 0]) - positions[a, 0]
        y = float(positions[b, 1]) - positions[a, 1]
        z = float(positions[b, 2]) - positions[a, 2]
        p = float(positions[c, 0]) - positions[a, 0]
        q = float(positions[c, 1]) - positions[a, 1]
        r = float(positions[c, 2]) - positions[a, 2]
        n0, n1, n2 = y * r - z * q, z * p - x * r, x * q - y * p
        lengths *= math.sqrt(n0 * n0 + n1 * n1 + n2 * n2)
        total = u0 * n0 + u1 * n1 + u2 * n2
        u0, u1, u2 = n0, n1, n2
    return total / lengths if lengths > 0 else -2.0


@kernel
def pair_edges(positions, faces, starts, keys, twin):
    """twin[h] = the half-edge on the other side of h, or -1 at a boundary.

    Where more than two triangles share an edge, those that continue each other most smoothly are
    paired: both sides of two sheets that touch keep their neighbour, instead of all losing it.
    """
    twin[:] = -1
    for v in range(len(starts) - 2):
        i, last = starts[v], starts[v + 1]
        while i < last:
            j = i + 1
            while j < last and keys[j] >> 32 == keys[i] >> 32:
                j += 1
            for x in range(i, j):
                h = (keys[x] & 0xFFFFFFFF) >> 1
                if twin[h] >= 0:
                    continue
                best, best_cosine = -1, -3.0
                for y in range(x + 1, min(j, x + _MOST_SHEETS)):
                    other = (keys[y] & 0xFFFFFFFF) >> 1
                    if twin[other] >= 0 or (keys[x] ^ keys[y]) & 1 == 0:
                        continue
                    cosine = 0.0 if j - i == 2 else _crease(positions, faces, h // 3, other // 3)
                    if cosine > best_cosine:
                        best, best_cosine = other, cosine
                if best >= 0:
                    twin[h] = best
                    twin[best] = h
            i = j


@inlined
def code_context(head, tail, last, next_dead, previous_dead):
    """Which statistics the next code has, from the degrees so far at both ends of the gate."""
    h = min(max(head, 1), HEAD_DEGREES) - 1
    if next_dead or previous_dead:
        return DEAD_CONTEXTS + h * 3 + next_dead + 2 * previous_dead - 1
    return (h * TAIL_DEGREES + min(max(tail, 1), TAIL_DEGREES) - 1) * LAST_CODES + last


@inlined
def kind_after(kind, code):
    """The kind of the newest vertex once the code after it, or the one after that, is known."""
    if kind == FRESH:
        if code == NEW:
            return FOLLOWED_NEW
        if code == RIGHT:
            return FRESH_RIGHT
        return FOLLOWED_RIGHT if code == END else FOLLOWED_OTHER
    if kind == FRESH_RIGHT:
        return FOLLOWED_RIGHTS if (code == RIGHT) | (code == END) else FOLLOWED_RIGHT
    return kind


@kernel
def _occurrence(twin, done, state, half_edge, slot_of, following, leaving, arriving):
    """The slot of the front that starts at the corner of a new triangle, -1 if it is not on the front.

    `leaving` and `arriving` are the triangle's half-edges v -> b and a -> v. Turns around v through
    triangles yet to come, both ways, to the front edges that bound this gap.
    """
    h = twin[arriving]  # v -> a
    for _ in range(_MOST_TURNS):
        if h < 0:
            break
        t = h // 3
        if done[t]:
            s = slot_of[h]
            if s >= 0 and state[s] == LIVE and half_edge[s] == h:
                return s
            break
        h = twin[3 * t + (h - 3 * t + 2) % 3]
    h = twin[leaving]  # b -> v
    for _ in range(_MOST_TURNS):
        if h < 0:
            break
        t = h // 3
        if done[t]:
            s = slot_of[h]
            if s >= 0 and state[s] == LIVE and half_edge[s] == h:
                return following[s]
            break
        h = twin[3 * t + (h - 3 * t + 1) % 3]
    return -1


@kernel
def _walk(following, previous, gate, slot):
    """How `slot` is reached from the gate: 0-15 is 4 to 19 steps on, 16-30 is 1 to 15 back, 31 is far."""
    s = following[following[following[gate]]]
    for i in range(WALK_NEXT):
        s = following[s]
        if s == slot:
            return i
    s = gate
    for i in range(WALK_PREVIOUS):
        s = previous[s]
        if s == slot:
            return WALK_NEXT + i
    return WALK_FAR


@kernel
def grow(
    faces,
    twin,
    done,
    index,
    degree,
    slots,
    state,
    slot_of,
    stack,
    codes,
    contexts,
    extra,
    order,
    corners,
    is_edge,
):
    """Grow over all triangles and write down how.

    Scratch, cleared by the caller: done (m), index (n, filled with -1), degree (n), slots (s, 5) int32,
    state (s), slot_of (3 m, filled with -1), stack (s), with s = 3 m + 4. Out: codes and contexts (one a
    step), extra (numbers that belong to codes), order (the given index of each coded vertex), corners
    (a, b, o, n, p and the kind of each coded vertex in coded indices, see `_kernels_geometry.predict`),
    is_edge (n, cleared: the ends of edges coded as boundary).
    Returns (codes, extras, vertices).
    """
    following, previous, origin, opposite = slots[:, 0], slots[:, 1], slots[:, 2], slots[:, 3]
    half_edge = slots[:, 4]
    count = extras = vertices = used = top = 0
    kind = FIRST
    for start in range(len(faces)):
        if done[start]:
            continue
        done[start] = 1
        codes[count] = START
        count += 1
        if vertices > 0:
            corners[vertices - 1, 5] = kind = kind_after(kind, START)
        pattern_at = extras
        extra[pattern_at] = 0
        extras += 1
        for k in range(3):
            v = faces[start, k]
            if index[v] < 0:
                index[v] = vertices
                order[vertices] = v
                corners[vertices, 5] = kind = FIRST
                vertices += 1
                extra[pattern_at] |= 1 << k
            else:
                extra[extras] = vertices - 1 - index[v]
                extras += 1
            s = used + k
            following[s] = used + (k + 1) % 3
            previous[s] = used + (k + 2) % 3
            origin[s] = v
            opposite[s] = faces[start, (k + 2) % 3]
            half_edge[s] = 3 * start + k
            slot_of[3 * start + k] = s
            state[s] = LIVE
            degree[v] += 1
        gate = used
        used += 3
        last = START
        while gate >= 0:
            nxt, prv = following[gate], previous[gate]
            a, b = origin[gate], origin[nxt]
            contexts[count] = code_context(
                degree[b], degree[a], last, int(state[nxt] == DEAD), int(state[prv] == DEAD)
            )
            h = twin[half_edge[gate]]
            t = h // 3
            if h < 0 or done[t]:
                last = BOUNDARY
                is_edge[a] = is_edge[b] = 1
                corners[vertices - 1, 5] = kind = kind_after(kind, last)
                codes[count] = last
                count += 1
                gate = close_edge(following, previous, state, gate)
                while gate < 0 and top > 0:
                    top -= 1
                    if state[stack[top]] == LIVE:
                        gate = stack[top]
                continue
            k = h - 3 * t
            done[t] = 1
            v = faces[t, (k + 2) % 3]
            arriving, leaving = 3 * t + (k + 1) % 3, 3 * t + (k + 2) % 3  # a -> v, v -> b
            degree[a] += 1
            degree[b] += 1
            degree[v] += 1
            is_right = nxt != gate and state[nxt] == LIVE and twin[leaving] == half_edge[nxt]
            is_left = prv != gate and state[prv] == LIVE and twin[arriving] == half_edge[prv]
            if is_right and is_left and following[nxt] == prv:
                last = END
                state[gate] = state[nxt] = state[prv] = FREE
                gate = -1
                while gate < 0 and top > 0:
                    top -= 1
                    if state[stack[top]] == LIVE:
                        gate = stack[top]
            elif is_right:
                last = RIGHT
                state[nxt] = FREE
                following[gate] = following[nxt]
                previous[following[nxt]] = gate
                opposite[gate] = b
                half_edge[gate] = arriving
                slot_of[arriving] = gate
            elif is_left:
                last = LEFT
                state[gate] = FREE
                following[prv] = nxt
                previous[nxt] = prv
                opposite[prv] = a
                half_edge[prv] = leaving
                slot_of[leaving] = prv
                gate = prv
            else:
                s = used
                used += 1
                if index[v] < 0:
                    last = NEW
                    corners[vertices, 0] = index[a]
                    corners[vertices, 1] = index[b]
                    corners[vertices, 2] = index[opposite[gate]]
                    alive = state[nxt] == LIVE and nxt != gate
                    corners[vertices, 3] = index[origin[following[nxt]]] if alive else index[a]
                    corners[vertices, 4] = index[opposite[nxt]] if alive else index[a]
                    corners[vertices - 1, 5] = kind_after(kind, NEW)
                    kind = FRESH if alive else AT_DEAD
                    corners[vertices, 5] = kind
                    index[v] = vertices
                    order[vertices] = v
                    vertices += 1
                    met = -1
                else:
                    met = _occurrence(twin, done, state, half_edge, slot_of, following, leaving, arriving)
                    if met < 0 or origin[met] != v or (met == gate) | (met == nxt):
                        met = -1
                        last = MET
                        extra[extras] = vertices - 1 - index[v]
                        extras += 1
                    elif following[following[nxt]] == met:
                        last = SPLIT_NEXT
                    elif previous[prv] == met:
                        last = SPLIT_PREVIOUS
                    else:
                        last = SPLIT
                        walk = _walk(following, previous, gate, met)
                        extra[extras] = walk
                        extras += 1
                        if walk == WALK_FAR:
                            extra[extras] = s - 1 - met
                            extras += 1
                    if met >= 0:
                        stack[top] = gate
                        top += 1
                link(following, previous, gate, s, nxt, met)
                state[s] = LIVE
                origin[s] = v
                opposite[s] = a
                opposite[gate] = b
                half_edge[s], slot_of[leaving] = leaving, s
                half_edge[gate], slot_of[arriving] = arriving, gate
                gate = s
            if last != NEW:
                corners[vertices - 1, 5] = kind = kind_after(kind, last)
            codes[count] = last
            count += 1
    return count, extras, vertices


@kernel
def close_edge(following, previous, state, gate):
    """Mark the gate dead, merge it with dead neighbours; the next live gate of its loop, or -1.

    No two dead edges follow each other, so that stepping over a boundary is one step however long.
    """
    nxt, prv = following[gate], previous[gate]
    state[gate] = DEAD
    if prv != gate and state[prv] == DEAD:
        state[gate] = FREE
        following[prv] = nxt
        previous[nxt] = prv
        gate = prv
    if nxt != gate and state[nxt] == DEAD:
        state[nxt] = FREE
        beyond = following[nxt]
        following[gate] = beyond
        previous[beyond] = gate
        nxt = beyond
    return nxt if state[nxt] == LIVE else -1


@inlined
def link(following, previous, gate, s, nxt, met):
    """Put slot s after the gate; with `met`, a slot of the front, cut the loop there in two (or join two)."""
    following[s] = nxt
    previous[nxt] = s
    if met >= 0:
        before = previous[met]
        following[before] = s
        previous[s] = before
        following[gate] = met
        previous[met] = gate
    else:
        following[gate] = s
        previous[s] = gate
