# mypy: allow-untyped-defs, allow-untyped-calls
"""What simplification and its bounds ask of triangles: who is beside whom, walls between them, distances.

A half-edge has the number 3 f + k: edge k of face f, from its corner k to corner k + 1.
"""

import math

from foveal.base.jit import lean
from foveal.mesh._kernels_area import area_vector

#: Instead of a twin: no other face is on the edge; or others are, but each is another's twin.
BORDER, CROWDED = -1, -2

#: Of a vertex with more faces than any sane one the rest is not searched: time would grow with the square,
#: and a twin that is not found costs no more than a border.
MOST = 2048


@lean
def incidence(faces, starts, counts, refs):
    """Faces around each vertex: `refs[starts[v]:starts[v] + counts[v]]`, a face once even if it repeats v."""
    counts[:] = 0
    for f in range(len(faces)):
        for k in range(3):
            counts[faces[f, k]] += 1
    total = 0
    for v in range(len(starts)):
        starts[v] = total
        total += counts[v]
        counts[v] = 0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        refs[starts[a] + counts[a]] = f
        counts[a] += 1
        if b != a:
            refs[starts[b] + counts[b]] = f
            counts[b] += 1
        if c != a and c != b:
            refs[starts[c] + counts[c]] = f
            counts[c] += 1


@lean
def twins_of(faces, starts, counts, refs, twins):
    """twins[f, k]: the half-edge beside this one, in pairs: first those that run opposite ways, by number.

    Then, where faces disagree about the outside, those that run the same way.
    """
    twins[:] = BORDER
    for f in range(len(faces)):
        for k in range(3):
            if twins[f, k] >= 0:
                continue
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            pivot = a if counts[a] < counts[b] else b
            for i in range(starts[pivot], starts[pivot] + min(counts[pivot], MOST)):
                g = refs[i]
                j = -1
                if faces[g, 0] == b and faces[g, 1] == a:
                    j = 0
                elif faces[g, 1] == b and faces[g, 2] == a:
                    j = 1
                elif faces[g, 2] == b and faces[g, 0] == a:
                    j = 2
                if j >= 0 and g != f and twins[g, j] < 0:
                    twins[f, k] = 3 * g + j
                    twins[g, j] = 3 * f + k
                    break
    for f in range(len(faces)):
        for k in range(3):
            if twins[f, k] == BORDER:
                pair_any(faces, starts, counts, refs, twins, f, k)


@lean
def pair_any(faces, starts, counts, refs, twins, f, k):
    """Give the half-edge (f, k) a twin whichever way it runs, or note that all others have one."""
    a, b = faces[f, k], faces[f, (k + 1) % 3]
    pivot = a if counts[a] < counts[b] else b
    for i in range(starts[pivot], starts[pivot] + min(counts[pivot], MOST)):
        g = refs[i]
        if g == f:
            continue
        for j in range(3):
            p, q = faces[g, j], faces[g, (j + 1) % 3]
            if (p == a and q == b) or (p == b and q == a):
                if twins[g, j] < 0:
                    twins[f, k] = 3 * g + j
                    twins[g, j] = 3 * f + k
                    return
                twins[f, k] = CROWDED


@lean
def spread(start, twins, queue):
    """Give faces with start -1 the start of a neighbour, breadth first; returns how many have one."""
    end = 0
    for f in range(len(start)):
        if start[f] >= 0:
            queue[end] = f
            end += 1
    i = 0
    while i < end:
        f = queue[i]
        i += 1
        for k in range(3):
            if twins[f, k] >= 0:
                g = twins[f, k] // 3
                if start[g] < 0:
                    start[g] = start[f]
                    queue[end] = g
                    end += 1
    return end


@lean
def fan_exit(faces, f, v, is_left):
    """The edge of face f by which a turn around its vertex v leaves it."""
    corner = 0 if faces[f, 0] == v else (1 if faces[f, 1] == v else 2)
    return (corner + 2) % 3 if is_left else corner


@lean
def unit_normal(positions, faces, f):
    """(x, y, z), zero for a face without area."""
    x, y, z = area_vector(positions, faces, f)
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / length if length > 0.0 else 0.0
    return x * scale, y * scale, z * scale


@lean
def wall_between(positions, a, b, nx, ny, nz, mx, my, mz):
    """(x, y, z, d): the plane through a, b halfway between faces of normals n and m, n's side positive."""
    mx, my, mz = nx + mx, ny + my, nz + mz
    if mx * mx + my * my + mz * mz < 0.01:  # folded back: half way is anywhere
        mx, my, mz = nx, ny, nz
    ex, ey, ez = (
        positions[b, 0] - positions[a, 0],
        positions[b, 1] - positions[a, 1],
        positions[b, 2] - positions[a, 2],
    )
    x, y, z = my * ez - mz * ey, mz * ex - mx * ez, mx * ey - my * ex
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / length if length > 0.0 else 0.0
    x, y, z = x * scale, y * scale, z * scale
    return x, y, z, -(x * positions[a, 0] + y * positions[a, 1] + z * positions[a, 2])


@lean
def wall(positions, faces, twins, f, k):
    """The wall beyond edge k of face f, which has a twin."""
    nx, ny, nz = unit_normal(positions, faces, f)
    mx, my, mz = unit_normal(positions, faces, twins[f, k] // 3)
    return wall_between(positions, faces[f, k], faces[f, (k + 1) % 3], nx, ny, nz, mx, my, mz)


@lean
def squared_to_segment(px, py, pz, ex, ey, ez):
    """Squared distance from p to the segment from the origin to e."""
    along = px * ex + py * ey + pz * ez
    if along > 0.0:
        length = ex * ex + ey * ey + ez * ez
        s = along / length if along < length else 1.0
        px, py, pz = px - s * ex, py - s * ey, pz - s * ez
    return px * px + py * py + pz * pz


@lean
def squared_to_triangle(px, py, pz, ax, ay, az, bx, by, bz, cx, cy, cz):
    """Squared distance from a point to a triangle.

    It is that to a point of the triangle, whatever rounding made of its place: never too small. Quicker
    sums of dot products lose half of the digits.
    """
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    px, py, pz = px - ax, py - ay, pz - az
    uu = ux * ux + uy * uy + uz * uz
    uv = ux * vx + uy * vy + uz * vz
    vv = vx * vx + vy * vy + vz * vz
    d = ux * px + uy * py + uz * pz
    e = vx * px + vy * py + vz * pz
    det = uu * vv - uv * uv
    s, t = vv * d - uv * e, uu * e - uv * d
    if s >= 0.0 and t >= 0.0 and s + t <= det and det > 0.0:
        s, t = s / det, t / det
        x, y, z = px - s * ux - t * vx, py - s * uy - t * vy, pz - s * uz - t * vz
        return x * x + y * y + z * z
    # Outside: the nearest point is on an edge that the point lies beyond.
    best = math.inf
    is_flat = not det > 0.0
    if t < 0.0 or is_flat:
        best = squared_to_segment(px, py, pz, ux, uy, uz)
    if s < 0.0 or is_flat:
        best = min(best, squared_to_segment(px, py, pz, vx, vy, vz))
    if s + t > det or is_flat:
        best = min(best, squared_to_segment(px - ux, py - uy, pz - uz, vx - ux, vy - uy, vz - uz))
    return best


@lean
def squared_to_face(x, y, z, positions, faces, f):
    """Squared distance from a point to face f."""
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    return squared_to_triangle(
        x,
        y,
        z,
        positions[a, 0],
        positions[a, 1],
        positions[a, 2],
        positions[b, 0],
        positions[b, 1],
        positions[b, 2],
        positions[c, 0],
        positions[c, 1],
        positions[c, 2],
    )


@lean
def squared_from(points, i, positions, faces, f):
    """Squared distance from points[i] to face f."""
    return squared_to_face(points[i, 0], points[i, 1], points[i, 2], positions, faces, f)
