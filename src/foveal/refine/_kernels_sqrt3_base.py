# mypy: allow-untyped-defs, allow-untyped-calls
"""The control mesh's vertices in a √3 refinement."""

import math

from foveal.base.jit import lean

from ._kernels_sqrt3_layout import BORDER, CORNER, INSIDE
from ._kernels_turn import turn


@lean
def base_points(positions, starts, ring, is_border, is_corner, vertices, normals, shrinks):
    """The vectors and normals of the control mesh's vertices."""
    for v in range(len(positions)):
        begin, end = starts[v], starts[v + 1]
        n = end - begin
        for axis in range(3):
            vertices[v].born[axis] = vertices[v].limit[axis] = positions[v, axis]
        if n == 0:
            continue
        if is_corner[v]:
            vertices[v].kind = CORNER
        elif is_border[v]:
            vertices[v].kind = BORDER
            p, q = ring[end - 1], ring[begin]
            for axis in range(3):
                vertices[v].limit[axis] = positions[q, axis] - positions[p, axis]
                vertices[v].third[axis] = positions[p, axis] + positions[q, axis] - 2.0 * positions[v, axis]
        else:
            vertices[v].kind = INSIDE
            share = (4.0 - 2.0 * turn(1, n)[0]) / 9.0
            shrinks[v] = 2.0 / 3.0 - share
            for axis in range(3):
                total = 0.0
                for i in range(begin, end):
                    total += positions[ring[i], axis]
                vertices[v].limit[axis] = (positions[v, axis] + 3.0 * share * total / n) / (1.0 + 3.0 * share)
        sx = sy = sz = tx = ty = tz = 0.0
        if is_border[v]:  # a fan's mean normal: the limit's tangent across the border is not known
            for i in range(begin, end - 1):
                a, b = ring[i], ring[i + 1]
                ux, uy, uz = (
                    positions[a, 0] - positions[v, 0],
                    positions[a, 1] - positions[v, 1],
                    positions[a, 2] - positions[v, 2],
                )
                wx, wy, wz = (
                    positions[b, 0] - positions[v, 0],
                    positions[b, 1] - positions[v, 1],
                    positions[b, 2] - positions[v, 2],
                )
                sx, sy, sz = sx + uy * wz - uz * wy, sy + uz * wx - ux * wz, sz + ux * wy - uy * wx
            x, y, z = sx, sy, sz
        else:
            for i in range(n):
                c, s = turn(i, n)
                r = ring[begin + i]
                sx, sy, sz = sx + c * positions[r, 0], sy + c * positions[r, 1], sz + c * positions[r, 2]
                tx, ty, tz = tx + s * positions[r, 0], ty + s * positions[r, 1], tz + s * positions[r, 2]
            x, y, z = sy * tz - sz * ty, sz * tx - sx * tz, sx * ty - sy * tx
        length = math.sqrt(x * x + y * y + z * z)
        scale = 1.0 / length if length > 0.0 else 0.0
        normals[v, 0], normals[v, 1], normals[v, 2] = x * scale, y * scale, z * scale
