# mypy: allow-untyped-defs, allow-untyped-calls
"""Where the vertices of uniform √3 subdivision are at every level, without subdividing.

A vertex has three vectors, `born`, `limit` and `third`, and its `kind` says which:

* INSIDE: where it was born, its limit;
* LATE (born in a face with a border edge; its ring grows on the step after): where it was born, its
  limit, where it is one level later;
* BORDER: where it was born, next - previous border vertex, previous - 2 itself + next;
* CORNER: twice where it stays.

The two sides of a seam run opposite ways, and are to agree in every bit: what is summed along a border is
summed in an order that does not say which way it runs.

Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000, with its border rule (every second step).
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_sqrt3_layout import BORDER, CORNER, LATE, generation, is_half

THIRD = 1.0 / 3.0


@lean
def position(net, v, level):
    """(x, y, z) of vertex v on a level not below its birth."""
    vertex = net.vertices[v]
    steps = level - net.births[v]
    x, y, z = vertex.born[0], vertex.born[1], vertex.born[2]
    if steps == 0:
        return x, y, z
    if vertex.kind == BORDER:
        share = 1.0
        for _ in range(steps // 2):  # the border stands still on every other step
            share *= 1.0 / 9.0
        share = (1.0 - share) / 6.0
        return x + share * vertex.third[0], y + share * vertex.third[1], z + share * vertex.third[2]
    if vertex.kind == LATE:
        x, y, z = vertex.third[0], vertex.third[1], vertex.third[2]
        steps -= 1
    shrink = net.shrinks[v] if net.births[v] == 0 else THIRD
    share = 1.0
    for _ in range(steps):
        share *= shrink
    lx, ly, lz = vertex.limit[0], vertex.limit[1], vertex.limit[2]
    return lx + share * (x - lx), ly + share * (y - ly), lz + share * (z - lz)


@lean
def border_neighbour(net, v, level, is_next):
    """(x, y, z) of the border vertex after, or before, v on a level; v as in `position`."""
    near, far = 1.0, 1.0
    for _ in range((level - net.births[v]) // 2):
        near *= THIRD
        far *= 1.0 / 9.0
    if not is_next:
        near = -near
    bend = (1.0 - far) / 6.0 + 0.5 * far
    near *= 0.5
    vertex = net.vertices[v]
    return (
        vertex.born[0] + bend * vertex.third[0] + near * vertex.limit[0],
        vertex.born[1] + bend * vertex.third[1] + near * vertex.limit[1],
        vertex.born[2] + bend * vertex.third[2] + near * vertex.limit[2],
    )


@lean
def near_point(net, a, b, level, is_first):
    """The new point near a (is_first), or near b, of the border edge a, b that is cut on an odd level."""
    v, w = (a, b) if is_first else (b, a)
    vx, vy, vz = position(net, v, level)
    wx, wy, wz = position(net, w, level)
    if net.vertices[v].kind == CORNER:  # as if the edge went straight on beyond it
        return (vx + vx + wx) * THIRD, (vy + vy + wy) * THIRD, (vz + vz + wz) * THIRD
    x, y, z = border_neighbour(net, v, level, not is_first)
    return (
        (x + 16.0 * vx + 10.0 * wx) / 27.0,
        (y + 16.0 * vy + 10.0 * wy) / 27.0,
        (z + 16.0 * vz + 10.0 * wz) / 27.0,
    )


@lean
def middle(net, f, level):
    """(x, y, z): the barycentre of face f on its level; the face's first corner is first in the sum."""
    ax, ay, az = position(net, net.faces[f].corners[0], level)
    bx, by, bz = position(net, net.faces[f].corners[1], level)
    cx, cy, cz = position(net, net.faces[f].corners[2], level)
    return (ax + bx + cx) * THIRD, (ay + by + cy) * THIRD, (az + bz + cz) * THIRD


@lean
def virtual_apex(net, h):
    """(x, y, z) of the vertex that would face half h, of generation k, once its mate is split.

    The mate is a face of generation k, or would be: then the half of generation k - 1 that is there instead
    has a virtual apex of its own, and so on. (A loop and not a recursion: Numba's cache crashes on those.)
    """
    last, n, depth = h, np.int64(net.faces[h].beside[0]), 0
    while is_half(net.faces[n].state):
        last, n = n, np.int64(net.faces[n].beside[0])
        depth += 1
    x, y, z = apex_in_face(net, last, n)
    for i in range(depth - 1, -1, -1):
        mate, before = np.int64(net.faces[h].beside[0]), h
        for _ in range(i):
            before, mate = mate, np.int64(net.faces[mate].beside[0])
        x, y, z = apex_in_half(net, before, mate, x, y, z)
    return x, y, z


@lean
def apex_in_face(net, h, n):
    """The virtual apex of half h, whose mate is the face n."""
    level = generation(net.faces[h].state)
    if level % 2 == 1 and net.faces[n].beside[0] < 0:  # it will be cut at its border, its edge 0
        is_first = (
            net.faces[n].corners[2] == net.faces[h].corners[1]
        )  # beside its edge 2, which ends at the border's first
        return near_point(net, net.faces[n].corners[0], net.faces[n].corners[1], level, is_first)
    return middle(net, n, level)


@lean
def apex_in_half(net, h, n, dx, dy, dz):
    """The virtual apex of half h; in place of its mate is half n, whose own virtual apex is d.

    The two faces that n is to be part of are (first vertex, d, new vertex), (second vertex, new vertex, d).
    """
    level = generation(net.faces[h].state)
    is_first = (
        net.faces[n].corners[2] == net.faces[h].corners[1]
    )  # beside its edge 2, from the new vertex to the first
    v, c = net.faces[n].corners[0] if is_first else net.faces[n].corners[1], net.faces[n].corners[2]
    vx, vy, vz = position(net, v, level)
    cx, cy, cz = position(net, c, level)
    if is_first:
        return (vx + dx + cx) * THIRD, (vy + dy + cy) * THIRD, (vz + dz + cz) * THIRD
    return (vx + cx + dx) * THIRD, (vy + cy + dy) * THIRD, (vz + cz + dz) * THIRD
