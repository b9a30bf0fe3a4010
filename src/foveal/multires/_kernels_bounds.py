# mypy: allow-untyped-defs, allow-untyped-calls
"""Upper bounds of the distance between two triangulations of nearly the same surface.

A triangle of one is cut into pieces, each of which is given to a triangle of the other. The distance to
a triangle is a convex function, since a triangle is a convex set: on a piece it is largest at a corner.
So whatever the cuts and whoever gets a piece, the largest corner distance is a true bound; good cuts
only make it tight. The cuts are along walls: through each edge, halfway between its two triangles.
"""

import math

import numpy as np

from foveal.base.jit import kernel


@kernel
def normals_of(positions, faces, across, out):
    """Unit normals; a face without area takes the mean of its neighbours'."""
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = (
            positions[b, 0] - positions[a, 0],
            positions[b, 1] - positions[a, 1],
            positions[b, 2] - positions[a, 2],
        )
        vx, vy, vz = (
            positions[c, 0] - positions[a, 0],
            positions[c, 1] - positions[a, 1],
            positions[c, 2] - positions[a, 2],
        )
        x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = math.sqrt(x * x + y * y + z * z)
        scale = 1.0 / length if length > 0.0 else 0.0
        out[f, 0], out[f, 1], out[f, 2] = x * scale, y * scale, z * scale
    for f in range(len(faces)):
        if out[f, 0] == 0.0 and out[f, 1] == 0.0 and out[f, 2] == 0.0:
            for k in range(3):
                g = across[f, k]
                if g >= 0:
                    for axis in range(3):
                        out[f, axis] += out[g, axis]


@kernel
def plane_through(positions, a, b, mx, my, mz, out, f, k):
    """out[f, k] = plane (n, d) through the edge a, b along m; n to the left of the edge, m pointing up."""
    ex, ey, ez = (
        positions[b, 0] - positions[a, 0],
        positions[b, 1] - positions[a, 1],
        positions[b, 2] - positions[a, 2],
    )
    x, y, z = my * ez - mz * ey, mz * ex - mx * ez, mx * ey - my * ex
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / length if length > 0.0 else 0.0
    out[f, k, 0], out[f, k, 1], out[f, k, 2] = x * scale, y * scale, z * scale
    out[f, k, 3] = -scale * (x * positions[a, 0] + y * positions[a, 1] + z * positions[a, 2])


@kernel
def frames_of(positions, faces, across, normals, out):
    """out[f]: seven planes. The face's own (0); walls halfway to its neighbours (1-3), through its edges,
    inside positive, zero where nothing is beyond; and walls at right angles to the face (4-6)."""
    for f in range(len(faces)):
        nx, ny, nz = normals[f, 0], normals[f, 1], normals[f, 2]
        a = faces[f, 0]
        out[f, 0, 0], out[f, 0, 1], out[f, 0, 2] = nx, ny, nz
        out[f, 0, 3] = -(nx * positions[a, 0] + ny * positions[a, 1] + nz * positions[a, 2])
        for k in range(3):
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            plane_through(positions, a, b, nx, ny, nz, out, f, 4 + k)
            g = across[f, k]
            if g < 0:
                for axis in range(4):
                    out[f, 1 + k, axis] = 0.0
                continue
            mx, my, mz = nx + normals[g, 0], ny + normals[g, 1], nz + normals[g, 2]
            if mx * mx + my * my + mz * mz < 0.01:  # folded back: half way is anywhere
                mx, my, mz = nx, ny, nz
            plane_through(positions, a, b, mx, my, mz, out, f, 1 + k)


@kernel
def squared_to_edge(x, y, z, positions, a, b):
    """Squared distance from a point to a segment."""
    ax, ay, az = positions[a, 0], positions[a, 1], positions[a, 2]
    ex, ey, ez = positions[b, 0] - ax, positions[b, 1] - ay, positions[b, 2] - az
    dx, dy, dz = x - ax, y - ay, z - az
    along = dx * ex + dy * ey + dz * ez
    if along > 0.0:
        length = ex * ex + ey * ey + ez * ez
        s = along / length if along < length else 1.0
        dx, dy, dz = dx - s * ex, dy - s * ey, dz - s * ez
    return dx * dx + dy * dy + dz * dz


@kernel
def squared_to_face(x, y, z, frames, positions, faces, g):
    """Squared distance from a point to face g; quick where the point is above or below its inside.

    Here and below arrays are indexed, not sliced: each slice counts a reference, atomically, and a
    dozen of them for each piece doubled the time.
    """
    s0 = frames[g, 4, 0] * x + frames[g, 4, 1] * y + frames[g, 4, 2] * z + frames[g, 4, 3]
    s1 = frames[g, 5, 0] * x + frames[g, 5, 1] * y + frames[g, 5, 2] * z + frames[g, 5, 3]
    s2 = frames[g, 6, 0] * x + frames[g, 6, 1] * y + frames[g, 6, 2] * z + frames[g, 6, 3]
    if s0 > 0.0 and s1 > 0.0 and s2 > 0.0:
        height = frames[g, 0, 0] * x + frames[g, 0, 1] * y + frames[g, 0, 2] * z + frames[g, 0, 3]
        return height * height
    # Outside: the nearest point is on an edge that the point lies beyond.
    best = math.inf
    if s0 <= 0.0:
        best = squared_to_edge(x, y, z, positions, faces[g, 0], faces[g, 1])
    if s1 <= 0.0:
        best = min(best, squared_to_edge(x, y, z, positions, faces[g, 1], faces[g, 2]))
    if s2 <= 0.0:
        best = min(best, squared_to_edge(x, y, z, positions, faces[g, 2], faces[g, 0]))
    return best


@kernel
def farthest(polygons, at, count, frames, positions, faces, g):
    """Largest squared distance from the corners of polygon `at` to face g."""
    worst = 0.0
    for i in range(count):
        d = squared_to_face(
            polygons[at, i, 0], polygons[at, i, 1], polygons[at, i, 2], frames, positions, faces, g
        )
        if d > worst:
            worst = d
    return worst


@kernel
def cut(work, now, count, sides, stack, top):
    """Both parts of the convex polygon work[now]: what is inside to work[1 - now], outside to stack[top].

    sides[i] are its corners' signed distances to the wall. Returns the numbers of corners.
    """
    n_in, n_out, other = 0, 0, 1 - now
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        p, q = sides[i], sides[j]
        if p >= 0.0:
            for axis in range(3):
                work[other, n_in, axis] = work[now, i, axis]
            n_in += 1
        if p <= 0.0:
            for axis in range(3):
                stack[top, n_out, axis] = work[now, i, axis]
            n_out += 1
        if (p > 0.0 and q < 0.0) or (p < 0.0 and q > 0.0):
            s = p / (p - q)
            for axis in range(3):
                x = work[now, i, axis] + s * (work[now, j, axis] - work[now, i, axis])
                work[other, n_in, axis] = x
                stack[top, n_out, axis] = x
            n_in += 1
            n_out += 1
    return n_in, n_out


@kernel
def measure(
    positions,
    faces,
    onto_positions,
    onto_faces,
    onto_across,
    frames,
    start,
    carried,
    is_coarse_to_fine,
    suspicious,
    slack,
    stack,
    stack_info,
    work,
    sides,
    errors,
    later,
    later_face,
):
    """Raise `errors` of the coarse faces to bound the way from `faces` to `onto_faces`.

    start[f] is where the search for face f's pieces begins. carried are the fine faces' own errors, which
    a piece brings along. errors are of the coarse faces: `faces` if is_coarse_to_fine, else `onto_faces`.
    Triangles of pieces farther than `suspicious` go to `later` (k, 3, 3) with their face, as long as there
    is room. stack (k, 20, 3), stack_info (k, 4), work (2, 20, 3) and sides (20,) are scratch. Returns how
    many wait in `later`.
    """
    limit = len(stack) - 4
    waiting = 0
    for f in range(len(faces)):
        for i in range(3):
            for axis in range(3):
                stack[0, i, axis] = positions[faces[f, i], axis]
        stack_info[0, 0], stack_info[0, 1], stack_info[0, 2], stack_info[0, 3] = 3, start[f], -1, 0
        top = 1
        while top > 0:
            top -= 1
            count, g, came, depth = (
                np.int64(stack_info[top, 0]),
                np.int64(stack_info[top, 1]),
                np.int64(stack_info[top, 2]),
                np.int64(stack_info[top, 3]),
            )
            now = np.int64(0)  # no literal: each would be a signature of its own to compile
            for i in range(count):
                work[0, i, 0] = stack[top, i, 0]
                work[0, i, 1] = stack[top, i, 1]
                work[0, i, 2] = stack[top, i, 2]
            for k in range(3):
                beyond = onto_across[g, k]
                if beyond < 0 or beyond == came or depth >= 24 or top >= limit or count > 9:
                    continue
                a, b = frames[g, 1 + k, 0], frames[g, 1 + k, 1]
                c, d = frames[g, 1 + k, 2], frames[g, 1 + k, 3]
                least = 0.0
                for i in range(count):
                    side = a * work[now, i, 0] + b * work[now, i, 1] + c * work[now, i, 2] + d
                    sides[i] = side
                    least = min(least, side)
                if least >= -slack:  # not worth a cut: the distance tells the truth all the same
                    continue
                n_in, n_out = cut(work, now, count, sides, stack, top)
                stack_info[top, 0], stack_info[top, 1] = n_out, beyond
                stack_info[top, 2], stack_info[top, 3] = g, depth + 1
                top += 1
                now = 1 - now
                count = n_in
                if n_in < 3:
                    break
            if count < 3:
                continue
            coarse, base = (f, carried[g]) if is_coarse_to_fine else (g, carried[f])
            d = math.sqrt(farthest(work, now, count, frames, onto_positions, onto_faces, g))
            if d <= suspicious or waiting + count > len(later):
                errors[coarse] = max(errors[coarse], base + d)
                continue
            for i in range(2, count):
                for axis in range(3):
                    later[waiting, 0, axis] = work[now, 0, axis]
                    later[waiting, 1, axis] = work[now, i - 1, axis]
                    later[waiting, 2, axis] = work[now, i, axis]
                later_face[waiting] = f
                waiting += 1
    return waiting


@kernel
def file_faces(positions, faces, low, scale, size, starts, refs, is_counting):
    """Put each face into the boxes of a grid that its own box meets: first counting, then filling."""
    total = 0
    for f in range(len(faces)):
        i0, i1 = span(positions, faces, f, np.int64(0), low[0], scale, size[0])
        j0, j1 = span(positions, faces, f, np.int64(1), low[1], scale, size[1])
        k0, k1 = span(positions, faces, f, np.int64(2), low[2], scale, size[2])
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                for k in range(k0, k1 + 1):
                    box = (i * size[1] + j) * size[2] + k
                    if not is_counting:
                        refs[starts[box]] = f
                    starts[box] += 1
                    total += 1
    return total


@kernel
def span(positions, faces, f, axis, low, scale, size):
    """First and last box that face f meets along an axis."""
    a, b, c = positions[faces[f, 0], axis], positions[faces[f, 1], axis], positions[faces[f, 2], axis]
    first = int((min(a, min(b, c)) - low) * scale)
    last = int((max(a, max(b, c)) - low) * scale)
    return min(size - 1, max(0, first)), min(size - 1, max(0, last))


@kernel
def nearest_face(x, y, z, positions, faces, frames, low, scale, size, starts, refs, guess):
    """(face, squared distance) of the face nearest to a point; `guess` is any face."""
    best = guess
    d_best = squared_to_face(x, y, z, frames, positions, faces, guess)
    ci = min(size[0] - 1, max(0, int((x - low[0]) * scale)))
    cj = min(size[1] - 1, max(0, int((y - low[1]) * scale)))
    ck = min(size[2] - 1, max(0, int((z - low[2]) * scale)))
    most = max(size[0], max(size[1], size[2]))
    for ring in range(most):
        # All in rings before are at least (ring - 1) boxes away, as far as the point is in the grid;
        # outside it they are farther.
        if ring > 1 and (ring - 1) / scale * ((ring - 1) / scale) > d_best:
            break
        for i in range(max(0, ci - ring), min(size[0], ci + ring + 1)):
            for j in range(max(0, cj - ring), min(size[1], cj + ring + 1)):
                is_face = abs(i - ci) == ring or abs(j - cj) == ring
                step = 1 if is_face or ring == 0 else 2 * ring
                for k in range(ck - ring, ck + ring + 1, step):
                    if k < 0 or k >= size[2]:
                        continue
                    box = (i * size[1] + j) * size[2] + k
                    for r in range(starts[box], starts[box + 1]):
                        g = np.int64(refs[r])
                        d = squared_to_face(x, y, z, frames, positions, faces, g)
                        if d < d_best:
                            best, d_best = g, d
    return best, d_best


@kernel
def measure_closely(
    pending,
    pending_face,
    onto_positions,
    onto_faces,
    frames,
    low,
    scale,
    size,
    starts,
    refs,
    start,
    carried,
    is_coarse_to_fine,
    enough,
    stack,
    near,
    far,
    errors,
):
    """Like `measure` for the few triangles that were suspicious: halved until three corners agree on a face.

    A triangle is done when one face is at most `enough` from all its corners, or at most 1.1 times as
    far as the farthest corner is from the surface (no bound can be less), or after 64 halvings. What is
    far below the farthest place found so far decides nothing, so that `enough` grows with it.
    """
    record = 0.0
    for t in range(len(pending)):
        f = pending_face[t]
        for i in range(3):
            for axis in range(3):
                stack[0, i, axis] = pending[t, i, axis]
            near[0, i], far[0, i] = nearest_face(
                pending[t, i, 0],
                pending[t, i, 1],
                pending[t, i, 2],
                onto_positions,
                onto_faces,
                frames,
                low,
                scale,
                size,
                starts,
                refs,
                start[f] if i == 0 else near[0, i - 1],
            )
        top, halvings = 1, 0
        while top > 0:
            top -= 1
            lower = max(far[top, 0], max(far[top, 1], far[top, 2]))
            best, upper = near[top, 0], math.inf
            for i in range(3):
                worst = farthest(stack, top, np.int64(3), frames, onto_positions, onto_faces, near[top, i])
                if worst < upper:
                    best, upper = near[top, i], worst
            record = max(record, lower)
            fine = max(max(enough * enough, 0.5 * record), 1.21 * lower)
            if upper <= fine or halvings >= 64 or top + 2 > len(stack):
                coarse, base = (f, carried[best]) if is_coarse_to_fine else (best, carried[f])
                errors[coarse] = max(errors[coarse], base + math.sqrt(upper))
                continue
            halvings += 1
            longest, edge = -1.0, 0
            for i in range(3):
                j = (i + 1) % 3
                length = (
                    (stack[top, i, 0] - stack[top, j, 0]) ** 2
                    + (stack[top, i, 1] - stack[top, j, 1]) ** 2
                    + (stack[top, i, 2] - stack[top, j, 2]) ** 2
                )
                if length > longest:
                    longest, edge = length, i
            j = (edge + 1) % 3
            x = 0.5 * (stack[top, edge, 0] + stack[top, j, 0])
            y = 0.5 * (stack[top, edge, 1] + stack[top, j, 1])
            z = 0.5 * (stack[top, edge, 2] + stack[top, j, 2])
            g, d = nearest_face(
                x,
                y,
                z,
                onto_positions,
                onto_faces,
                frames,
                low,
                scale,
                size,
                starts,
                refs,
                near[top, edge],
            )
            for i in range(3):
                near[top + 1, i], far[top + 1, i] = near[top, i], far[top, i]
                for axis in range(3):
                    stack[top + 1, i, axis] = stack[top, i, axis]
            stack[top, j, 0], stack[top, j, 1], stack[top, j, 2] = x, y, z
            near[top, j], far[top, j] = g, d
            stack[top + 1, edge, 0], stack[top + 1, edge, 1], stack[top + 1, edge, 2] = x, y, z
            near[top + 1, edge], far[top + 1, edge] = g, d
            top += 2


@kernel
def spread(start, across, queue):
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
            g = across[f, k]
            if g >= 0 and start[g] < 0:
                start[g] = start[f]
                queue[end] = g
                end += 1
    return end
