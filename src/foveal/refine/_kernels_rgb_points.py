# mypy: allow-untyped-defs, allow-untyped-calls
"""Where the vertices of uniform subdivision are at every level, without subdividing.

Of each vertex two points are kept: where it was born, and its limit. In between it comes nearer to its limit
by the same factor with each level. Both are computed from vertices of coarser levels and, for the limit, from
those born with it around it; those that are not in the mesh are computed into the same slots and not
inserted. All sums are symmetric in what is to the left and the right, so they are the same to the last bit
whatever the order of operations.

As published, a stencil's vertices are split into the mesh for a time; `rgb.py` says what that would cost.

`position` and what asks for it are compiled into their callers: from nothing to a mesh took a tenth longer
else.

Based on: C. Loop. Smooth subdivision surfaces based on triangles. 1987, with its masks (not 3/(8n)).
"""

import math

import numpy as np

from foveal.base.jit import inlined, lean

from ._kernels_rgb_address import LEFT, RIGHT, at, side
from ._kernels_rgb_butterfly import butterfly_born
from ._kernels_rgb_known import ASK_BORN, ASK_LIMIT, is_known, push, push_unknown, set_born
from ._kernels_rgb_layout import BORN, BUTTERFLY, LIMIT, NONE, NORMAL, PRESENT, SCHEME, STACK

SIXTH = 1.0 / 6.0


@inlined
def position(net, v, level):
    """(x, y, z) of vertex v on a level not below its birth; what it takes is known."""
    vertex = net.vertices[v]
    x, y, z = vertex.born[0], vertex.born[1], vertex.born[2]
    steps = level - net.vertices[v].birth
    if steps == 0:
        return x, y, z
    # All but the control mesh's come a quarter as near; so the record's second line need not be read.
    share, shrink = 1.0, 0.25 if steps < level else vertex.shrink
    for _ in range(steps):
        share *= shrink
    lx, ly, lz = vertex.limit[0], vertex.limit[1], vertex.limit[2]
    return lx + share * (x - lx), ly + share * (y - ly), lz + share * (z - lz)


@lean
def diamond_of(net, v):
    """The ends and apexes of the edge v splits; the right apex is NONE at the border."""
    if net.vertices[v].flags & PRESENT:
        d = net.vertices[v].diamond
        return np.int64(d[0]), np.int64(d[1]), np.int64(d[2]), np.int64(d[3])
    face, e, c, x, y, s, step = side(net, v, LEFT)
    p, q = at(net, face, e, c, x + step, y - step), at(net, face, e, c, x - step, y + step)
    left = at(net, face, e, c + 2 * step, x - step, y - step)
    face, e, c, x, y, s, step = side(net, v, RIGHT)
    if face == NONE:
        return p, q, left, np.int64(NONE)
    step *= s
    return p, q, left, at(net, face, e, c + 2 * step, x - step, y - step)


@lean
def beside_apex(net, v, way):
    """The two vertices born with v between an apex and the ends, or NONE beyond the border."""
    face, e, c, x, y, s, step = side(net, v, way)
    if face == NONE:
        return np.int64(NONE), np.int64(NONE)
    step *= s
    return at(net, face, e, c + step, x, y - step), at(net, face, e, c + step, x - step, y)


@lean
def loop_born(net, top, v):
    """Where v is born, in an edge or a border edge; or push what of that is still unknown."""
    a, b, c, d = diamond_of(net, v)
    level = np.int64(net.vertices[v].birth) - 1
    before = top
    top = push_unknown(net, push_unknown(net, top, a, level), b, level)
    if d != NONE:
        top = push_unknown(net, push_unknown(net, top, c, level), d, level)
    if top > before:
        return top
    ax, ay, az = position(net, a, level)
    bx, by, bz = position(net, b, level)
    if d == NONE:
        set_born(net, v, 0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz))
        return top
    cx, cy, cz = position(net, c, level)
    dx, dy, dz = position(net, d, level)
    set_born(
        net,
        v,
        0.375 * (ax + bx) + 0.125 * (cx + dx),
        0.375 * (ay + by) + 0.125 * (cy + dy),
        0.375 * (az + bz) + 0.125 * (cz + dz),
    )
    return top


@lean
def loop_limit(net, top, v):
    """The limit of v, which is born; or push what of that is still unknown.

    Half itself, half its ring's mean; on a border four of itself to its two neighbours.
    """
    a, b, _, d = diamond_of(net, v)
    level = np.int64(net.vertices[v].birth)
    before = top
    top = push_unknown(net, push_unknown(net, top, a, level), b, level)
    p = q = r = t = np.int64(NONE)
    if d != NONE:
        p, q = beside_apex(net, v, LEFT)
        r, t = beside_apex(net, v, RIGHT)
        top = push_unknown(net, push_unknown(net, top, p, level), q, level)
        top = push_unknown(net, push_unknown(net, top, r, level), t, level)
    if top > before:
        return top
    ax, ay, az = position(net, a, level)
    bx, by, bz = position(net, b, level)
    x, y, z = ax + bx, ay + by, az + bz
    vertex = net.vertices[v]
    vx, vy, vz = vertex.born[0], vertex.born[1], vertex.born[2]
    net.vertices[v].flags |= LIMIT
    if d == NONE:
        vertex.limit[0] = (x + 4.0 * vx) * SIXTH
        vertex.limit[1] = (y + 4.0 * vy) * SIXTH
        vertex.limit[2] = (z + 4.0 * vz) * SIXTH
        return top
    f, g, h, i = net.vertices[p].born, net.vertices[q].born, net.vertices[r].born, net.vertices[t].born
    vertex.limit[0] = 0.5 * (vx + (x + ((f[0] + g[0]) + (h[0] + i[0]))) * SIXTH)
    vertex.limit[1] = 0.5 * (vy + (y + ((f[1] + g[1]) + (h[1] + i[1]))) * SIXTH)
    vertex.limit[2] = 0.5 * (vz + (z + ((f[2] + g[2]) + (h[2] + i[2]))) * SIXTH)
    return top


@lean
def cross(ax, ay, az, bx, by, bz):
    """The cross product."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@lean
def unit(x, y, z):
    """Of unit length, or zero."""
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / length if length > 0.0 else 0.0
    return x * scale, y * scale, z * scale


@lean
def away(ax, ay, az, bx, by, bz):
    """The squared distance."""
    return (ax - bx) * (ax - bx) + (ay - by) * (ay - by) + (az - bz) * (az - bz)


@lean
def ensure(net, v, ask):
    """Compute where v was born, or its limit, and whatever that takes."""
    is_butterfly = net.counts[SCHEME] == BUTTERFLY
    top = push(net, 0, v, ask)
    while top > 0:
        task = net.counts[STACK + top - 1]
        w, what = task >> 1, task & 1
        if net.vertices[w].flags & (LIMIT if what == ASK_LIMIT else BORN):
            top -= 1
            continue
        before = top
        if what == ASK_LIMIT and net.vertices[w].flags & BORN == 0:
            top = push(net, top, w, ASK_BORN)
            continue
        if is_butterfly:
            top = butterfly_born(net, top, w)
        elif what == ASK_LIMIT:
            top = loop_limit(net, top, w)
        else:
            top = loop_born(net, top, w)
        if top == before:  # done
            top -= 1


@inlined
def ensure_at(net, v, level):
    """Compute what it takes to say where v is on a level."""
    if not is_known(net, v, level):
        ensure(net, v, ASK_BORN if net.vertices[v].birth == level else ASK_LIMIT)


@lean
def set_normal(net, v):
    """The normal of the two triangles v is born between, and how far theirs and its ends' are from it.

    Those of its ends are known.
    """
    net.vertices[v].flags |= NORMAL
    a, b, c, d = diamond_of(net, v)
    level = np.int64(net.vertices[v].birth) - 1
    for w in (a, b, c, d):  # the butterfly, and what was remembered of v, may have done without
        if w != NONE:
            ensure_at(net, w, level)
    ax, ay, az = position(net, a, level)
    bx, by, bz = position(net, b, level)
    cx, cy, cz = position(net, c, level)
    ux, uy, uz = bx - ax, by - ay, bz - az
    lx, ly, lz = cross(ux, uy, uz, cx - 0.5 * (ax + bx), cy - 0.5 * (ay + by), cz - 0.5 * (az + bz))
    lx, ly, lz = unit(lx, ly, lz)
    rx, ry, rz = lx, ly, lz
    if d != NONE:
        dx, dy, dz = position(net, d, level)
        rx, ry, rz = cross(ux, uy, uz, 0.5 * (ax + bx) - dx, 0.5 * (ay + by) - dy, 0.5 * (az + bz) - dz)
        rx, ry, rz = unit(rx, ry, rz)
    x, y, z = unit(lx + rx, ly + ry, lz + rz)
    vertex = net.vertices[v]
    vertex.normal[0], vertex.normal[1], vertex.normal[2] = x, y, z
    far = max(away(lx, ly, lz, x, y, z), away(rx, ry, rz, x, y, z))
    n, m = net.vertices[a].normal, net.vertices[b].normal
    far = max(far, max(away(n[0], n[1], n[2], x, y, z), away(m[0], m[1], m[2], x, y, z)))
    vertex.spread = math.sqrt(far)
