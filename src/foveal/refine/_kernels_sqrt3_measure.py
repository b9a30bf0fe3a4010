# mypy: allow-untyped-defs, allow-untyped-calls
"""Limits and normals of vertices of a √3 refinement, from their rings on the level of their birth.

They are asked for only when a face at the vertex is to be split, which two in three vertices never see.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_sqrt3_layout import INSIDE, LATE, NONE, UNMEASURED, corner_at, generation, half
from ._kernels_sqrt3_points import THIRD, near_point, position, virtual_apex

HALF_ROOT3 = 0.8660254037844386

#: (cos, sin) of the sixths of a turn.
SIXTHS = np.array(
    [
        (1.0, 0.0),
        (0.5, HALF_ROOT3),
        (-0.5, HALF_ROOT3),
        (-1.0, 0.0),
        (-0.5, -HALF_ROOT3),
        (0.5, -HALF_ROOT3),
    ]
)

#: (4 - 2 cos(2 pi / n)) / 9 for n = 3, 4, 5: written out, since cosines differ between machines.
LATE_SHARES = np.array([0.0, 0.0, 0.0, 5.0 / 9.0, 4.0 / 9.0, 0.3757740012500117])

#: Nothing gathered yet; see `gather`.
NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@lean
def measure_corners(net, f):
    """Measure the corners born with the face f, before it is split: then their rings are still at hand."""
    level = generation(net.faces[f].state)
    for k in range(3):
        v = np.int64(net.faces[f].corners[k])
        if net.births[v] == level and net.vertices[v].kind == UNMEASURED:
            measure(net, v)


@lean
def part_at(net, v, u):
    """The face at v in which u follows v: the half of v's birth face from u, or its flipped part there."""
    f = np.int64(net.vertices[v].around)
    for _ in range(6):
        k = corner_at(net.faces[f], v)
        if net.faces[f].corners[(k + 1) % 3] == u:
            return f
        f = np.int64(net.faces[f].beside[(k + 2) % 3])
    return f


@lean
def beyond(net, b, u):
    """(end, x, y, z) of what follows corner u in the ring of vertex b on the level of its birth.

    What begins at u around b is the half (u, next, b), its flipped part (u, apex, b), or a border's face:
    then `end` is the next corner, else NONE.
    """
    level = net.births[b]
    f = part_at(net, b, u)
    face = net.faces[f]
    c = np.int64(face.corners[1])
    if face.state == half(level - 1):
        x, y, z = virtual_apex(net, f)
        return NONE, x, y, z
    if face.beside[0] < 0 and face.corners[2] == b and net.births[c] != level:
        return c, 0.0, 0.0, 0.0
    apex = net.vertices[c]
    return NONE, apex.born[0], apex.born[1], apex.born[2]


@lean
def gather(sums, i, x, y, z):
    """Add vertex i of a ring of six to (its sum, its two tangents)."""
    a, b, c, d, e, f, g, h, k = sums
    s, t = SIXTHS[i, 0], SIXTHS[i, 1]
    return a + x, b + y, c + z, d + s * x, e + s * y, f + s * z, g + t * x, h + t * y, k + t * z


@lean
def measure(net, b):
    """The limit and normal of vertex b, none of whose faces is finer than itself; on a border it is LATE."""
    vertex = net.vertices[b]
    level = net.births[b]
    sums = NOTHING
    borders = 0
    for i in range(3):
        u = np.int64(vertex.triple[i])
        x, y, z = position(net, u, level)
        sums = gather(sums, 2 * i, x, y, z)
        end, x, y, z = beyond(net, b, u)
        if end == NONE:
            sums = gather(sums, 2 * i + 1, x, y, z)
        else:
            borders += 1
    x, y, z = vertex.born[0], vertex.born[1], vertex.born[2]
    vertex.kind = INSIDE
    if borders > 0:
        share = LATE_SHARES[6 - borders]
        x = (1.0 - share) * x + share * sums[0] / (6 - borders)
        y = (1.0 - share) * y + share * sums[1] / (6 - borders)
        z = (1.0 - share) * z + share * sums[2] / (6 - borders)
        vertex.kind = LATE
        vertex.third[0], vertex.third[1], vertex.third[2] = x, y, z
        sums = later_ring(net, b)
    vertex.limit[0] = 0.5 * (x + sums[0] / 6.0)
    vertex.limit[1] = 0.5 * (y + sums[1] / 6.0)
    vertex.limit[2] = 0.5 * (z + sums[2] / 6.0)
    ring_normal(net, b, sums)


@lean
def later_ring(net, b):
    """What is gathered of the ring of vertex b one level after its birth, when it has grown to six."""
    vertex = net.vertices[b]
    level = net.births[b]
    bx, by, bz = vertex.born[0], vertex.born[1], vertex.born[2]
    sums = NOTHING
    for i in range(3):
        u, w = np.int64(vertex.triple[i]), np.int64(vertex.triple[(i + 1) % 3])
        end, x, y, z = beyond(net, b, u)
        if end == NONE:
            ux, uy, uz = position(net, u, level)
            wx, wy, wz = position(net, w, level)
            sums = gather(sums, 2 * i, (bx + ux + x) * THIRD, (by + uy + y) * THIRD, (bz + uz + z) * THIRD)
            sums = gather(
                sums, 2 * i + 1, (bx + x + wx) * THIRD, (by + y + wy) * THIRD, (bz + z + wz) * THIRD
            )
        else:  # a border edge follows, which is cut in three
            x, y, z = near_point(net, u, end, level, True)
            sums = gather(sums, 2 * i, x, y, z)
            x, y, z = near_point(net, u, end, level, False)
            sums = gather(sums, 2 * i + 1, x, y, z)
    return sums


@lean
def ring_normal(net, v, sums):
    """The normal of the limit surface at a vertex of valence six, by its ring's tangents."""
    _, _, _, sx, sy, sz, tx, ty, tz = sums
    x, y, z = sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / length if length > 0.0 else 0.0
    net.normals[v, 0], net.normals[v, 1], net.normals[v, 2] = x * scale, y * scale, z * scale
