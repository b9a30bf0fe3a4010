# mypy: allow-untyped-defs, allow-untyped-calls
"""Normals of Loop's limit surface."""

import math

from foveal.base.jit import kernel

from ._kernels_uniform import ring_of


@kernel
def limit_normals(faces, edges, halves, positions, is_border, first, ring, normals):
    """The cross product of the limit's two tangents at each vertex, unit or zero.

    Based on: C. Loop 1987 (eigenvectors of the local subdivision matrix); on the border those of the rule
    1/2, 1/2 for edges, and not Hoppe's for another edge rule, which are off by some degrees.
    """
    for v in range(len(positions)):
        if first[v] < 0:
            normals[v, 0] = normals[v, 1] = normals[v, 2] = 0.0
            continue
        n = ring_of(faces, edges, halves, first[v], ring)
        sx = sy = sz = tx = ty = tz = 0.0
        wide = math.pi / (n - 1) if is_border[v] else 2.0 * math.pi / n
        for i in range(n):
            if is_border[v]:
                s, t = along_border(i, n), across_border(i, n, wide)
            else:
                s, t = math.cos(wide * i), math.sin(wide * i)
            x, y, z = positions[ring[i], 0], positions[ring[i], 1], positions[ring[i], 2]
            sx, sy, sz = sx + s * x, sy + s * y, sz + s * z
            tx, ty, tz = tx + t * x, ty + t * y, tz + t * z
        if is_border[v]:
            t = across_border(-1, n, wide)
            tx, ty, tz = (
                tx + t * positions[v, 0],
                ty + t * positions[v, 1],
                tz + t * positions[v, 2],
            )
        x, y, z = sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx
        length = math.sqrt(x * x + y * y + z * z)
        scale = 1.0 / length if length > 0.0 else 0.0
        normals[v, 0], normals[v, 1], normals[v, 2] = x * scale, y * scale, z * scale


@kernel
def along_border(i, n):
    """The weight of neighbour i of n in the tangent along the border, from previous to next vertex."""
    return 1.0 if i == 0 else (-1.0 if i == n - 1 else 0.0)


@kernel
def across_border(i, n, wide):
    """The weight of neighbour i of n, or of the vertex itself for -1, in the tangent from the border inwards.

    The left eigenvector of eigenvalue 3/8 + 1/4 cos(wide), `wide` being half a turn over the vertex's faces.
    """
    if n == 2:  # a single face: its other two corners, with eigenvalue 1/4
        return -2.0 if i < 0 else 1.0
    if 0 < i < n - 1:
        return math.sin(wide * i)
    cosine = math.cos(wide)
    share = 1.0 / (math.tan(0.5 * wide) * (1.0 + 2.0 * cosine))
    return -share if i < 0 else -share * cosine
