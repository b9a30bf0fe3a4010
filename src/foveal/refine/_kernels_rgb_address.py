# mypy: allow-untyped-defs, allow-untyped-calls
"""Where a vertex is in uniform subdivision, and the vertex slot of each place.

A place is a triangle of the control mesh and three whole weights of its corners that sum to SIDE. Vertices on
an edge of the control mesh lie in two triangles; the lower one counts. An address is one number, which is
the same whenever and however one gets there: (triangle, weight of corner 0, weight of corner 1), or negative
for vertices of the control mesh, which come first in the order of addresses.

Around a vertex of level l, with s = SIDE / 2^l: exactly one of its weights is an even multiple of s (of the
corner that is at the apex's side); the edge it splits goes s one way along the other two, and
so on: everything a stencil asks for is some weights away, whether it is in the mesh or not.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_layout import (
    CLOCK,
    FREE_VERTEX,
    IN_USE,
    NONE,
    VERTICES,
    corner_at,
)

#: Levels at most: weights have 21 bits.
LEVELS = 20
SIDE = 1 << LEVELS
MASK = (1 << 21) - 1
#: Added to the index of a control mesh's vertex.
BASE_KEY = -(1 << 40)

EMPTY = -1


@lean
def hashed(key, mask):
    """Where to begin to look for an address."""
    x = np.uint64(key) * np.uint64(0x9E3779B97F4A7C15)
    return np.int64((x >> np.uint64(32)) & np.uint64(mask))


@lean
def find(net, key):
    """The slot of an address, or NONE."""
    if key < 0:
        return key - BASE_KEY
    table = net.table
    mask = len(table) - 1
    i = hashed(key, mask)
    while table[i] != EMPTY:
        v = np.int64(table[i])
        if net.vertices[v].key == key:
            net.vertices[v].stamp = net.counts[CLOCK]
            return v
        i = (i + 1) & mask
    return np.int64(NONE)


@lean
def enter(net, key, v):
    """Put slot v into the table."""
    mask = len(net.table) - 1
    i = hashed(key, mask)
    while net.table[i] != EMPTY:
        i = (i + 1) & mask
    net.table[i] = v


@lean
def remove(net, key):
    """Take an address out of the table: what was displaced by it moves up."""
    table = net.table
    mask = len(table) - 1
    i = hashed(key, mask)
    while net.vertices[table[i]].key != key:
        i = (i + 1) & mask
    j = i
    while True:
        j = (j + 1) & mask
        if table[j] == EMPTY:
            break
        home = hashed(net.vertices[table[j]].key, mask)
        if ((j - home) & mask) >= ((j - i) & mask):
            table[i] = table[j]
            i = j
    table[i] = EMPTY


@lean
def level_at(key):
    """The level on which the vertex of an address is born."""
    if key < 0:
        return np.int64(0)
    bits = ((key >> 21) | key) & MASK
    level = np.int64(LEVELS)
    while bits & 1 == 0 and level > 0:
        bits >>= 1
        level -= 1
    return level


@lean
def slot_of(net, key):
    """The slot of an address; a new one, with nothing known of it, where there is none."""
    v = find(net, key)
    if v != NONE:
        return v
    counts = net.counts
    v = counts[FREE_VERTEX]
    if v != NONE:
        counts[FREE_VERTEX] = net.vertices[v].diamond[0]
    else:
        v = counts[VERTICES]
        counts[VERTICES] += 1
    counts[IN_USE] += 1
    vertex = net.vertices[v]
    vertex.key = key
    vertex.stamp = counts[CLOCK]
    vertex.around = NONE
    vertex.shrink = 0.25
    net.vertices[v].birth = level_at(key)
    net.vertices[v].flags = 0
    enter(net, key, v)
    return v


@lean
def weight(w, k):
    """Of corner k."""
    return w[0] if k == 0 else (w[1] if k == 1 else w[2])


@lean
def placed(k, x, y, z):
    """The weights that are x at corner k, y at the next, z at the one after."""
    if k == 0:
        return x, y, z
    if k == 1:
        return z, x, y
    return y, z, x


@lean
def beyond(net, face, w, z):
    """(triangle, weights) of a place over the edge from corner z + 1, where the weight z is 0 or negative.

    The two triangles are unfolded; triangle NONE where there is nothing beyond.
    """
    mate = np.int64(net.base[face].mates[(z + 1) % 3])
    if mate == NONE:
        return np.int64(NONE), w
    x, y, t = weight(w, (z + 1) % 3), weight(w, (z + 2) % 3), weight(w, z)
    return mate // 3, placed(mate % 3, y + t, x + t, -t)


@lean
def address(net, face, w):
    """The one number of a place, or -1 if it is beyond the border. (No other address is -1.)"""
    for z in range(3):
        if weight(w, z) < 0:
            face, w = beyond(net, face, w, z)
            if face == NONE:
                return np.int64(-1)
            break
    for z in range(3):
        if weight(w, z) == SIDE:
            return np.int64(net.base[face].corners[z]) + BASE_KEY
    for z in range(3):
        if weight(w, z) == 0:
            other, v = beyond(net, face, w, z)
            if other != NONE and other < face:
                face, w = other, v
            break
    return (np.int64(face) << 42) | (np.int64(w[0]) << 21) | np.int64(w[1])


@lean
def place(key):
    """(triangle, weights) of an address that is not of the control mesh."""
    x, y = (key >> 21) & MASK, key & MASK
    return key >> 42, (x, y, SIDE - x - y)


@lean
def weights_in(net, v, face):
    """The weights of a vertex in a triangle that it lies in."""
    key = net.vertices[v].key
    if key < 0:
        k = corner_at(net.base[face], v)
        return placed(k, np.int64(SIDE), np.int64(0), np.int64(0))
    at, w = place(key)
    if at != face:
        for z in range(3):
            if weight(w, z) == 0:
                at, w = beyond(net, at, w, z)
                break
    return w


@lean
def middle_key(net, face, a, b):
    """The address of the middle of an edge in a triangle of the control mesh."""
    v, w = weights_in(net, a, face), weights_in(net, b, face)
    return address(net, face, ((v[0] + w[0]) >> 1, (v[1] + w[1]) >> 1, (v[2] + w[2]) >> 1))


@lean
def at(net, face, e, x, y, z):
    """The slot of the place with weights x, y, z at corners e, e + 1, e + 2, or NONE beyond the border."""
    key = address(net, face, placed(e, x, y, z))
    return np.int64(NONE) if key == -1 else slot_of(net, key)


@lean
def apex_corner(w, step):
    """Which corner is at the apex's side for a vertex with these weights: its weight is an even multiple."""
    for e in range(2):
        if (weight(w, e) // step) & 1 == 0:
            return e
    return 2


#: The two sides of the edge a vertex splits, for `side`.
LEFT, RIGHT = 1, -1


@lean
def side(net, v, way):
    """(triangle, e, weights of e, e + 1, e + 2, sign, step): how to walk to a side of the edge v splits.

    On the left, with e the apex's corner, the ends are (0, +1, -1) and (0, -1, +1), the apex (+2, -1, -1), in
    steps; on the right of an inner vertex the apex is (-2, +1, +1): all is multiplied by sign, and the ends
    change places. On the right of an edge of the control mesh it is the left in the triangle beyond.
    """
    face, w = place(net.vertices[v].key)
    step = np.int64(SIDE) >> np.int64(net.vertices[v].birth)
    e = apex_corner(w, step)
    sign = np.int64(1)
    if way == RIGHT:
        if weight(w, e) == 0:
            face, w = beyond(net, face, w, e)
            if face == NONE:
                return face, 0, sign, sign, sign, sign, step
            e = 0 if w[0] == 0 else (1 if w[1] == 0 else 2)
        else:
            sign = np.int64(-1)
    return face, e, weight(w, e), weight(w, (e + 1) % 3), weight(w, (e + 2) % 3), sign, step
