# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of distances: a tree of boxes over triangles, and the nearest point of a triangle.

The tree is implicit: triangles sorted along a Morton curve, `leaves` (a power of two) runs of them;
node k has the children 2k and 2k + 1, leaf i is node leaves + i. Any order of triangles gives exact
distances; the curve only makes the boxes small.
"""

import numpy as np

from foveal.base.jit import kernel

STACK = 64


@kernel
def morton_codes(points, low, scale, out):
    """21 bits an axis, interleaved."""
    for i in range(len(points)):
        code = np.int64(0)
        for axis in range(3):
            x = np.int64(min(max((points[i, axis] - low[axis]) * scale, 0.0), 2097151.0))
            x = (x | (x << 32)) & 0x1F00000000FFFF
            x = (x | (x << 16)) & 0x1F0000FF0000FF
            x = (x | (x << 8)) & 0x100F00F00F00F00F
            x = (x | (x << 4)) & 0x10C30C30C30C30C3
            x = (x | (x << 2)) & 0x1249249249249249
            code |= x << axis
        out[i] = code


@kernel
def fill_boxes(corners, leaves, boxes):
    """boxes[k] = least and greatest coordinates below node k; corners are (m, 3, 3), sorted."""
    m = len(corners)
    for i in range(leaves):
        box = boxes[leaves + i]
        box[:3] = np.inf
        box[3:] = -np.inf
        for t in range(i * m // leaves, (i + 1) * m // leaves):
            for corner in range(3):
                for axis in range(3):
                    box[axis] = min(box[axis], corners[t, corner, axis])
                    box[3 + axis] = max(box[3 + axis], corners[t, corner, axis])
    for k in range(leaves - 1, 0, -1):
        for axis in range(3):
            boxes[k, axis] = min(boxes[2 * k, axis], boxes[2 * k + 1, axis])
            boxes[k, 3 + axis] = max(boxes[2 * k, 3 + axis], boxes[2 * k + 1, 3 + axis])


@kernel
def _box_square(box, x, y, z):
    """Squared distance of a point to a box; infinite for an empty one."""
    dx = max(box[0] - x, x - box[3], 0.0)
    dy = max(box[1] - y, y - box[4], 0.0)
    dz = max(box[2] - z, z - box[5], 0.0)
    return dx * dx + dy * dy + dz * dz


@kernel
def _segment_square(px, py, pz, ux, uy, uz):
    """Squared distance of p to the segment from 0 to u, which may have no length."""
    length = ux * ux + uy * uy + uz * uz
    t = 0.0
    if length > 0:
        t = min(max((px * ux + py * uy + pz * uz) / length, 0.0), 1.0)
    dx, dy, dz = px - t * ux, py - t * uy, pz - t * uz
    return dx * dx + dy * dy + dz * dz


@kernel
def triangle_square(t, x, y, z, limit):
    """Squared distance of a point to the triangle t (3, 3), or anything above `limit` if that is larger.

    A triangle thinner than 1e-12 of its length is its sides: its normal is rounding.
    """
    px, py, pz = x - t[0, 0], y - t[0, 1], z - t[0, 2]
    ux, uy, uz = t[1, 0] - t[0, 0], t[1, 1] - t[0, 1], t[1, 2] - t[0, 2]
    vx, vy, vz = t[2, 0] - t[0, 0], t[2, 1] - t[0, 1], t[2, 2] - t[0, 2]
    wx, wy, wz = vx - ux, vy - uy, vz - uz
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    area = nx * nx + ny * ny + nz * nz
    longest = max(ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz)
    if area > 1e-24 * longest * longest:
        height = nx * px + ny * py + nz * pz
        plane = height * height / area
        if plane > limit * 1.000001:  # the plane alone is too far
            return plane
        # p is above the inside if it is on the left of all three sides, seen along the normal.
        left_u = nx * (uy * pz - uz * py) + ny * (uz * px - ux * pz) + nz * (ux * py - uy * px)
        left_v = nx * (py * vz - pz * vy) + ny * (pz * vx - px * vz) + nz * (px * vy - py * vx)
        if left_u >= 0 and left_v >= 0 and left_u + left_v <= area:
            return plane
    best = _segment_square(px, py, pz, ux, uy, uz)
    best = min(best, _segment_square(px, py, pz, vx, vy, vz))
    return min(best, _segment_square(px - ux, py - uy, pz - uz, wx, wy, wz))


@kernel
def closest(points, corners, leaves, boxes, squares, which):
    """For each point the squared distance to the nearest triangle, and its place in `corners`.

    A point's search starts from the triangle of the point before: quick where neighbours follow.
    """
    nodes = np.empty(STACK, dtype=np.int64)
    bounds = np.empty(STACK)
    m = len(corners)
    nearest = 0
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        best = triangle_square(corners[nearest], x, y, z, np.inf)
        nodes[0] = 1
        bounds[0] = 0.0
        depth = 1
        while depth > 0:
            depth -= 1
            node = nodes[depth]
            if bounds[depth] >= best:
                continue
            while node < leaves:  # go down the nearer side, keep the other for later
                left = _box_square(boxes[2 * node], x, y, z)
                right = _box_square(boxes[2 * node + 1], x, y, z)
                node = 2 * node
                if right < left:
                    node += 1
                    left, right = right, left
                if right < best:
                    nodes[depth] = node ^ 1
                    bounds[depth] = right
                    depth += 1
                if left >= best:
                    node = -1
                    break
            if node < 0:
                continue
            run = node - leaves
            for t in range(run * m // leaves, (run + 1) * m // leaves):
                square = triangle_square(corners[t], x, y, z, best)
                if square < best:
                    best = square
                    nearest = t
        squares[i] = best
        which[i] = nearest
