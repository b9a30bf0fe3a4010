# mypy: allow-untyped-defs, allow-untyped-calls
"""The overlay of a fine and a coarse triangulation of nearly the same surface. `overlay.py` says what for.

A crossing is where a fine edge passes over a coarse one. Crossings are kept in a list for each coarse
edge, ordered by `along`: `head` (3 m',) by the lower of the edge's two half-edges, `following`, `along`
and `fine_half` (c,) by crossing.

Beside a border edge that both meshes have lies a strip without width, whose outside is the coarse edge
and whose inside the fine one. As a face of the fine mesh its number is -2 - (the fine half-edge).
"""

import math

import numpy as np

from foveal.base.jit import kernel

from ._kernels_surface import fan_exit, squared_from, unit_normal, wall_between

#: How far the fine mesh is moved for every decision (not for any distance), in steps of the grid. Vertices
#: that stayed where they were would be on the edges of the other mesh, where it depends on rounding who
#: is on which side: without it 70 % of the dragon's faces could not be settled, with it 4 %.
SHIFT_X, SHIFT_Y, SHIFT_Z = 1.37e-6, 2.11e-6, 1.73e-6

#: Steps of a walk, faces of a turn, crossings looked at in a list, faces around a border vertex: all far
#: beyond what is usual.
WALK, TURNS, LISTED, FAN = 64, 24, 64, 1000

#: Where a chain begins: in no known face; in the one over its first vertex, which is found later.
UNKNOWN, INSIDE = -1, -(1 << 31)


@kernel
def moved_walls(positions, faces, twins, normals, out):
    """out (m, 3, 4): the walls of all faces, moved against the shift. normals (m, 3) is scratch."""
    for f in range(len(faces)):
        normals[f, 0], normals[f, 1], normals[f, 2] = unit_normal(positions, faces, f)
    for f in range(len(faces)):
        nx, ny, nz = normals[f, 0], normals[f, 1], normals[f, 2]
        for k in range(3):
            if twins[f, k] < 0:
                continue
            g = np.int64(twins[f, k]) // 3
            mx, my, mz = normals[g, 0], normals[g, 1], normals[g, 2]
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            x, y, z, d = wall_between(positions, a, b, nx, ny, nz, mx, my, mz)
            out[f, k, 0], out[f, k, 1], out[f, k, 2] = x, y, z
            out[f, k, 3] = d + x * SHIFT_X + y * SHIFT_Y + z * SHIFT_Z


@kernel
def side(walls, g, k, x, y, z):
    """Signed distance of the moved point to the wall through edge k of face g."""
    return walls[g, k, 0] * x + walls[g, k, 1] * y + walls[g, k, 2] * z + walls[g, k, 3]


@kernel
def locate(positions, faces, start, onto_positions, onto_faces, onto_twins, walls, place, distance):
    """place[v]: the coarse face that fine vertex v is over, by a walk from start[its face]; and how far."""
    place[:] = UNKNOWN
    for f in range(len(faces)):
        for k in range(3):
            v = faces[f, k]
            if place[v] != UNKNOWN:
                continue
            x, y, z = positions[v, 0], positions[v, 1], positions[v, 2]
            g, came = np.int64(start[f]), np.int64(-1)
            for _ in range(WALK):
                least, out = 0.0, -1
                for j in range(3):
                    if onto_twins[g, j] >= 0 and 3 * g + j != came:
                        s = side(walls, g, j, x, y, z)
                        if s < least:
                            least, out = s, j
                if out < 0:
                    break
                came = np.int64(onto_twins[g, out])
                g = came // 3
            place[v] = g
            distance[v] = math.sqrt(squared_from(positions, v, onto_positions, onto_faces, g))


@kernel
def exit_of(walls, twins, g, came, vx, vy, vz, wx, wy, wz):
    """(edge, s): where the way from v to w leaves face g first, edge -1 if w is inside."""
    first, out = 2.0, -1
    for j in range(3):
        if twins[g, j] >= 0 and 3 * g + j != came:
            beyond = side(walls, g, j, wx, wy, wz)
            if beyond < 0.0:
                before = side(walls, g, j, vx, vy, vz)
                s = before / (before - beyond) if before > 0.0 else 0.0
                if s < first:
                    first, out = s, j
    return out, first


@kernel
def hinge_of(faces, twins, g, goal):
    """(vertex, is_left) of the shortest turn from face g to face goal, vertex -1 if they share none."""
    least, hinge, best = TURNS, np.int64(-1), False
    for corner in range(3):
        z = faces[g, corner]
        if z != faces[goal, 0] and z != faces[goal, 1] and z != faces[goal, 2]:
            continue
        for is_left in (False, True):
            h, turns = g, 0
            while turns < least:
                half = np.int64(twins[h, fan_exit(faces, h, z, is_left)])
                if half < 0:
                    break
                h = half // 3
                turns += 1
                if h == goal:
                    least, hinge, best = turns, np.int64(z), is_left
                    break
    return hinge, best


@kernel
def along_edge(positions, a, b, x, y, z):
    """(s, distance): the place along the line from a to b nearest to a point, and the edge's distance."""
    x, y, z = x - positions[a, 0], y - positions[a, 1], z - positions[a, 2]
    ex, ey, ez = (
        positions[b, 0] - positions[a, 0],
        positions[b, 1] - positions[a, 1],
        positions[b, 2] - positions[a, 2],
    )
    length = ex * ex + ey * ey + ez * ez
    s = (x * ex + y * ey + z * ez) / length if length > 0.0 else 0.0
    t = min(1.0, max(0.0, s))
    x, y, z = x - t * ex, y - t * ey, z - t * ez
    return s, math.sqrt(x * x + y * y + z * z)


@kernel
def enlist(head, following, along, fine_half, used, edge, s, half):
    """Put a crossing into its edge's list, as number `used`; whether there was room."""
    if used >= len(following):
        return False
    before, i, looked = np.int64(-1), np.int64(head[edge]), 0
    while i >= 0 and along[i] < s:
        before, i = i, np.int64(following[i])
        looked += 1
        if looked > LISTED:
            return False
    following[used], along[used], fine_half[used] = i, s, half
    if before < 0:
        head[edge] = used
    else:
        following[before] = used
    return True


@kernel
def trace(
    positions,
    faces,
    twins,
    place,
    leaving,
    onto_positions,
    onto_faces,
    onto_twins,
    walls,
    carried,
    suspicious,
    errors,
    is_open,
    is_open_onto,
    head,
    following,
    along,
    fine_half,
):
    """Lead each fine edge over the coarse faces from its one end's place to the other's.

    Raises errors by what the crossings say; a way that does not arrive, or a crossing farther than
    `suspicious`, leaves the faces at it open.
    """
    head[:] = -1
    used = 0
    for half in range(3 * len(faces)):
        f, k = half // 3, half % 3
        twin = np.int64(twins[f, k])
        if twin >= 0 and twin < half:
            continue
        v, w = faces[f, k], faces[f, (k + 1) % 3]
        g, goal = np.int64(place[v]), np.int64(place[w])
        # A border that the coarse mesh does not have bounds nothing there.
        is_loose = twin < 0 and leaving[v] != -2 - half
        is_open_onto[g] |= is_loose
        beyond = twin // 3 if twin >= 0 else f
        most = max(carried[f], carried[beyond])
        vx, vy, vz = positions[v, 0], positions[v, 1], positions[v, 2]
        wx, wy, wz = positions[w, 0], positions[w, 1], positions[w, 2]
        came, hinge, is_left, s = np.int64(-1), np.int64(-1), False, 0.0
        for _ in range(WALK):
            if g == goal:
                break
            out = -1
            if hinge < 0:
                out, t = exit_of(walls, onto_twins, g, came, vx, vy, vz, wx, wy, wz)
                if out < 0:  # inside of two faces: walls lean over each other where the surface is sharp
                    hinge, is_left = hinge_of(onto_faces, onto_twins, g, goal)
                    if hinge < 0:
                        break
                    hx, hy, hz = onto_positions[hinge, 0], onto_positions[hinge, 1], onto_positions[hinge, 2]
                    t, _ = along_edge(positions, v, w, hx, hy, hz)
            if hinge >= 0:
                out = fan_exit(onto_faces, g, hinge, is_left)
            s = max(s, min(t, 1.0))
            here, there = 3 * g + out, np.int64(onto_twins[g, out])
            edge = min(here, there)
            a, b = onto_faces[edge // 3, edge % 3], onto_faces[edge // 3, (edge % 3 + 1) % 3]
            x, y, z = vx + s * (wx - vx), vy + s * (wy - vy), vz + s * (wz - vz)
            r, d = along_edge(onto_positions, a, b, x, y, z)
            h = there // 3
            is_open_onto[h] |= is_loose
            if d <= suspicious:
                errors[g] = max(errors[g], most + d)
                errors[h] = max(errors[h], most + d)
            is_listed = enlist(head, following, along, fine_half, used, edge, r, half)
            if not d <= suspicious or not is_listed:
                is_open[f] = is_open[beyond] = True
                is_open_onto[g] = is_open_onto[h] = True
            if not is_listed:
                break
            used += 1
            came, g = there, h
        if g != goal:
            is_open[f] = is_open[beyond] = True
            is_open_onto[g] = is_open_onto[goal] = True
    return used


@kernel
def outlines(
    positions,
    faces,
    twins,
    place,
    leaving,
    onto_positions,
    onto_faces,
    onto_twins,
    kept,
    begins,
    under,
    depth,
):
    """Match border edges: begins[half-edge of the coarse mesh] becomes the strip that lies beside it.

    leaving[v], the border half-edge from a fine vertex, becomes the strip's number too. Then the coarse
    half-edges from a matched border's vertex begin in the strip on their side of the fine vertex, which is
    over one of the faces around; those from other border vertices are UNKNOWN, all others INSIDE. Where a
    strip begins, under and depth are set as well.
    """
    leaving[:] = UNKNOWN
    under[:] = UNKNOWN
    begins[:] = INSIDE
    for f in range(len(faces)):
        for k in range(3):
            if twins[f, k] < 0:
                leaving[faces[f, k]] = 3 * f + k
    for half in range(3 * len(onto_faces)):
        g, k = half // 3, half % 3
        if onto_twins[g, k] >= 0:
            continue
        begins[half] = UNKNOWN
        a, b = onto_faces[g, k], onto_faces[g, (k + 1) % 3]
        v, w = kept[a], kept[b]
        fine = np.int64(leaving[v])
        if fine < 0 or faces[fine // 3, (fine % 3 + 1) % 3] != w:
            continue
        if is_same(positions, v, onto_positions, a) and is_same(positions, w, onto_positions, b):
            begins[half] = leaving[v] = -2 - fine
            under[a], depth[a] = fine // 3, 0.0
    for half in range(3 * len(onto_faces)):
        if onto_twins[half // 3, half % 3] < 0:
            fan(onto_faces, onto_twins, kept, place, begins, half)


@kernel
def is_same(positions, v, onto_positions, z):
    """Whether two vertices are in one point."""
    return (
        positions[v, 0] == onto_positions[z, 0]
        and positions[v, 1] == onto_positions[z, 1]
        and positions[v, 2] == onto_positions[z, 2]
    )


@kernel
def fan(faces, twins, kept, place, begins, border):
    """Let the half-edges around the vertex where a border half-edge begins begin in the strips there."""
    z = faces[border // 3, border % 3]
    under = place[kept[z]]
    last, is_over = np.int64(UNKNOWN), False
    for is_second in (False, True):
        g, is_past = border // 3, False
        for _ in range(FAN):
            is_past |= g == under
            k = fan_exit(faces, g, z, True)
            half = np.int64(twins[g, k])
            if half < 0:
                last = np.int64(begins[3 * g + k])
                break
            if is_second:
                is_known = is_over and begins[border] != UNKNOWN and last != UNKNOWN
                begins[half] = UNKNOWN if not is_known else (last if is_past else begins[border])
            g = half // 3
        is_over = is_past


@kernel
def has_edge(twins, f, half):
    """Whether a half-edge or its twin is face f's."""
    twin = twins[half // 3, half % 3]
    return half // 3 == f or (twin >= 0 and twin // 3 == f)


@kernel
def settle(
    positions,
    faces,
    twins,
    onto_positions,
    onto_faces,
    onto_twins,
    head,
    following,
    fine_half,
    first,
    votes,
    under,
    depth,
):
    """under[z]: the fine face over coarse vertex z, by the crossings next to it; how far it is.

    The nearest crossing on each edge from z is on an edge of that face, so each votes for the two faces
    that its fine edge has. A search by distance or walls would often come to the face beside.
    """
    first[:] = UNKNOWN
    votes[:] = 0
    for edge in range(3 * len(onto_faces)):
        g, k = edge // 3, edge % 3
        i = np.int64(head[edge])
        if i < 0:
            continue
        for is_end in (False, True):
            z = onto_faces[g, (k + 1) % 3] if is_end else onto_faces[g, k]
            while is_end and following[i] >= 0:
                i = np.int64(following[i])
            half = np.int64(fine_half[i])
            if first[z] == UNKNOWN:
                first[z] = half
            known = np.int64(first[z])
            twin = np.int64(twins[known // 3, known % 3])
            votes[z, 0] += has_edge(twins, known // 3, half)
            votes[z, 1] += twin >= 0 and has_edge(twins, twin // 3, half)
    for z in range(len(onto_positions)):
        if under[z] != UNKNOWN:
            continue
        half = np.int64(first[z])
        if half == UNKNOWN:
            continue
        f, d = half // 3, squared_from(onto_positions, z, positions, faces, half // 3)
        twin = np.int64(twins[f, half % 3])
        if twin >= 0 and votes[z, 1] >= votes[z, 0]:
            other = squared_from(onto_positions, z, positions, faces, twin // 3)
            if votes[z, 1] > votes[z, 0] or other < d:
                f, d = twin // 3, other
        under[z], depth[z] = f, math.sqrt(d)
    for _ in range(2):  # a vertex whose edges nothing crosses is under the same face as their other ends
        for here in range(3 * len(onto_faces)):
            g, k = here // 3, here % 3
            a, b = onto_faces[g, k], onto_faces[g, (k + 1) % 3]
            edge = min(here, onto_twins[g, k]) if onto_twins[g, k] >= 0 else here
            if under[a] == UNKNOWN and under[b] != UNKNOWN and head[edge] < 0:
                under[a] = under[b]
                depth[a] = math.sqrt(squared_from(onto_positions, a, positions, faces, under[b]))


@kernel
def verify(faces, twins, onto_faces, onto_twins, begins, head, following, fine_half, is_open, is_open_onto):
    """Follow each coarse edge over the fine faces; where the chain breaks, the faces at it are open."""
    for edge in range(3 * len(onto_faces)):
        twin = np.int64(onto_twins[edge // 3, edge % 3])
        if 0 <= twin < edge:
            continue
        now, last = np.int64(begins[edge]), np.int64(begins[twin]) if twin >= 0 else np.int64(begins[edge])
        is_whole = now != UNKNOWN
        if twin >= 0:  # where faces disagree about the outside, the twin begins at the same end
            is_whole &= onto_faces[twin // 3, twin % 3] == onto_faces[edge // 3, (edge % 3 + 1) % 3]
        i = np.int64(head[edge]) if twin >= 0 else np.int64(-1)
        while i >= 0 and is_whole:
            now = step(twins, following, fine_half, i, now)
            is_whole = now != UNKNOWN
            i = np.int64(following[i])
        if is_whole and now == last:
            continue
        is_open_onto[edge // 3] = True
        if twin >= 0:
            is_open_onto[twin // 3] = True
        if begins[edge] >= 0:
            is_open[begins[edge]] = True
        if last >= 0:
            is_open[last] = True
        i = np.int64(head[edge])
        while i >= 0:
            half = np.int64(fine_half[i])
            is_open[half // 3] = True
            if twins[half // 3, half % 3] >= 0:
                is_open[twins[half // 3, half % 3] // 3] = True
            i = np.int64(following[i])


@kernel
def step(twins, following, fine_half, i, now):
    """Over the crossing i of a list: from face `now` to the face beyond, or UNKNOWN.

    Crossings at nearly one place may be listed in the wrong order: the next few are tried in its stead.
    """
    j = i
    for _ in range(6):
        if j < 0:
            break
        half = np.int64(fine_half[j])
        twin = np.int64(twins[half // 3, half % 3])
        outside = twin // 3 if twin >= 0 else -2 - half
        if half // 3 == now or outside == now:
            fine_half[j] = fine_half[i]
            fine_half[i] = half
            return outside if half // 3 == now else half // 3
        j = np.int64(following[j])
    return np.int64(UNKNOWN)


@kernel
def begin_inside(onto_faces, onto_twins, under, begins, is_rim):
    """Half-edges that begin inside begin in the face over their first vertex, unless a border is there."""
    is_rim[:] = False
    for half in range(3 * len(onto_faces)):
        g, k = half // 3, half % 3
        if onto_twins[g, k] < 0:
            is_rim[onto_faces[g, k]] = is_rim[onto_faces[g, (k + 1) % 3]] = True
    for half in range(3 * len(onto_faces)):
        if begins[half] == INSIDE:
            z = onto_faces[half // 3, half % 3]
            begins[half] = UNKNOWN if is_rim[z] else under[z]


@kernel
def corners(
    faces, place, distance, onto_faces, under, depth, carried, suspicious, errors, is_open, is_open_onto
):
    """What the vertices of both meshes say, as `trace` does of the crossings."""
    for f in range(len(faces)):
        for k in range(3):
            g, d = place[faces[f, k]], distance[faces[f, k]]
            if d <= suspicious:
                errors[g] = max(errors[g], carried[f] + d)
            else:
                is_open[f] = is_open_onto[g] = True
    for g in range(len(onto_faces)):
        for k in range(3):
            f, d = under[onto_faces[g, k]], depth[onto_faces[g, k]]
            if f >= 0 and d <= suspicious:
                errors[g] = max(errors[g], carried[f] + d)
            else:
                is_open_onto[g] = True
                if f >= 0:
                    is_open[f] = True
