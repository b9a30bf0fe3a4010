# mypy: allow-untyped-defs, allow-untyped-calls
"""What speaks against joining vertices u and v: faces that turn over, topology, thin tips that vanish."""

import math

from foveal.base.jit import lean

from ._kernels_surface import squared_to_triangle


@lean
def turns_over(positions, faces, alive, starts, counts, refs, u, v, x, y, z):
    """Whether a face of u that does not hold v would turn over, or vanish, with u at (x, y, z)."""
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if not alive[f]:
            continue
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        if a == v or b == v or c == v:
            continue
        if a == u:
            b, c = b, c
        elif b == u:
            b, c = c, a
        else:
            b, c = a, b
        ox, oy, oz = positions[b, 0], positions[b, 1], positions[b, 2]
        ex, ey, ez = positions[c, 0] - ox, positions[c, 1] - oy, positions[c, 2] - oz
        px, py, pz = positions[u, 0] - ox, positions[u, 1] - oy, positions[u, 2] - oz
        qx, qy, qz = x - ox, y - oy, z - oz
        nx, ny, nz = ey * pz - ez * py, ez * px - ex * pz, ex * py - ey * px
        mx, my, mz = ey * qz - ez * qy, ez * qx - ex * qz, ex * qy - ey * qx
        old = nx * nx + ny * ny + nz * nz
        new = mx * mx + my * my + mz * mz
        dot = nx * mx + ny * my + nz * mz
        if old > 0.0 and (dot <= 0.0 or dot * dot < 0.04 * old * new):
            return True
        # A needle hides its error in a tiny area and makes the next collapse worse.
        longest = max(ex * ex + ey * ey + ez * ez, qx * qx + qy * qy + qz * qz)
        if new < 1e-4 * longest * longest and new < old:
            return True
    return False


@lean
def breaks_link(faces, alive, starts, counts, refs, valence, is_border, marks, stamp, u, v):
    """Whether joining u and v would change the surface's topology. Uses marks `stamp` and `stamp + 1`."""
    shared = 0
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if alive[f]:
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            marks[a] = stamp
            marks[b] = stamp
            marks[c] = stamp
            if a == v or b == v or c == v:
                shared += 1
    marks[u] = 0
    marks[v] = 0
    common = 0
    for i in range(starts[v], starts[v] + counts[v]):
        f = refs[i]
        if not alive[f]:
            continue
        for k in range(3):
            w = faces[f, k]
            if marks[w] == stamp:
                marks[w] = stamp + 1
                common += 1
                if valence[w] <= (2 if not is_border[w] else 1) + (1 if shared > 1 else 0):
                    return True  # w would be left with two faces back to back, or none
    if common != shared or shared == 0:
        return True
    if is_border[u] and is_border[v] and shared != 1:
        return True  # two borders would touch in a point
    left = valence[u] + valence[v] - 2 * shared
    return left < (1 if shared == 1 else 3)


@lean
def vanished(positions, faces, alive, starts, counts, refs, u, v, x, y, z, enough):
    """The larger squared distance of u and v from the faces that their collapse to (x, y, z) leaves.

    Or something less than `enough`, as soon as it is clear that it is.
    """
    best_u, best_v = math.inf, math.inf
    for side in range(2):
        here, other = (u, v) if side == 0 else (v, u)
        for i in range(starts[here], starts[here] + counts[here]):
            f = refs[i]
            if not alive[f]:
                continue
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            if a == other or b == other or c == other:
                continue
            if b == here:
                b, c = c, a
            elif c == here:
                b, c = a, b
            if best_u >= enough:
                best_u = min(best_u, squared_with_apex(positions, u, x, y, z, b, c))
            if best_v >= enough:
                best_v = min(best_v, squared_with_apex(positions, v, x, y, z, b, c))
            if best_u < enough and best_v < enough:
                return max(best_u, best_v)
    return max(best_u, best_v)


@lean
def squared_with_apex(positions, v, x, y, z, b, c):
    """Squared distance from vertex v to the triangle (x, y, z), b, c."""
    return squared_to_triangle(
        positions[v, 0],
        positions[v, 1],
        positions[v, 2],
        x,
        y,
        z,
        positions[b, 0],
        positions[b, 1],
        positions[b, 2],
        positions[c, 0],
        positions[c, 1],
        positions[c, 2],
    )


@lean
def shared_faces(faces, alive, starts, counts, refs, u, v):
    """How many faces hold both u and v."""
    shared = 0
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if alive[f] and (faces[f, 0] == v or faces[f, 1] == v or faces[f, 2] == v):
            shared += 1
    return shared
