# mypy: allow-untyped-defs, allow-untyped-calls
"""The modified butterfly: an interpolating scheme over the same addresses as Loop's.

A vertex stays where it was born, which is in the middle of a stencil on the level before:

* inside, both ends of valence 6: ends 1/2, apexes 1/8, wings (beyond the diamond's sides) -1/16;
* inside, one end of another valence: 3/4 that end and the scheme's weights on its ring; two: the mean;
* on the border: -1/16, 9/16, 9/16, -1/16 along it.

Ours, since no two libraries agree: an end on the border counts as of valence 6, and a wing beyond a border
edge (p, t) of a triangle p, q, t is where its parallelogram ends: p + t - q.

Based on: D. Zorin, P. Schröder, W. Sweldens. Interpolating subdivision for meshes with arbitrary topology.
SIGGRAPH 1996, with w = 0.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_address import LEFT, RIGHT, SIDE, at, side
from ._kernels_rgb_known import push_unknown, set_born
from ._kernels_rgb_layout import LIMIT, NONE
from ._kernels_turn import turn


@lean
def spoke(net, face, k, distance):
    """The vertex at a distance from corner k of a triangle of the control mesh, on its edge k."""
    return at(net, face, k, SIDE - distance, distance, np.int64(0))


@lean
def turned(net, face, k):
    """(triangle, corner): the next one counter-clockwise around corner k; NONE beyond the border."""
    mate = np.int64(net.base[face].mates[(k + 2) % 3])
    return (np.int64(NONE), np.int64(0)) if mate == NONE else (mate // 3, mate % 3)


@lean
def valence(net, face, k):
    """Of corner k of a triangle of the control mesh; 6 on the border."""
    n, f, i = 0, face, k
    while n == 0 or f != face or i != k:
        f, i = turned(net, f, i)
        if f == NONE:
            return 6
        n += 1
    return n


@lean
def extraordinary(net, v, way):
    """(triangle, corner, valence) of the side's first end if it is extraordinary, else valence 6."""
    face, e, c, x, _, _, step = side(net, v, way)
    if face == NONE or c != 0 or x + step != SIDE:
        return np.int64(NONE), np.int64(0), 6
    k = np.int64((e + 1) % 3)
    return face, k, valence(net, face, k)


@lean
def part(net, v, way, i):
    """On a side: its first end (0), apex (1), the wings beyond the ends' edges to it (2, 3)."""
    face, e, c, x, y, s, step = side(net, v, way)
    step *= s
    if i == 0:
        return at(net, face, e, c, x + step, y - step)
    if i == 1:
        return at(net, face, e, c + 2 * step, x - step, y - step)
    if i == 2:
        return at(net, face, e, c + 2 * step, x + step, y - 3 * step)
    return at(net, face, e, c + 2 * step, x - 3 * step, y + step)


@lean
def along(net, v, is_first):
    """The border vertex before the first end, or after the second, of the border edge v splits."""
    face, e, c, x, y, _, step = side(net, v, LEFT)
    x, y = (x + 3 * step, y - 3 * step) if is_first else (x - 3 * step, y + 3 * step)
    if x <= SIDE and y <= SIDE:
        return at(net, face, e, c, x, y)
    if is_first:  # around the corner to its other border edge
        f, k = face, np.int64((e + 1) % 3)
        last, corner = f, k
        while f != NONE:
            last, corner = f, k
            f, k = turned(net, f, k)
        return at(net, last, corner, SIDE - 2 * step, np.int64(0), 2 * step)
    f, k = face, np.int64((e + 2) % 3)
    while net.base[f].mates[k] != NONE:
        mate = np.int64(net.base[f].mates[k])
        f, k = mate // 3, (mate % 3 + 1) % 3
    return spoke(net, f, k, 2 * step)


@lean
def butterfly_needs(net, top, v):
    """Push what is still unknown of the stencil of v."""
    level = np.int64(net.vertices[v].birth) - 1
    top = push_unknown(net, top, part(net, v, LEFT, 0), level)
    if side(net, v, RIGHT)[0] == NONE:
        for is_first in (True, False):
            w = along(net, v, is_first)
            top = push_unknown(net, top, w, level)
        face, e, c, x, y, _, step = side(net, v, LEFT)
        return push_unknown(net, top, at(net, face, e, c, x - step, y + step), level)
    top = push_unknown(net, top, part(net, v, RIGHT, 0), level)
    step = SIDE >> level
    for way in (LEFT, RIGHT):
        face, k, n = extraordinary(net, v, way)
        for i in range(1, 4):  # all, though an extraordinary end needs less: ends of valence 6 are the rule
            w = part(net, v, way, i)
            if w != NONE:
                top = push_unknown(net, top, w, level)
        for _ in range(n if n != 6 else 0):
            top = push_unknown(net, top, spoke(net, face, k, step), level)
            face, k = turned(net, face, k)
    return top


@lean
def ring_sum(net, face, k, n, step, axis):
    """The scheme's sum around an extraordinary end."""
    total = 0.75 * net.vertices[net.base[face].corners[k]].born[axis]
    turn_cos, turn_sin = turn(1, n)
    c, s = 1.0, 0.0
    for j in range(n):
        if n == 3:
            share = 5.0 / 12.0 if j == 0 else -1.0 / 12.0
        elif n == 4:
            share = 0.375 if j == 0 else (-0.125 if j == 2 else 0.0)
        else:
            share = (0.25 + c + 0.5 * (c * c - s * s)) / n
        total += share * net.vertices[spoke(net, face, k, step)].born[axis]
        face, k = turned(net, face, k)
        c, s = c * turn_cos - s * turn_sin, s * turn_cos + c * turn_sin
    return total


@lean
def wing_at(net, v, way, i, axis):
    """A wing's coordinate; beyond a border edge its parallelogram's."""
    w = part(net, v, way, i)
    if w != NONE:
        return net.vertices[w].born[axis]
    other = LEFT if way == RIGHT else RIGHT
    near, far = part(net, v, way, 0), part(net, v, other, 0)
    if i == 3:
        near, far = far, near
    apex = net.vertices[part(net, v, way, 1)].born[axis]
    return net.vertices[near].born[axis] + apex - net.vertices[far].born[axis]


@lean
def butterfly_at(net, v, axis):
    """One coordinate of where v is born."""
    p = net.vertices[part(net, v, LEFT, 0)].born[axis]
    if side(net, v, RIGHT)[0] == NONE:
        face, e, c, x, y, _, step = side(net, v, LEFT)
        q = net.vertices[at(net, face, e, c, x - step, y + step)].born[axis]
        before, after = (
            net.vertices[along(net, v, True)].born[axis],
            net.vertices[along(net, v, False)].born[axis],
        )
        return 0.5625 * (p + q) - 0.0625 * (before + after)
    q = net.vertices[part(net, v, RIGHT, 0)].born[axis]
    step = SIDE >> (np.int64(net.vertices[v].birth) - 1)
    face, k, n = extraordinary(net, v, LEFT)
    other, i, m = extraordinary(net, v, RIGHT)
    if n != 6 and m != 6:
        return 0.5 * (ring_sum(net, face, k, n, step, axis) + ring_sum(net, other, i, m, step, axis))
    if n != 6:
        return ring_sum(net, face, k, n, step, axis)
    if m != 6:
        return ring_sum(net, other, i, m, step, axis)
    apexes = net.vertices[part(net, v, LEFT, 1)].born[axis] + net.vertices[part(net, v, RIGHT, 1)].born[axis]
    wings = (wing_at(net, v, LEFT, 2, axis) + wing_at(net, v, LEFT, 3, axis)) + (
        wing_at(net, v, RIGHT, 2, axis) + wing_at(net, v, RIGHT, 3, axis)
    )
    return 0.5 * (p + q) + 0.125 * apexes - 0.0625 * wings


@lean
def butterfly_born(net, top, v):
    """Where v is born, which is its limit; or push what of its stencil is still unknown."""
    before = top
    top = butterfly_needs(net, top, v)
    if top > before:
        return top
    x, y, z = butterfly_at(net, v, 0), butterfly_at(net, v, 1), butterfly_at(net, v, 2)
    set_born(net, v, x, y, z)
    vertex = net.vertices[v]
    vertex.limit[0], vertex.limit[1], vertex.limit[2] = x, y, z
    net.vertices[v].flags |= LIMIT
    return top
