# mypy: allow-untyped-defs, allow-untyped-calls
"""Triangles cut to what lies around a map and before the light, in homogeneous places (X, Y, Z, W)."""

from foveal.base.jit import kernel

CORNERS = 8  # of a triangle cut by five planes
GUARD = 0.25
"""How far beyond the map, in its sides, triangles are kept as they are."""


@kernel
def inside(p, plane, nearest):
    """How far a place is inside a plane: 0 before the light, 1 to 4 left, right, below and above the map."""
    if plane == 0:
        return p[3] - nearest
    if plane == 1:
        return p[0] + GUARD * p[3]
    if plane == 2:
        return (1 + GUARD) * p[3] - p[0]
    if plane == 3:
        return p[1] + GUARD * p[3]
    return (1 + GUARD) * p[3] - p[1]


@kernel
def cut(triangles, edges, nearest, next_edge, places, numbers, polygon, names, other, other_names):
    """Cut (m, 3, 4) triangles into (k, 3, 4) `places`, (k, 3) `numbers` of edges; k.

    What two triangles share is cut at the same places, to the bit. Edges that arise get numbers from
    `next_edge` on. With empty `places` it counts alone.
    """
    made = 0
    for t in range(len(triangles)):
        count = 3
        polygon[:3] = triangles[t]
        names[:3] = edges[t]
        for plane in range(5):
            kept = 0
            for i in range(count):
                j = (i + 1) % count
                a, b = inside(polygon[i], plane, nearest), inside(polygon[j], plane, nearest)
                if a >= 0:
                    other[kept] = polygon[i]
                    other_names[kept] = names[i]
                    kept += 1
                if (a >= 0) != (b >= 0):
                    between(polygon[i], polygon[j], a, b, other[kept])
                    other_names[kept] = names[i]
                    if a >= 0:  # what leads from here to where the polygon comes in again is new
                        other_names[kept] = next_edge
                        next_edge += 1
                    kept += 1
            count = kept
            for i in range(count):
                polygon[i] = other[i]
                names[i] = other_names[i]
            if count == 0:
                break
        for i in range(1, count - 1):
            if len(places) > 0:
                places[made, 0] = polygon[0]
                places[made, 1] = polygon[i]
                places[made, 2] = polygon[i + 1]
                numbers[made, 0] = names[0] if i == 1 else next_edge - 1
                numbers[made, 1] = names[i]
                numbers[made, 2] = names[count - 1] if i == count - 2 else -next_edge
            made += 1
            if i < count - 2:
                next_edge += 1
    return made


@kernel
def between(p, q, a, b, out):
    """The place on an edge where it meets a plane, from the same end whichever way the edge is run."""
    swap = False
    for k in range(4):
        if p[k] != q[k]:
            swap = p[k] > q[k]
            break
    if swap:
        for k in range(4):
            out[k] = q[k] + (p[k] - q[k]) * (b / (b - a))
    else:
        for k in range(4):
            out[k] = p[k] + (q[k] - p[k]) * (a / (a - b))


@kernel
def sort_out(seen, faces, nearest, out):
    """0 for a triangle inside all planes, 1 for one to be cut, 2 for one wholly outside one of them."""
    for t in range(len(faces)):
        out[t] = 0
        for plane in range(5):
            outside = 0
            for i in range(3):
                outside += 1 if inside(seen[faces[t, i]], plane, nearest) < 0 else 0
            if outside == 3:
                out[t] = 2
                break
            if outside > 0:
                out[t] = 1
