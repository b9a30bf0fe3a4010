# mypy: allow-untyped-defs, allow-untyped-calls
"""Quadrics of a cell's vertices, and where an edge's vertices meet best.

Based on: M. Garland, P. Heckbert. Surface simplification using quadric error metrics. SIGGRAPH 1997.
A quadric is 11 numbers: xx xy xz yy yz zz x y z 1 of the summed squared plane distances, then the area.
"""

import math

from foveal.base.jit import lean
from foveal.mesh._kernels_area import area_vector

from ._kernels_surface import BORDER


@lean
def mark_border(faces, twins, is_border):
    """Whether a vertex is on an edge with one face."""
    is_border[:] = False
    for f in range(len(faces)):
        for k in range(3):
            if twins[f, k] == BORDER:
                is_border[faces[f, k]] = is_border[faces[f, (k + 1) % 3]] = True


@lean
def add_plane(quadrics, v, nx, ny, nz, d, weight):
    """Add weight * (n . x + d)^2 to the quadric of v."""
    quadrics[v, 0] += weight * nx * nx
    quadrics[v, 1] += weight * nx * ny
    quadrics[v, 2] += weight * nx * nz
    quadrics[v, 3] += weight * ny * ny
    quadrics[v, 4] += weight * ny * nz
    quadrics[v, 5] += weight * nz * nz
    quadrics[v, 6] += weight * nx * d
    quadrics[v, 7] += weight * ny * d
    quadrics[v, 8] += weight * nz * d
    quadrics[v, 9] += weight * d * d


@lean
def face_quadrics(positions, faces, twins, border_weight, quadrics):
    """Quadrics of all vertices: planes of the faces, and a wall along each border edge.

    Planes weigh the root of the area: by the area itself the small triangles at the tips of thin features
    cost nothing beside their neighbours, and the tips go first (see `VANISHED`).
    """
    quadrics[:] = 0.0
    for f in range(len(faces)):
        a = faces[f, 0]
        nx, ny, nz = area_vector(positions, faces, f)
        length = math.sqrt(nx * nx + ny * ny + nz * nz)
        if length > 0.0:
            nx, ny, nz = nx / length, ny / length, nz / length
            d = -(nx * positions[a, 0] + ny * positions[a, 1] + nz * positions[a, 2])
            weight = math.sqrt(0.5 * length)
            for k in range(3):
                add_plane(quadrics, faces[f, k], nx, ny, nz, d, weight)
                quadrics[faces[f, k], 10] += weight
        for k in range(3):
            if twins[f, k] != BORDER:
                continue
            i, j = faces[f, k], faces[f, (k + 1) % 3]
            ex, ey, ez = (
                positions[j, 0] - positions[i, 0],
                positions[j, 1] - positions[i, 1],
                positions[j, 2] - positions[i, 2],
            )
            wx, wy, wz = ey * nz - ez * ny, ez * nx - ex * nz, ex * ny - ey * nx
            squared = wx * wx + wy * wy + wz * wz
            if length > 0.0 and squared > 0.0:
                size = math.sqrt(squared)
                inverse = 1.0 / size
                wx, wy, wz = wx * inverse, wy * inverse, wz * inverse
                d = -(wx * positions[i, 0] + wy * positions[i, 1] + wz * positions[i, 2])
                add_plane(quadrics, i, wx, wy, wz, d, border_weight * size)
                add_plane(quadrics, j, wx, wy, wz, d, border_weight * size)


@lean
def place(positions, quadrics, locked, u, v):
    """(cost, x, y, z) of the best place for the vertex that u and v become, on the grid."""
    # Indexed, not sliced: a slice counts a reference, atomically.
    a, b, c = (
        quadrics[u, 0] + quadrics[v, 0],
        quadrics[u, 1] + quadrics[v, 1],
        quadrics[u, 2] + quadrics[v, 2],
    )
    d, e, f = (
        quadrics[u, 3] + quadrics[v, 3],
        quadrics[u, 4] + quadrics[v, 4],
        quadrics[u, 5] + quadrics[v, 5],
    )
    g, h, i = (
        quadrics[u, 6] + quadrics[v, 6],
        quadrics[u, 7] + quadrics[v, 7],
        quadrics[u, 8] + quadrics[v, 8],
    )
    ux, uy, uz = positions[u, 0], positions[u, 1], positions[u, 2]
    vx, vy, vz = positions[v, 0], positions[v, 1], positions[v, 2]
    ex, ey, ez = vx - ux, vy - uy, vz - uz
    squared = ex * ex + ey * ey + ez * ez
    if locked[u]:
        x, y, z = ux, uy, uz
    elif locked[v]:
        x, y, z = vx, vy, vz
    else:
        mx, my, mz = 0.5 * (ux + vx), 0.5 * (uy + vy), 0.5 * (uz + vz)
        # A little pull to the middle makes the system solvable on planes and along straight edges.
        pull = 1e-3 * (a + d + f) + 1e-300
        aa, dd, ff = a + pull, d + pull, f + pull
        gx = -g - (a * mx + b * my + c * mz)
        gy = -h - (b * mx + d * my + e * mz)
        gz = -i - (c * mx + e * my + f * mz)
        xx, xy, xz = dd * ff - e * e, c * e - b * ff, b * e - c * dd
        yy, yz, zz = aa * ff - c * c, b * c - aa * e, aa * dd - b * b
        inverse = 1.0 / (aa * xx + b * xy + c * xz)
        x = mx + (xx * gx + xy * gy + xz * gz) * inverse
        y = my + (xy * gx + yy * gy + yz * gz) * inverse
        z = mz + (xz * gx + yz * gy + zz * gz) * inverse
        far = (x - mx) * (x - mx) + (y - my) * (y - my) + (z - mz) * (z - mz)
        if not far <= 4.0 * squared:  # runs away along a needle, or is NaN
            x, y, z = mx, my, mz
        x, y, z = math.floor(x + 0.5), math.floor(y + 0.5), math.floor(z + 0.5)
    # Mean squared distance, not its integral: what counts is the worst place, not the volume. A trace of
    # the length lets short edges go first where all is flat.
    weight = quadrics[u, 10] + quadrics[v, 10]
    total = (
        x * (a * x + 2.0 * (b * y + c * z + g))
        + y * (d * y + 2.0 * (e * z + h))
        + z * (f * z + 2.0 * i)
        + quadrics[u, 9]
        + quadrics[v, 9]
    )
    cost = total / weight if weight > 0.0 else 0.0
    return max(cost, 0.0) + 1e-5 * squared, x, y, z
