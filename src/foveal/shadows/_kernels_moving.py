# mypy: allow-untyped-defs, allow-untyped-calls
"""An ordinary map of depths: the nearest triangle at the middle of each pixel, and lookups in it."""

import numpy as np

from foveal.base.jit import kernel, lean

from ._kernels_lookup_points import STEPS, place


@lean
def _volume(u, v, p, q):
    """(u, v, 1) . (p x q), of the X, Y and W of two corners."""
    return u * (p[1] * q[3] - p[3] * q[1]) + v * (p[3] * q[0] - p[0] * q[3]) + (p[0] * q[1] - p[1] * q[0])


@lean
def _span(a, b, c, axis, side):
    """First and last pixel that a triangle may meet along an axis; all where it reaches behind the light."""
    if min(a[3], b[3], c[3]) <= 0.0:
        return 0, side - 1
    low = min(a[axis] / a[3], b[axis] / b[3], c[axis] / c[3]) * side
    high = max(a[axis] / a[3], b[axis] / b[3], c[axis] / c[3]) * side
    if not (high >= 0.0 and low <= side):
        return 0, -1
    return int(max(low - 1.0, 0.0)), int(min(high + 1.0, side - 1.0))


@kernel
def draw(corners, faces, depths):
    """Draw triangles of (X, Y, Z, W) corners into a square map of steps that begins far.

    The ray of a pixel meets a triangle where the volumes that it spans with the edges have one sign, so that
    what reaches behind the light need not be clipped (Olano, Greer 1997). Edges belong to both sides: of
    equal depths it does not matter whose is kept.
    """
    side = len(depths)
    for face in range(len(faces)):
        a, b, c = corners[faces[face, 0]], corners[faces[face, 1]], corners[faces[face, 2]]
        left, right = _span(a, b, c, 0, side)
        top, bottom = _span(a, b, c, 1, side)
        for j in range(top, bottom + 1):
            v = (j + 0.5) / side
            for i in range(left, right + 1):
                u = (i + 0.5) / side
                for_a, for_b, for_c = _volume(u, v, b, c), _volume(u, v, c, a), _volume(u, v, a, b)
                if min(for_a, for_b, for_c) < 0.0 < max(for_a, for_b, for_c):
                    continue
                total = for_a + for_b + for_c
                w = (for_a * a[3] + for_b * b[3] + for_c * c[3]) / total
                if not w > 0.0:
                    continue
                z = (for_a * a[2] + for_b * b[2] + for_c * c[2]) / total
                step = np.uint32(min(max(z * STEPS, 0.0), STEPS - 1.0))
                depths[j, i] = min(depths[j, i], step)


@kernel
def darken(depths, window, radius, points, normals, shares):
    """Bring each share down to that of the map, which lights what is off it."""
    has_normals, side, samples = len(normals) > 0, len(depths), (2 * radius + 1) ** 2
    for k in range(len(points)):
        normal = normals[k] if has_normals else points[k]
        x, y, step = place(window, window.levels, radius, points[k], normal, has_normals)
        dark = 0
        for j in range(max(y - radius, 0), min(y + radius + 1, side)):
            for i in range(max(x - radius, 0), min(x + radius + 1, side)):
                dark += step > depths[j, i]
        shares[k] = min(shares[k], np.float32(1.0 - dark / samples))
