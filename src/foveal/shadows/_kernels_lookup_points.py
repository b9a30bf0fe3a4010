# mypy: allow-untyped-defs, allow-untyped-calls
"""From points of the world to lookups: pixels, steps, bias, by `spec/shadows.md`."""

import numpy as np

from foveal.base.jit import inlined, kernel

from ._kernels_lookup import IN_STACK, STACKED, begin, descend, lit_in, shared_level

STEPS = 4294967296.0
BIAS_STEPS = 2048.0  # half a millimetre in a kilometre: what float32 rounds away in the page
ROUNDING_TEXELS = 0.0625
OFF = -(1 << 30)  # the pixel of a point that is on no map


@inlined
def shift_of(window, point, normal, half):
    """How far a receiver moves along its normal to be above its own plane, `half` a kernel around."""
    matrix, rays = window.matrix, window.rays
    along_u = normal[0] * rays[0, 0] + normal[1] * rays[0, 1] + normal[2] * rays[0, 2]
    along_v = normal[0] * rays[1, 0] + normal[1] * rays[1, 1] + normal[2] * rays[1, 2]
    away = normal[0] * matrix[3, 0] + normal[1] * matrix[3, 1] + normal[2] * matrix[3, 2]
    w = matrix[3, 0] * point[0] + matrix[3, 1] * point[1] + matrix[3, 2] * point[2] + matrix[3, 3]
    slope = half * (abs(along_u) + abs(along_v))
    return w * slope / max(1.0 - slope * away, 0.5)


@inlined
def place(window, level, radius, point, normal, has_normal):
    """x, y and step of a receiver on the map of `level`; OFF behind the light or out of any reach."""
    matrix = window.matrix
    x, y, z = point[0], point[1], point[2]
    bias, side = 0.0, float(1 << level)
    if has_normal:
        margin = (0.5 if level == window.levels else 1.0) + ROUNDING_TEXELS
        shift = shift_of(window, point, normal, (radius + margin) / side)
        x += shift * normal[0]
        y += shift * normal[1]
        z += shift * normal[2]
        bias = BIAS_STEPS
    w = matrix[3, 0] * x + matrix[3, 1] * y + matrix[3, 2] * z + matrix[3, 3]
    u = (matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * z + matrix[0, 3]) / w * side
    v = (matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * z + matrix[1, 3]) / w * side
    depth = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * z + matrix[2, 3]
    if not (w > 0.0 and abs(u) < -OFF and abs(v) < -OFF and depth == depth):
        return OFF, OFF, 0
    step = min(max(np.floor(depth * STEPS) - bias, 0.0), STEPS - 1.0)
    return int(np.floor(u)), int(np.floor(v)), np.int64(step)


@kernel
def places(window, level, radius, points, normals, out):
    """(n, 3): x, y and step of each receiver; `normals` may be empty."""
    has_normals = len(normals) > 0
    for i in range(len(points)):
        normal = normals[i] if has_normals else points[i]
        out[i] = place(window, level, radius, points[i], normal, has_normals)


@kernel
def lit_shares(packed, window, level, radius, image, is_cube, points, normals, out):
    """The share of the pixels around each point that is lit; `normals` may be empty.

    Pixels off the map are lit. Those off a face of a cube are left out instead: other faces see there.
    """
    links, valued = begin(packed, level)
    last = np.zeros(4, np.int64)
    path = (links, valued, last)
    stack = np.empty((STACKED, IN_STACK), np.int64)
    most, samples = (1 << level) - 1, (2 * radius + 1) ** 2
    has_normals = len(normals) > 0
    for i in range(len(points)):
        normal = normals[i] if has_normals else points[i]
        x, y, step = place(window, level, radius, points[i], normal, has_normals)
        if is_cube:
            x, y = min(max(x, 0), most), min(max(y, 0), most)
        if radius == 0:  # one walk to one value, half again as fast as a square of one pixel
            out[i] = 1.0
            if 0 <= x <= most and 0 <= y <= most:
                shared = shared_level((x ^ last[1]) | (y ^ last[2]) | (image ^ last[3]), level)
                reached = min(shared, last[0])
                if links[reached] >= 0:
                    reached = descend(packed, level, reached, level, x, y, image, links, valued)
                last[0], last[1], last[2], last[3] = reached, x, y, image
                out[i] = 1.0 if step <= packed.words[valued[reached]] else 0.0
            continue
        x0, y0 = max(x - radius, 0), max(y - radius, 0)
        x1, y1 = min(x + radius, most), min(y + radius, most)
        if x0 > x1 or y0 > y1:
            out[i] = 1.0
            continue
        on_map = (x1 - x0 + 1) * (y1 - y0 + 1)
        lit = lit_in(packed, level, x0, y0, x1, y1, image, step, path, stack)
        out[i] = lit / on_map if is_cube else (samples - on_map + lit) / samples
