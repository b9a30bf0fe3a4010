# mypy: allow-untyped-defs, allow-untyped-calls
"""Limit points and normals of control vertices: each once, so that all patches there have the same bits."""

import numpy as np

from foveal.base.jit import lean

#: Of the product of the tangents' lengths: below it a cross product is rounding.
TINY = 1e-12


@lean
def vertex_limits(net, points, chosen, out_points, out_normals):
    """Fill rows of `chosen` vertices, and their sectors' normals."""
    for i in range(len(chosen)):
        v = chosen[i]
        mask = net.mask_of[v]
        begin = net.ring_starts[v]
        size = net.ring_starts[v + 1] - begin + 1
        row = net.mask_starts[mask]
        x, y, z = weighted(net, points, v, begin, size, row)
        out_points[v, 0], out_points[v, 1], out_points[v, 2] = x, y, z
        for s in range(net.sector_starts[mask + 1] - net.sector_starts[mask]):
            sector = net.sectors[net.sector_starts[mask] + s]
            x, y, z, length = crossed(net, points, v, begin, size, row, sector[0], sector[1])
            if not length > 0.0:
                x, y, z, length = crossed(net, points, v, begin, size, row, sector[2], sector[3])
            share = 1.0 / length if length > 0.0 else 0.0
            at = net.normal_starts[v] + s
            # The zero added makes -0 the other zero.
            out_normals[at, 0] = x * share + 0.0
            out_normals[at, 1] = y * share + 0.0
            out_normals[at, 2] = z * share + 0.0


@lean
def weighted(net, points, v, begin, size, row):
    """A row of a mask times the ring of v."""
    w = net.weights[row]
    x, y, z = w * points[v, 0], w * points[v, 1], w * points[v, 2]
    for j in range(1, size):
        w = net.weights[row + j]
        u = net.ring[begin + j - 1]
        x += w * points[u, 0]
        y += w * points[u, 1]
        z += w * points[u, 2]
    return x, y, z


@lean
def crossed(net, points, v, begin, size, row, first, count):
    """The sum of cross products of pairs of rows, and its length, 0 where it is nothing but rounding."""
    x, y, z, most = 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        at = row + (first + 2 * i) * size
        ax, ay, az = weighted(net, points, v, begin, size, at)
        bx, by, bz = weighted(net, points, v, begin, size, at + size)
        x += ay * bz - az * by
        y += az * bx - ax * bz
        z += ax * by - ay * bx
        most += np.sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz))
    length = np.sqrt(x * x + y * y + z * z)
    return x, y, z, length if length > TINY * most else 0.0
