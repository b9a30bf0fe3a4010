# mypy: allow-untyped-defs, allow-untyped-calls
"""From visible faces to colours, by `spec/shading.md`."""

import numpy as np

from foveal.base.jit import kernel

DECODE_STEPS = 255  # entries of the table of decoded bytes less one
ENCODE_STEPS = 4095
KEY_X, KEY_Y = -0.35, 0.45  # the key light that hangs on the camera
KEY_Z = float(np.sqrt(1 - KEY_X**2 - KEY_Y**2))


@kernel
def weigh(face_ids, first_row, faces, seen, lens, weights):
    """How much each corner of the visible face counts at a sample, in space: perspective is in it.

    The ray through the sample meets the plane of the face where the volumes that it spans with the
    edges stand as the weights. The sample may lie outside by the rounding of places: no weight is
    negative.
    """
    pixels_per_radian, width, height, _ = lens
    for row in range(len(face_ids)):
        y = (0.5 * height - (first_row + row + 0.5)) / pixels_per_radian
        for column in range(width):
            face = face_ids[row, column]
            if face < 0:
                weights[row, column] = 0.0
                continue
            x = (column + 0.5 - 0.5 * width) / pixels_per_radian
            for_a, for_b, for_c = weights_of(
                x, y, seen[faces[face, 0]], seen[faces[face, 1]], seen[faces[face, 2]]
            )
            weights[row, column, 0] = for_a
            weights[row, column, 1] = for_b
            weights[row, column, 2] = for_c


@kernel
def weights_of(x, y, a, b, c):
    """The weights of corners where the ray (x, y, 1) meets their plane; from 0, sum 1."""
    for_a = _volume(x, y, b, c)
    for_b = _volume(x, y, c, a)
    for_c = _volume(x, y, a, b)
    if for_a + for_b + for_c < 0.0:
        for_a, for_b, for_c = -for_a, -for_b, -for_c
    for_a, for_b, for_c = max(for_a, 0.0), max(for_b, 0.0), max(for_c, 0.0)
    total = for_a + for_b + for_c
    if not total > 0.0:  # seen edge-on
        for_a, for_b, for_c, total = 1.0, 1.0, 1.0, 3.0
    return for_a / total, for_b / total, for_c / total


@kernel
def _volume(x, y, p, q):
    """(x, y, 1) . (p x q)"""
    return x * (p[1] * q[2] - p[2] * q[1]) + y * (p[2] * q[0] - p[0] * q[2]) + (p[0] * q[1] - p[1] * q[0])


@kernel
def _unit(x, y, z, least):
    length = np.sqrt(x * x + y * y + z * z)
    if length > least:
        return x / length, y / length, z / length, True
    return 0.0, 0.0, 0.0, False


@kernel
def face_normal(a, b, c):
    """Unit normal of a triangle in the camera's frame (depth ahead), (0, 0, 1) if it has none."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], a[2] - b[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], a[2] - c[2]
    x, y, z, has_one = _unit(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx, 0.0)
    return (x, y, z) if has_one else (0.0, 0.0, 1.0)


@kernel
def _normal_at(corners, weights, normals, basis):
    """Interpolated unit normal in the camera's frame, and whether there is one."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(3):
        x += weights[k] * normals[corners[k], 0]
        y += weights[k] * normals[corners[k], 1]
        z += weights[k] * normals[corners[k], 2]
    right = basis[0, 0] * x + basis[0, 1] * y + basis[0, 2] * z
    up = basis[1, 0] * x + basis[1, 1] * y + basis[1, 2] * z
    back = basis[2, 0] * x + basis[2, 1] * y + basis[2, 2] * z
    return _unit(right, up, back, 1e-3)


@kernel
def light_of(x, y, z, facing_x, facing_y, facing_z, key_x, key_y, key_z, shadow):
    """Steps 1 to 4 of the page, for a unit normal, the triangle's own towards the eye, and the key light."""
    if x * facing_x + y * facing_y + z * facing_z < 0.0:
        x, y, z = -x, -y, -z
    key = max(0.0, x * key_x + y * key_y + z * key_z)
    return 0.08 + 0.17 * (0.5 + 0.5 * y) + 0.90 * shadow * key


@kernel
def shade(
    face_ids,
    weights,
    first_row,
    faces,
    seen,
    normals,
    colours,
    plain,
    basis,
    lens,
    keys,
    shadows,
    decode,
    out,
):
    """Linear red, green, blue of each sample; 0 where there is no face.

    `normals` and `colours` may be empty: then faces are flat and `plain`. So may `keys`, the directions to
    the light, and `shadows`: then it hangs on the camera, or all is in it.
    """
    pixels_per_radian, width, height, _ = lens
    for row in range(len(face_ids)):
        to_eye_y = -(0.5 * height - (first_row + row + 0.5)) / pixels_per_radian
        for column in range(width):
            face = face_ids[row, column]
            if face < 0:
                out[row, column] = 0.0
                continue
            corners, weight = faces[face], weights[row, column]
            has_one = False
            if len(normals) > 0:
                x, y, z, has_one = _normal_at(corners, weight, normals, basis)
            fx, fy, fz = face_normal(seen[corners[0]], seen[corners[1]], seen[corners[2]])
            to_eye_x = -(column + 0.5 - 0.5 * width) / pixels_per_radian
            if fx * to_eye_x + fy * to_eye_y + fz < 0.0:
                fx, fy, fz = -fx, -fy, -fz
            if not has_one:
                x, y, z = fx, fy, fz
            shadow = shadows[row, column] if len(shadows) > 0 else 1.0
            key_x, key_y, key_z = KEY_X, KEY_Y, KEY_Z
            if len(keys) > 0:
                key_x, key_y, key_z = keys[row, column, 0], keys[row, column, 1], keys[row, column, 2]
            light = light_of(x, y, z, fx, fy, fz, key_x, key_y, key_z, shadow)
            for k in range(3):
                colour = plain[k]
                if len(colours) > 0:
                    colour = 0.0
                    for j in range(3):
                        colour += weight[j] * colours[corners[j], k]
                out[row, column, k] = min(1.0, decoded(colour, decode) * light)


@kernel
def decoded(colour, table):
    """Linear value of an sRGB value from 0 to 255; between two bytes, in proportion."""
    colour = min(max(colour, 0.0), 255.0)
    below = min(int(colour), DECODE_STEPS - 1)
    part = colour - below
    return table[below] * (1.0 - part) + table[below + 1] * part


@kernel
def encoded(linear, table):
    """The sRGB byte of a linear value. The table runs over its square root, see `shade.tables`."""
    return table[int(np.sqrt(min(max(linear, 0.0), 1.0)) * ENCODE_STEPS + 0.5)]


@kernel
def develop(linear, face_ids, samples, background, has_background, encode, out):
    """Average squares of samples to pixels, over a background (linear) or none, and encode them."""
    share = 1.0 / (samples * samples)
    for row in range(len(out)):
        for column in range(out.shape[1]):
            covered = 0
            red, green, blue = 0.0, 0.0, 0.0
            for j in range(samples * row, samples * (row + 1)):
                for i in range(samples * column, samples * (column + 1)):
                    if face_ids[j, i] >= 0:
                        covered += 1
                        red += linear[j, i, 0]
                        green += linear[j, i, 1]
                        blue += linear[j, i, 2]
            alpha = 1.0
            scale = share
            if has_background:
                rest = 1.0 - covered * share
                red = red * share + rest * background[row, column, 0]
                green = green * share + rest * background[row, column, 1]
                blue = blue * share + rest * background[row, column, 2]
                scale = 1.0
            else:
                alpha = covered * share
                scale = 1.0 / max(covered, 1)
            out[row, column, 0] = encoded(red * scale, encode)
            out[row, column, 1] = encoded(green * scale, encode)
            out[row, column, 2] = encoded(blue * scale, encode)
            out[row, column, 3] = np.uint8(255.0 * alpha + 0.5)
