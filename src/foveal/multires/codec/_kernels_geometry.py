# mypy: allow-untyped-defs, allow-untyped-calls
"""What encoder and decoder both compute: predictions and contexts. Integers, but for one exact rounding."""

import math

import numpy as np

from foveal.base.jit import inlined, kernel

from ._kernels_layout import (
    DEGREES,
    FOLLOWED_OTHER,
    FOLLOWED_RIGHT,
    FRESH,
    FRESH_RIGHT,
    LEAST_DEGREE,
    SCALES,
    WEIGHT_BITS,
)


def _scale_table(size):
    x = np.arange(1, size + 1)
    exponent = np.array([int(i).bit_length() - 1 for i in x])
    half = np.where(exponent > 0, (x >> np.maximum(exponent - 1, 0)) & 1, 0)
    return (2 * exponent + half).astype(np.int64)


_SMALL = 4096
_SCALE = _scale_table(_SMALL)


@inlined
def scale(length):
    """The class of a length >= 0: two an octave of length + 1, at most SCALES - 1."""
    more = 0
    x = length
    while x >= _SMALL:
        x = ((x + 1) >> 1) - 1
        more += 2
    return min(_SCALE[x] + more, SCALES - 1)


@inlined
def wrap(x):
    """x modulo 2^32, in [-2^31, 2^31)."""
    return ((x + 0x80000000) & 0xFFFFFFFF) - 0x80000000


@inlined
def settled(kind):
    """The kind of a vertex after which nothing came to decide it."""
    if kind == FRESH:
        return FOLLOWED_OTHER
    return FOLLOWED_RIGHT if kind == FRESH_RIGHT else kind


@inlined
def degree_class(degree):
    return min(max(degree - LEAST_DEGREE, 0), DEGREES - 1)


@inlined
def predict(positions, degree, v, corner, weights):
    """Where vertex v is expected, the plane it should lie in, and how large the triangles are here.

    corner = (a, b, o, n, p, kind): v comes with the triangle (b, a, v) on the far side of the edge a -> b
    of the triangle with the opposite vertex o; n is the vertex after b on the front and p the opposite
    vertex of the edge b -> n. Returns (x, y, z, cx, cy, cz, size): the prediction, a normal, a length.
    """
    a, b, o, n, p = corner[0], corner[1], corner[2], corner[3], corner[4]
    kind = settled(corner[5])
    row = (kind * DEGREES + degree_class(degree[a])) * DEGREES + degree_class(degree[b])
    w = weights[row * DEGREES + degree_class(degree[v])]
    ax, ay, az = np.int64(positions[a, 0]), np.int64(positions[a, 1]), np.int64(positions[a, 2])
    bx, by, bz = positions[b, 0] - ax, positions[b, 1] - ay, positions[b, 2] - az
    ox, oy, oz = positions[o, 0] - ax, positions[o, 1] - ay, positions[o, 2] - az
    nx, ny, nz = positions[n, 0] - ax, positions[n, 1] - ay, positions[n, 2] - az
    px, py, pz = positions[p, 0] - ax, positions[p, 1] - ay, positions[p, 2] - az
    half = 1 << (WEIGHT_BITS - 1)
    x = ax + ((w[0] * bx + w[1] * ox + w[2] * nx + w[3] * px + half) >> WEIGHT_BITS)
    y = ay + ((w[0] * by + w[1] * oy + w[2] * ny + w[3] * py + half) >> WEIGHT_BITS)
    z = az + ((w[0] * bz + w[1] * oz + w[2] * nz + w[3] * pz + half) >> WEIGHT_BITS)
    size = abs(bx) + abs(by) + abs(bz) + abs(ox) + abs(oy) + abs(oz)
    nx, ny, nz = nx - bx, ny - by, nz - bz
    px, py, pz = px - bx, py - by, pz - bz
    cx = by * oz - bz * oy + ny * pz - nz * py
    cy = bz * ox - bx * oz + nz * px - nx * pz
    cz = bx * oy - by * ox + nx * py - ny * px
    return x, y, z, cx, cy, cz, size


@inlined
def frame(cx, cy, cz):
    """The axis k across a surface with normal c (the first with the greatest part), then i, j after it.

    Returns (k, u, v, w): the axis, and the normal's parts on axes i, j, k. Written as choices, not
    branches: which axis it is cannot be foreseen.
    """
    fx, fy, fz = float(cx), float(cy), float(cz)
    x, y, z = abs(fx), abs(fy), abs(fz)
    is_x = (x >= y) & (x >= z)
    is_y = (y >= z) & (not is_x)
    k = 0 if is_x else (1 if is_y else 2)
    u = fy if is_x else (fz if is_y else fx)
    v = fz if is_x else (fx if is_y else fy)
    w = fx if is_x else (fy if is_y else fz)
    return k, u, v, w


@inlined
def across(u, v, w, along, aside):
    """How far a plane with normal (u, v, w) leads across for steps along and aside, rounded."""
    if w == 0.0:
        return 0
    return math.floor(0.5 - (u * along + v * aside) / w)


@kernel
def vertex_normals(positions, faces, sums):
    """sums[v] = the sum of the cross products of the triangles at v, modulo 2^64."""
    sums[:] = 0
    for t in range(len(faces)):
        a, b, c = faces[t, 0], faces[t, 1], faces[t, 2]
        x = np.int64(positions[b, 0]) - positions[a, 0]
        y = np.int64(positions[b, 1]) - positions[a, 1]
        z = np.int64(positions[b, 2]) - positions[a, 2]
        p = np.int64(positions[c, 0]) - positions[a, 0]
        q = np.int64(positions[c, 1]) - positions[a, 1]
        r = np.int64(positions[c, 2]) - positions[a, 2]
        cx, cy, cz = y * r - z * q, z * p - x * r, x * q - y * p
        for k in range(3):
            v = faces[t, k]
            sums[v, 0] += cx
            sums[v, 1] += cy
            sums[v, 2] += cz


@kernel
def octahedral(x, y, z, most):
    """The octahedral pair of a sum of cross products; (-most - 1, -most - 1) where it is zero."""
    while max(abs(x), abs(y), abs(z)) >= 1 << 40 or min(x, y, z) < -(1 << 40):
        x, y, z = x >> 8, y >> 8, z >> 8
    total = abs(x) + abs(y) + abs(z)
    if total == 0:
        return -most - 1, -most - 1
    u = (2 * most * x + total) // (2 * total)
    v = (2 * most * y + total) // (2 * total)
    if z < 0:
        s = most - abs(v)
        t = most - abs(u)
        u, v = s if x >= 0 else -s, t if y >= 0 else -t
    return u, v


@kernel
def predicted_octahedral(sums, most, out):
    for v in range(len(sums)):
        out[v, 0], out[v, 1] = octahedral(sums[v, 0], sums[v, 1], sums[v, 2], most)
