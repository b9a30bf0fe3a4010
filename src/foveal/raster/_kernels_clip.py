# mypy: allow-untyped-defs, allow-untyped-calls
"""Triangles that reach behind the near plane or very far aside, cut to what can be drawn.

Neighbours stay neighbours: where an edge meets a plane is always computed from its inner end to its
outer one, so that both triangles on it get the same point, bit for bit.
"""

import numpy as np

from foveal.base.jit import kernel

from ._kernels import PLANES, place, side

MOST_CORNERS = 8  # a triangle cut by five planes


@kernel
def _cut(polygon, count, plane, near, slope, out):
    """The part of a convex polygon inside a plane (Sutherland, Hodgman 1974); returns its corners."""
    kept = 0
    for here in range(count):
        there = here + 1 if here + 1 < count else 0
        d = side(polygon[here, 0], polygon[here, 1], polygon[here, 2], plane, near, slope)
        e = side(polygon[there, 0], polygon[there, 1], polygon[there, 2], plane, near, slope)
        if d >= 0.0 and kept < MOST_CORNERS:
            for k in range(3):
                out[kept, k] = polygon[here, k]
            kept += 1
        # A plane meets a convex polygon twice. Rounding may bend one that is all but flat: hence the limit.
        if (d >= 0.0) != (e >= 0.0) and kept < MOST_CORNERS:
            inner, outer = here, there
            if d < 0.0:
                inner, outer, d, e = there, here, e, d
            t = d / (d - e)
            for k in range(3):
                out[kept, k] = polygon[inner, k] + t * (polygon[outer, k] - polygon[inner, k])
            if plane == 0:
                out[kept, 2] = near
            kept += 1
    return kept


@kernel
def clip(clipped, faces, seen, lens, slope, places, nearness, pieces, names):
    """Cut faces and split what is left into fans; returns how many pieces there are.

    Corners, eight places a face, go to `places` and `nearness`; pieces are triples of corners.
    """
    pixels_per_radian, width, height, near = lens
    now, later = np.empty((MOST_CORNERS, 3)), np.empty((MOST_CORNERS, 3))
    total = 0
    for i in range(len(clipped)):
        for k in range(3):
            for j in range(3):
                now[k, j] = seen[faces[clipped[i], k], j]
        count = 3
        for plane in range(PLANES):
            count = _cut(now, count, plane, near, slope, later)
            now, later = later, now
        first = MOST_CORNERS * i
        is_sound = True
        for k in range(count):
            x, y, depth = now[k, 0], now[k, 1], now[k, 2]
            is_sound = is_sound and place(x, y, depth, pixels_per_radian, width, height, places[first + k])
            nearness[first + k] = 1.0 / depth
        for k in range(1, count - 1):
            if is_sound:
                pieces[total, 0] = first
                pieces[total, 1] = first + k
                pieces[total, 2] = first + k + 1
                names[total] = clipped[i]
                total += 1
    return total
