# mypy: allow-untyped-defs, allow-untyped-calls
"""Leading the fine triangulation over the coarse one: where its vertices are placed, where its edges cross.

A crossing is where a fine edge passes over a coarse one. Crossings are kept in a list for each coarse
edge, ordered by `along`: `head` (3 m',) by the lower of the edge's two half-edges, `following`, `along`
and `fine_half` (c,) by crossing.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_surface import fan_exit, squared_from, unit_normal, wall_between

#: How far the fine mesh is moved for every decision (not for any distance), in steps of the grid. Vertices
#: that stayed where they were would be on the edges of the other mesh, where it depends on rounding who
#: is on which side: without it 70 % of the dragon's faces could not be settled, with it 4 %.
SHIFT_X, SHIFT_Y, SHIFT_Z = 1.37e-6, 2.11e-6, 1.73e-6

#: Steps of a walk, faces of a turn, crossings looked at in a list: all far beyond what is usual.
WALK, TURNS, LISTED = 64, 24, 64

#: No face yet.
UNKNOWN = -1


@lean
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


@lean
def side(walls, g, k, x, y, z):
    """Signed distance of the moved point to the wall through edge k of face g."""
    return walls[g, k, 0] * x + walls[g, k, 1] * y + walls[g, k, 2] * z + walls[g, k, 3]


@lean
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


@lean
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


@lean
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


@lean
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


@lean
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


@lean
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
