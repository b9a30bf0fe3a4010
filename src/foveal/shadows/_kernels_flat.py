# mypy: allow-untyped-defs, allow-untyped-calls
"""Triangles as a light sees them: whole-number places on the map, depth as a plane.

All that decides whether a pixel is covered is done in whole numbers, so it is exact, and the same for every
tile that a pixel is looked at from.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.jit import inlined, lean

FRONT, SHEET, BACK = range(3)
"""Of a closed part and towards the light; of an open part; of a closed part and away from the light."""
STEPS = 4294967296.0


class Flat(NamedTuple):
    """Triangles over a map, each counter-clockwise and of an area above 0.

    Places are in units of which `1 << bits` are a pixel; the sample of pixel i is at
    `(i << bits) + (1 << bits - 1)`.
    """

    corners: NDArray[np.int32]  # (m, 6) x0, y0, x1, y1, x2, y2
    planes: NDArray[np.float64]  # (m, 3) `measure` at corner 0, and its change a unit along x and y
    depths: NDArray[np.int64]  # (m, 2) least and greatest step of depth of the corners
    edges: NDArray[np.int32]  # (m, 3) number of the edge after each corner, from 1, negative if run backwards
    sides: NDArray[np.uint8]  # (m,) FRONT, SHEET or BACK
    lens: NDArray[
        np.float64
    ]  # (3,) is perspective; depth = lens[1] / measure + lens[2]; else depth = measure


@inlined
def edge_at(corners, t, a, b, x, y):
    """Twice the area of a triangle's edge from corner a to b with a place: above 0 inside."""
    ax = np.int64(corners[t, 2 * a])
    ay = np.int64(corners[t, 2 * a + 1])
    bx = np.int64(corners[t, 2 * b])
    by = np.int64(corners[t, 2 * b + 1])
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax)


@inlined
def takes_ties(corners, t, a, b):
    """Whether a place right on the edge from corner a to b is inside: of two neighbours just one says so."""
    dx = np.int64(corners[t, 2 * b]) - corners[t, 2 * a]
    dy = np.int64(corners[t, 2 * b + 1]) - corners[t, 2 * a + 1]
    return dy < 0 or (dy == 0 and dx > 0)


@lean
def covers(corners, t, x, y):
    """Whether a triangle covers a place."""
    for a in range(3):
        b = (a + 1) % 3
        e = edge_at(corners, t, a, b, x, y)
        if e < 0 or (e == 0 and not takes_ties(corners, t, a, b)):
            return False
    return True


@lean
def depth_at(flat, t, x, y):
    """Step of depth of a triangle's plane at a place, kept within that of its corners.

    Every operation is monotone in x and y, rounding included: the steps at the corners of a rectangle bound
    all within, exactly.
    """
    measure = (
        flat.planes[t, 0]
        + flat.planes[t, 1] * np.float64(x - np.int64(flat.corners[t, 0]))
        + flat.planes[t, 2] * np.float64(y - np.int64(flat.corners[t, 1]))
    )
    least, greatest = flat.depths[t, 0], flat.depths[t, 1]
    if flat.lens[0] != 0:
        if not measure > 0:  # beyond the horizon of a steep plane, so beyond its own triangle
            return greatest
        measure = flat.lens[1] / measure + flat.lens[2]
    depth = measure * STEPS
    if depth <= least:
        return least
    if depth >= greatest:
        return greatest
    return np.int64(depth)


@lean
def depth_range(flat, t, x0, y0, x1, y1):
    """Least and greatest step of depth that a triangle may have within a closed rectangle."""
    a = depth_at(flat, t, x0, y0)
    b = depth_at(flat, t, x1, y0)
    c = depth_at(flat, t, x0, y1)
    d = depth_at(flat, t, x1, y1)
    return min(min(a, b), min(c, d)), max(max(a, b), max(c, d))


@lean
def meets(corners, t, x0, y0, x1, y1):
    """Whether a triangle may have a place within a closed rectangle: exact, ties included."""
    if max(corners[t, 0], max(corners[t, 2], corners[t, 4])) < x0:
        return False
    if min(corners[t, 0], min(corners[t, 2], corners[t, 4])) > x1:
        return False
    if max(corners[t, 1], max(corners[t, 3], corners[t, 5])) < y0:
        return False
    if min(corners[t, 1], min(corners[t, 3], corners[t, 5])) > y1:
        return False
    for a in range(3):
        b = (a + 1) % 3
        dx = np.int64(corners[t, 2 * b]) - corners[t, 2 * a]
        dy = np.int64(corners[t, 2 * b + 1]) - corners[t, 2 * a + 1]
        # the corner of the rectangle that lies furthest inside this edge
        x = x0 if dy > 0 else x1
        y = y1 if dx > 0 else y0
        if dx * (y - corners[t, 2 * a + 1]) - dy * (x - corners[t, 2 * a]) < 0:
            return False
    return True


@lean
def edge_meets(corners, t, a, x0, y0, x1, y1):
    """Whether the edge after corner a may have a place within a closed rectangle: exact, ties included."""
    b = (a + 1) % 3
    ax = np.int64(corners[t, 2 * a])
    ay = np.int64(corners[t, 2 * a + 1])
    bx = np.int64(corners[t, 2 * b])
    by = np.int64(corners[t, 2 * b + 1])
    if max(ax, bx) < x0 or min(ax, bx) > x1 or max(ay, by) < y0 or min(ay, by) > y1:
        return False
    dx = bx - ax
    dy = by - ay
    inside = dx * ((y1 if dx > 0 else y0) - ay) - dy * ((x0 if dy > 0 else x1) - ax)
    outside = dx * ((y0 if dx > 0 else y1) - ay) - dy * ((x1 if dy > 0 else x0) - ax)
    return inside >= 0 and outside <= 0


@lean
def lay(flat, seen, faces, edges, is_closed, wanted, is_mirrored, places):
    """Lay out triangles of homogeneous places (n, 4), those that are `wanted` and of an area; how many.

    `places` is how many there are along the side of a map. Where right, up and the way of the light are
    right-handed, `is_mirrored`, fronts are seen clockwise.
    """
    at = 0
    for t in range(len(faces)):
        if not wanted[t]:
            continue
        for k in range(3):
            p = faces[t, k]
            flat.corners[at, 2 * k] = np.int32(np.rint(seen[p, 0] / seen[p, 3] * places))
            flat.corners[at, 2 * k + 1] = np.int32(np.rint(seen[p, 1] / seen[p, 3] * places))
        a, b, c = faces[t]
        first, second, third = edges[t]
        area = edge_at(flat.corners, at, 0, 1, np.int64(flat.corners[at, 4]), np.int64(flat.corners[at, 5]))
        if area == 0:
            continue
        is_turned = area < 0
        if is_turned:
            b, c = c, b
            first, second, third = -third, -second, -first
            area = -area
            for k in range(2):
                flat.corners[at, 2 + k], flat.corners[at, 4 + k] = (
                    flat.corners[at, 4 + k],
                    flat.corners[at, 2 + k],
                )
        flat.edges[at, 0] = first
        flat.edges[at, 1] = second
        flat.edges[at, 2] = third
        depths = (step_of(seen[a, 2]), step_of(seen[b, 2]), step_of(seen[c, 2]))
        flat.depths[at, 0] = min(depths[0], min(depths[1], depths[2]))
        flat.depths[at, 1] = max(depths[0], max(depths[1], depths[2]))
        if flat.lens[0] != 0:
            lay_plane(flat, at, area, 1 / seen[a, 3], 1 / seen[b, 3], 1 / seen[c, 3])
        else:
            lay_plane(flat, at, area, seen[a, 2], seen[b, 2], seen[c, 2])
        is_front = is_turned == is_mirrored
        flat.sides[at] = SHEET if not is_closed[t] else FRONT if is_front else BACK
        at += 1
    return at


@lean
def step_of(depth):
    """The step of a depth; that of no surface is the last, which means that nothing is hit."""
    return np.int64(min(max(np.floor(depth * STEPS), 0.0), STEPS - 2))


@lean
def lay_plane(flat, t, area, a, b, c):
    """The plane through what is measured at the corners."""
    x1 = np.float64(flat.corners[t, 2]) - flat.corners[t, 0]
    y1 = np.float64(flat.corners[t, 3]) - flat.corners[t, 1]
    x2 = np.float64(flat.corners[t, 4]) - flat.corners[t, 0]
    y2 = np.float64(flat.corners[t, 5]) - flat.corners[t, 1]
    flat.planes[t, 0] = a
    flat.planes[t, 1] = ((b - a) * y2 - (c - a) * y1) / area
    flat.planes[t, 2] = ((c - a) * x1 - (b - a) * x2) / area
