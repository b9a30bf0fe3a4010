# mypy: allow-untyped-defs, allow-untyped-calls
"""The sides of patches: their steps while sharp, and their limit points and normals.

A side is seen from its patch: e_0 is ahead, e_1 inside, e_2 behind, e_3 outside; f_i between e_i and e_i+1.
The patch beyond sees the same with e_0 and e_2, e_1 and e_3 changed, and gets the same numbers.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_slates_layout import LANES, LIMIT_SHARE, WORDS


@lean
def frame(k, n):
    """Of side k of a table of n by n: words to its first corner, from point to point, and inwards."""
    row = n * WORDS
    if k == 0:
        return row + WORDS, WORDS, row
    if k == 1:
        return row + (n - 2) * WORDS, row, -WORDS
    if k == 2:
        return (n - 2) * (row + WORDS), -WORDS, -row
    return (n - 2) * row + WORDS, -row, WORDS


@lean
def side_step(k, share, lane, a, n, b):
    """The points of side k by the crease rule, as far as `share`; the rest is what stands there."""
    p, ahead, _ = frame(k, n)
    q, onwards, _ = frame(k, 2 * n - 3)
    for i in range(n - 3):
        for x in range(3):
            here = p + i * ahead + x * LANES + lane
            there = q + (2 * i + 1) * onwards + x * LANES + lane
            middle = 0.5 * (a[here] + a[here + ahead])
            b[there] = middle if share == 1.0 else share * middle + (1.0 - share) * b[there]
            if i > 0:
                there -= onwards
                point = 0.75 * a[here] + 0.125 * (a[here - ahead] + a[here + ahead])
                b[there] = point if share == 1.0 else share * point + (1.0 - share) * b[there]


@lean
def side_rule(a, p, ahead, inside, left, mask):
    """Of one coordinate the limit point, the tangent ahead, the tangent inside.

    `left` is the side's sharpness, `mask` its row of weights while that is finite.
    """
    v, e0, e1, e2 = a[p], a[p + ahead], a[p + inside], a[p - ahead]
    f0, f1 = a[p + inside + ahead], a[p + inside - ahead]
    if left == np.inf:
        return ((e0 + e2) + 4.0 * v) / 6.0, e0 - e2, (4.0 * (e1 - v) + (f0 + f1)) - (e0 + e2)
    e3, f2, f3 = a[p - inside], a[p - inside - ahead], a[p - inside + ahead]
    along, across, diagonal = e0 + e2, e1 + e3, (f0 + f2) + (f1 + f3)
    over, inwards = (f0 + f3) - (f1 + f2), (f0 + f1) - (f2 + f3)
    if left > 0.0:
        return (
            (mask[0] * v + mask[3] * diagonal) + (mask[1] * along + mask[2] * across),
            mask[4] * (e0 - e2) + mask[5] * over,
            mask[6] * (e1 - e3) + mask[7] * inwards,
        )
    return (
        (16.0 * v + 4.0 * (along + across) + diagonal) * LIMIT_SHARE,
        4.0 * (e0 - e2) + over,
        4.0 * (e1 - e3) + inwards,
    )


@lean
def side_point(a, p, apart, ahead, inside, left, mask, is_surface, positions, normals, o):
    """Row o of positions and normals from the point at p, whose coordinates are `apart`."""
    x, ax, bx = side_rule(a, p, ahead, inside, left, mask)
    y, ay, by = side_rule(a, p + apart, ahead, inside, left, mask)
    z, az, bz = side_rule(a, p + 2 * apart, ahead, inside, left, mask)
    positions[o, 0], positions[o, 1], positions[o, 2] = x, y, z
    if is_surface:
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        length = np.sqrt(x * x + y * y + z * z)
        share = 1.0 / length if length > 0.0 else 0.0
        normals[o, 0], normals[o, 1], normals[o, 2] = x * share + 0.0, y * share + 0.0, z * share + 0.0
