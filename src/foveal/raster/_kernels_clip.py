# mypy: allow-untyped-defs, allow-untyped-calls
"""Triangles that reach behind the near plane or very far aside, cut to what can be drawn.

Neighbours stay neighbours: where an edge meets a plane is always computed from its inner end to its
outer one, so that both triangles on it get the same point, bit for bit.
"""

import numpy as np

from foveal.base.jit import kernel

from ._kernels import place

MOST_CORNERS = 8  # a triangle cut by five planes
PLANES = 5


@kernel
def _side(corner, plane, near, slope_x, slope_y):
    """How far a point is inside one of the planes: near, left, right, bottom, top."""
    if plane == 0:
        return corner[2] - near
    if plane == 1:
        return slope_x * corner[2] + corner[0]
    if plane == 2:
        return slope_x * corner[2] - corner[0]
    if plane == 3:
        return slope_y * corner[2] + corner[1]
    return slope_y * corner[2] - corner[1]


@kernel
def _cut(polygon, count, plane, near, slope_x, slope_y, out):
    """The part of a convex polygon inside a plane (Sutherland, Hodgman 1974); returns its corners."""
    kept = 0
    for i in range(count):
        here, there = polygon[i], polygon[(i + 1) % count]
        d, e = _side(here, plane, near, slope_x, slope_y), _side(there, plane, near, slope_x, slope_y)
        if d >= 0.0:
            out[kept] = here
            kept += 1
        if (d >= 0.0 and e < 0.0) or (d < 0.0 and e >= 0.0):
            inner, outer = (here, there) if d >= 0.0 else (there, here)
            t = d / (d - e) if d >= 0.0 else e / (e - d)
            for k in range(3):
                out[kept, k] = inner[k] + t * (outer[k] - inner[k])
            if plane == 0:
                out[kept, 2] = near
            kept += 1
    return kept


@kernel
def clip(clipped, faces, seen, lens, slope_x, slope_y, places, nearness, pieces, names):
    """Cut faces and split what is left into fans; returns how many pieces there are.

    Corners, eight places a face, go to `places` and `nearness`; pieces are triples of corners.
    """
    pixels_per_radian, width, height, near = lens
    now, later = np.empty((MOST_CORNERS + 1, 3)), np.empty((MOST_CORNERS + 1, 3))
    total = 0
    for i in range(len(clipped)):
        for k in range(3):
            now[k] = seen[faces[clipped[i], k]]
        count = 3
        for plane in range(PLANES):
            count = _cut(now, count, plane, near, slope_x, slope_y, later)
            now, later = later, now
        first = MOST_CORNERS * i
        is_sound = True
        for k in range(count):
            x, y, depth = now[k]
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
