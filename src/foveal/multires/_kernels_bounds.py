# mypy: allow-untyped-defs, allow-untyped-calls
"""Upper bounds of the distance between two triangulations of nearly the same surface.

A triangle of one is cut into pieces, each of which is given to a triangle of the other. The distance to
a triangle is a convex function, since a triangle is a convex set: on a piece it is largest at a corner.
So whatever the cuts and whoever gets a piece, the largest corner distance is a true bound; good cuts
only make it tight. The cuts are along walls: through each edge, halfway between its two triangles.
"""

import math

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
def walls_of(positions, faces, across, normals, out):
    """out[f, k] = plane (n, d) through edge k, n towards the face's inside; zero where nothing is beyond."""
    for f in range(len(faces)):
        for k in range(3):
            g = across[f, k]
            for axis in range(4):
                out[f, k, axis] = 0.0
            if g < 0:
                continue
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            ex, ey, ez = (
                positions[b, 0] - positions[a, 0],
                positions[b, 1] - positions[a, 1],
                positions[b, 2] - positions[a, 2],
            )
            nx, ny, nz = normals[f, 0], normals[f, 1], normals[f, 2]
            mx, my, mz = nx + normals[g, 0], ny + normals[g, 1], nz + normals[g, 2]
            if mx * mx + my * my + mz * mz < 0.01:  # folded back: half way is anywhere
                mx, my, mz = nx, ny, nz
            x, y, z = my * ez - mz * ey, mz * ex - mx * ez, mx * ey - my * ex
            length = math.sqrt(x * x + y * y + z * z)
            if length > 0.0:
                x, y, z = x / length, y / length, z / length
                out[f, k, 0], out[f, k, 1], out[f, k, 2] = x, y, z
                out[f, k, 3] = -(x * positions[a, 0] + y * positions[a, 1] + z * positions[a, 2])


@kernel
def squared_to_segment(px, py, pz, ax, ay, az, bx, by, bz):
    """Squared distance from a point to a segment."""
    ex, ey, ez = bx - ax, by - ay, bz - az
    dx, dy, dz = px - ax, py - ay, pz - az
    length = ex * ex + ey * ey + ez * ez
    s = 0.0
    if length > 0.0:
        s = min(1.0, max(0.0, (dx * ex + dy * ey + dz * ez) / length))
    dx, dy, dz = dx - s * ex, dy - s * ey, dz - s * ez
    return dx * dx + dy * dy + dz * dz


@kernel
def squared_to_triangle(px, py, pz, positions, a, b, c):
    """Squared distance from a point to a triangle, degenerate or not."""
    ax, ay, az = positions[a, 0], positions[a, 1], positions[a, 2]
    bx, by, bz = positions[b, 0], positions[b, 1], positions[b, 2]
    cx, cy, cz = positions[c, 0], positions[c, 1], positions[c, 2]
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    wx, wy, wz = px - ax, py - ay, pz - az
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    wu, wv = wx * ux + wy * uy + wz * uz, wx * vx + wy * vy + wz * vz
    area = uu * vv - uv * uv
    s, t = vv * wu - uv * wv, uu * wv - uv * wu
    if area > 0.0 and s >= 0.0 and t >= 0.0 and s + t <= area:
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        height = wx * nx + wy * ny + wz * nz
        return height * height / (nx * nx + ny * ny + nz * nz)
    return min(
        squared_to_segment(px, py, pz, ax, ay, az, bx, by, bz),
        min(
            squared_to_segment(px, py, pz, bx, by, bz, cx, cy, cz),
            squared_to_segment(px, py, pz, cx, cy, cz, ax, ay, az),
        ),
    )


@kernel
def farthest(polygon, count, positions, faces, f, enough):
    """Largest squared distance from the polygon's corners to face f; infinity once above `enough`."""
    worst = 0.0
    for i in range(count):
        d = squared_to_triangle(
            polygon[i, 0], polygon[i, 1], polygon[i, 2], positions, faces[f, 0], faces[f, 1], faces[f, 2]
        )
        if d > enough:
            return math.inf
        worst = max(worst, d)
    return worst


@kernel
def cut(polygon, count, wall, inside, outside, sides):
    """Both parts of a convex polygon at a wall: corners in (inside, outside)."""
    for i in range(count):
        sides[i] = wall[0] * polygon[i, 0] + wall[1] * polygon[i, 1] + wall[2] * polygon[i, 2] + wall[3]
    n_in, n_out = 0, 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        p, q = sides[i], sides[j]
        if p >= 0.0:
            inside[n_in, 0], inside[n_in, 1], inside[n_in, 2] = polygon[i, 0], polygon[i, 1], polygon[i, 2]
            n_in += 1
        if p <= 0.0:
            outside[n_out, 0], outside[n_out, 1], outside[n_out, 2] = (
                polygon[i, 0],
                polygon[i, 1],
                polygon[i, 2],
            )
            n_out += 1
        if (p > 0.0 and q < 0.0) or (p < 0.0 and q > 0.0):
            s = p / (p - q)
            for axis in range(3):
                x = polygon[i, axis] + s * (polygon[j, axis] - polygon[i, axis])
                inside[n_in, axis] = x
                outside[n_out, axis] = x
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
    walls,
    start,
    carried,
    is_coarse_to_fine,
    stack,
    stack_info,
    work,
    sides,
    errors,
):
    """Raise `errors` of the coarse faces to bound the way from `faces` to `onto_faces`.

    start[f] is where the search for face f's pieces begins. carried are the fine faces' own errors, which
    a piece brings along. errors are of the coarse faces: `faces` if is_coarse_to_fine, else `onto_faces`.
    stack (k, 12, 3), stack_info (k, 4) and work (2, 12, 3), sides (12,) are scratch.
    """
    limit = len(stack) - 4
    for f in range(len(faces)):
        for i in range(3):
            for axis in range(3):
                stack[0, i, axis] = positions[faces[f, i], axis]
        stack_info[0, 0], stack_info[0, 1], stack_info[0, 2], stack_info[0, 3] = 3, start[f], -1, 0
        top = 1
        while top > 0:
            top -= 1
            count, g, came, depth = (
                stack_info[top, 0],
                stack_info[top, 1],
                stack_info[top, 2],
                stack_info[top, 3],
            )
            base = carried[f] if not is_coarse_to_fine else carried[g]
            coarse = g if not is_coarse_to_fine else f
            for i in range(count):
                for axis in range(3):
                    work[0, i, axis] = stack[top, i, axis]
            now, other = 0, 1
            spare = errors[coarse] - base
            if (
                spare > 0.0
                and farthest(work[0], count, onto_positions, onto_faces, g, spare * spare) < math.inf
            ):
                continue  # changes nothing
            if depth < 24:
                for k in range(3):
                    beyond = onto_across[g, k]
                    if beyond < 0 or beyond == came or top >= limit or count > 9:
                        continue
                    n_in, n_out = cut(work[now], count, walls[g, k], work[other], stack[top], sides)
                    if n_out > 2 and not (n_in > 2 and n_out == 0):
                        is_outside = False
                        for i in range(count):
                            is_outside |= sides[i] < 0.0
                        if is_outside:
                            stack_info[top, 0], stack_info[top, 1] = n_out, beyond
                            stack_info[top, 2], stack_info[top, 3] = g, depth + 1
                            top += 1
                            now, other = other, now
                            count = n_in
                            if n_in < 3:
                                break
            if count >= 3:
                d = farthest(work[now], count, onto_positions, onto_faces, g, math.inf)
                errors[coarse] = max(errors[coarse], base + math.sqrt(d))


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
