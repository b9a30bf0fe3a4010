# mypy: allow-untyped-defs, allow-untyped-calls
"""How deep patches are tessellated: curvature once a control mesh, classes and size once a view.

Based on: Settgast, Müller, Fünfzig, Fellner, section 3.1. Where the paper prints ln · n < cos alpha the cone
is meant to hold the normals, so it is >= here.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_slates_ring import fill_ring, ring_step

BACK, FRONT, SILHOUETTE = 0, 1, 2


@lean
def bends(net, work, points, normals, levels, out):
    """out[v, l]: the least cosine between the limit normal at v and those of its faces at level l."""
    for v in range(len(out)):
        if net.fans[v] == 0:
            continue
        fill_ring(net, points, v, work.rings[0, 0], 0)
        for level in range(levels):
            ring = work.rings[level & 1, 0]
            out[v, level] = least_cosine(net, normals, v, ring)
            ring_step(net, v, level, ring, 0, work.rings[1 - (level & 1), 0], 0)


@lean
def least_cosine(net, normals, v, ring):
    """Each face's normal against that of its sector; a face without one does not bend."""
    begin = net.fan_starts[v]
    spokes = net.ring_starts[v + 1] - net.ring_starts[v] - net.fans[v]
    least = 1.0
    for i in range(net.fans[v]):
        e, f = 3 * (1 + i), 3 * (1 + spokes + i)
        g = 3 * (1 + (i + 1) % spokes)
        ax, ay, az = ring[f] - ring[0], ring[f + 1] - ring[1], ring[f + 2] - ring[2]
        bx, by, bz = ring[g] - ring[e], ring[g + 1] - ring[e + 1], ring[g + 2] - ring[e + 2]
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        length = np.sqrt(x * x + y * y + z * z)
        at = net.normal_of[net.fan[begin + i]]
        if length > 0.0:
            dot = normals[at, 0] * x + normals[at, 1] * y + normals[at, 2] * z
            least = min(least, dot / length)
    return least


@lean
def curved(cosines, cone, most, out):
    """out[v]: the least level from which on, up to `most`, all normals are in the cone; else `most`."""
    for v in range(len(out)):
        level = most
        while level > 0 and cosines[v, level] >= cone and cosines[v, level - 1] >= cone:
            level -= 1
        out[v] = level


@lean
def spheres(net, points, out):
    """out[f]: centre and radius of a ball with all that the patch is a mean of."""
    for f in range(len(out)):
        for x in range(3):
            low, high = np.inf, -np.inf
            for k in range(4):
                v = net.corners[4 * f + k]
                for i in range(net.ring_starts[v], net.ring_starts[v + 1]):
                    value = points[net.ring[i], x]
                    low, high = min(low, value), max(high, value)
            out[f, x] = 0.5 * (low + high)
        most = 0.0
        for k in range(4):
            v = net.corners[4 * f + k]
            for i in range(net.ring_starts[v], net.ring_starts[v + 1]):
                u = net.ring[i]
                x, y, z = points[u, 0] - out[f, 0], points[u, 1] - out[f, 1], points[u, 2] - out[f, 2]
                most = max(most, x * x + y * y + z * z)
        out[f, 3] = np.sqrt(most)


@lean
def classify(net, corner_points, normals, eye, epsilon, out):
    """out[v]: BACK or FRONT if all normals at the vertex agree on it, else SILHOUETTE."""
    for v in range(len(out)):
        x, y, z = corner_points[v, 0] - eye[0], corner_points[v, 1] - eye[1], corner_points[v, 2] - eye[2]
        length = np.sqrt(x * x + y * y + z * z)
        is_back, is_front = True, True
        for i in range(net.normal_starts[v], net.normal_starts[v + 1]):
            dot = normals[i, 0] * x + normals[i, 1] * y + normals[i, 2] * z
            is_back = is_back and dot > epsilon * length
            is_front = is_front and dot < -epsilon * length
        out[v] = BACK if is_back else FRONT if is_front else SILHOUETTE


@lean
def radii(balls, matrix, scale, eye, pixels_per_radian, out):
    """out[f]: the ball's radius in pixels, once it is placed; infinite where the eye is in it."""
    for f in range(len(out)):
        away = 0.0
        for i in range(3):
            x = matrix[i, 3] - eye[i]
            for j in range(3):
                x += matrix[i, j] * balls[f, j]
            away += x * x
        radius = scale * balls[f, 3]
        out[f] = pixels_per_radian * radius / np.sqrt(away) if away > radius * radius else np.inf


@lean
def choose(net, is_shown, curvature, classes, sizes, rules, most, out):
    """out[f]: the depth by the rules: backs, silhouettes, the smallest and the largest piece in pixels."""
    is_coarse_back, is_deep_silhouette, smallest, largest = rules[0] > 0, rules[1] > 0, rules[2], rules[3]
    for f in range(len(out)):
        if not is_shown[f]:
            out[f] = -1
            continue
        depth, backs, fronts = 0, 0, 0
        for k in range(4):
            v = net.corners[4 * f + k]
            depth = max(depth, min(curvature[v], most))
            backs += classes[v] == BACK
            fronts += classes[v] == FRONT
        if backs == 4 and is_coarse_back:
            out[f] = 0
            continue
        if is_deep_silhouette and backs < 4 and fronts < 4:
            depth = (most + depth + 1) // 2
        size = sizes[f] / (1 << depth)
        while size > largest and depth < most:
            depth += 1
            size *= 0.5
        while size < smallest and depth > 0:
            depth -= 1
            size *= 2.0
        out[f] = depth
