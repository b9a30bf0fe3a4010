# mypy: allow-untyped-defs, allow-untyped-calls
"""Limits and normals of vertices of a √3 refinement, from their rings on the level of their birth.

They are asked for only when a face at the vertex is to be split, which two in three vertices never see.
"""

import math

import numpy as np

from foveal.base.jit import kernel

from ._kernels_sqrt3_layout import INSIDE, LATE, NONE, UNMEASURED, generation, half
from ._kernels_sqrt3_points import THIRD, near_point, position, virtual_apex

HALF_ROOT3 = 0.8660254037844386
COSINES = (1.0, 0.5, -0.5, -1.0, -0.5, 0.5)
SINES = (0.0, HALF_ROOT3, HALF_ROOT3, 0.0, -HALF_ROOT3, -HALF_ROOT3)

#: (4 - 2 cos(2 pi / n)) / 9 for n = 3, 4, 5: written out, since cosines differ between machines.
LATE_SHARES = (0.0, 0.0, 0.0, 5.0 / 9.0, 4.0 / 9.0, 0.3757740012500117)


@kernel
def measure_corners(net, f):
    """Measure the corners born with the face f, before it is split: then their rings are still at hand."""
    level = generation(net.states[f])
    for k in range(3):
        v = np.int64(net.faces[f, k])
        if net.births[v] == level and net.kinds[v] == UNMEASURED:
            measure(net, v)


@kernel
def part_at(net, v, u):
    """The face at v in which u follows v: the half of v's birth face from u, or its flipped part there."""
    f = np.int64(net.around[v])
    for _ in range(6):
        k = 0 if net.faces[f, 0] == v else (1 if net.faces[f, 1] == v else 2)
        if net.faces[f, (k + 1) % 3] == u:
            return f
        f = np.int64(net.beside[f, (k + 2) % 3])
    return f


@kernel
def measure(net, b):
    """The limit and normal of vertex b, none of whose faces is finer than itself; on a border it is LATE."""
    level = net.births[b]
    ring = np.empty((6, 3))
    ids, ends = np.empty(6, np.int64), np.empty(6, np.int64)  # of the border edge that follows, or NONE
    n = 0
    for i in range(3):
        u = np.int64(net.triples[b, i])
        x, y, z = position(net, u, level)
        ring[n, 0], ring[n, 1], ring[n, 2] = x, y, z
        ids[n], ends[n] = u, NONE
        n += 1
        # What begins at u around b: the half (u, next, b), its flipped face (u, apex, b), or a border's face.
        part = part_at(net, b, u)
        if net.states[part] == half(level - 1):
            x, y, z = virtual_apex(net, part)
        elif (
            net.beside[part, 0] == NONE
            and net.faces[part, 2] == b
            and net.births[net.faces[part, 1]] != level
        ):
            ends[n - 1] = net.faces[part, 1]
            continue
        else:
            c = net.faces[part, 1]
            x, y, z = net.points[c, 0, 0], net.points[c, 0, 1], net.points[c, 0, 2]
        ring[n, 0], ring[n, 1], ring[n, 2] = x, y, z
        ends[n] = NONE
        n += 1
    net.kinds[b] = INSIDE
    if n == 6:
        for axis in range(3):
            total = 0.0
            for i in range(6):
                total += ring[i, axis]
            net.points[b, 1, axis] = 0.5 * (net.points[b, 0, axis] + total / 6.0)
        ring_normal(net, b, ring)
        return
    net.kinds[b] = LATE
    share = LATE_SHARES[n]
    for axis in range(3):
        total = 0.0
        for i in range(n):
            total += ring[i, axis]
        net.points[b, 2, axis] = (1.0 - share) * net.points[b, 0, axis] + share * total / n
    later = np.empty((6, 3))
    m = 0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        if ends[i] != NONE:  # a border edge follows
            for is_first in (True, False):
                x, y, z = near_point(net, ids[i], ends[i], level, is_first)
                later[m, 0], later[m, 1], later[m, 2] = x, y, z
                m += 1
        else:
            for axis in range(3):
                later[m, axis] = (net.points[b, 0, axis] + ring[i, axis] + ring[j, axis]) * THIRD
            m += 1
    for axis in range(3):
        total = 0.0
        for i in range(6):
            total += later[i, axis]
        net.points[b, 1, axis] = 0.5 * (net.points[b, 2, axis] + total / 6.0)
    ring_normal(net, b, later)


@kernel
def ring_normal(net, v, ring):
    """The normal of the limit surface at a vertex of valence six, by its ring's tangents."""
    sx = sy = sz = tx = ty = tz = 0.0
    for i in range(6):
        c, s = COSINES[i], SINES[i]
        sx, sy, sz = sx + c * ring[i, 0], sy + c * ring[i, 1], sz + c * ring[i, 2]
        tx, ty, tz = tx + s * ring[i, 0], ty + s * ring[i, 1], tz + s * ring[i, 2]
    x, y, z = sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / length if length > 0.0 else 0.0
    net.normals[v, 0], net.normals[v, 1], net.normals[v, 2] = x * scale, y * scale, z * scale
