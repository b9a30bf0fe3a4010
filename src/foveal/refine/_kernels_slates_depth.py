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
def bends(net, work, points, normals, chosen, levels, out):
    """out[v, l]: the least cosine between the limit normal at v and those of its faces at level l."""
    for v in chosen:
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
def spheres(net, work, points, chosen, out):
    """out[f]: centre and radius of a ball that holds the limit patch.

    It holds all points a step further that the patch is a mean of, which are those of its corners' rings: two
    thirds of the radius that the control mesh's own points would take. The centre is the corners' mean, so
    that a turned mesh has turned balls.
    """
    for f in chosen:
        for x in range(3):
            total = 0.0
            for k in range(4):
                total += points[net.corners[4 * f + k], x]
            out[f, x] = 0.25 * total
        most = 0.0
        for k in range(4):
            v = net.corners[4 * f + k]
            fill_ring(net, points, v, work.rings[0, 0], 0)
            ring = work.rings[1, 0]
            ring_step(net, v, 0, work.rings[0, 0], 0, ring, 0)
            for i in range(0, 3 * (1 + net.ring_starts[v + 1] - net.ring_starts[v]), 3):
                x, y, z = ring[i] - out[f, 0], ring[i + 1] - out[f, 1], ring[i + 2] - out[f, 2]
                most = max(most, x * x + y * y + z * z)
        out[f, 3] = np.sqrt(most)


@lean
def classify(net, corner_points, normals, eyes, epsilon, out):
    """out[i, v]: from eye i, BACK or FRONT if all normals at the vertex agree on it, else SILHOUETTE."""
    for i in range(len(eyes)):
        for v in range(len(corner_points)):
            x, y = corner_points[v, 0] - eyes[i, 0], corner_points[v, 1] - eyes[i, 1]
            z = corner_points[v, 2] - eyes[i, 2]
            near = epsilon * np.sqrt(x * x + y * y + z * z)
            is_back, is_front = True, True
            for j in range(net.normal_starts[v], net.normal_starts[v + 1]):
                dot = normals[j, 0] * x + normals[j, 1] * y + normals[j, 2] * z
                is_back = is_back and dot > near
                is_front = is_front and dot < -near
            out[i, v] = BACK if is_back else FRONT if is_front else SILHOUETTE


@lean
def radii(balls, matrices, scales, eye, pixels_per_radian, out):
    """out[i, f]: the ball's radius in pixels, as matrix i places it; infinite where the eye is in it."""
    for i in range(len(matrices)):
        for f in range(len(balls)):
            away = 0.0
            for x in range(3):
                d = matrices[i, x, 3] - eye[x]
                for y in range(3):
                    d += matrices[i, x, y] * balls[f, y]
                away += d * d
            radius = scales[i] * balls[f, 3]
            out[i, f] = pixels_per_radian * radius / np.sqrt(away) if away > radius * radius else np.inf


@lean
def choose(net, is_shown, curvature, classes, sizes, rules, most, out):
    """out[i m + f]: the depth by the rules, of what placement i looks like."""
    patches = len(is_shown)
    for entry in range(len(out)):
        i, f = entry // patches, entry % patches
        out[entry] = by_rules(net, f, curvature, classes[i], sizes[i, f], rules, most) if is_shown[f] else -1


@lean
def by_rules(net, f, curvature, classes, size, rules, most):
    """A patch's depth. Rules: backs are coarse, silhouettes deep; the smallest, largest size in pixels."""
    depth, backs, fronts = 0, 0, 0
    for k in range(4):
        v = net.corners[4 * f + k]
        depth = max(depth, min(curvature[v], most))
        backs += classes[v] == BACK
        fronts += classes[v] == FRONT
    if backs == 4 and rules[0] > 0:
        return 0
    if rules[1] > 0 and backs < 4 and fronts < 4:
        depth = (most + depth + 1) // 2
    size /= 1 << depth
    while size > rules[3] and depth < most:
        depth += 1
        size *= 0.5
    while size < rules[2] and depth > 0:
        depth -= 1
        size *= 2.0
    return depth
