# mypy: allow-untyped-defs, allow-untyped-calls
"""Triangles to pixels in fixed point, so that no rounding can open a gap or cover a sample twice.

A place on the picture is a pair of integers in 1/256 of a pixel, x right and y down from the upper left
corner; the sample of pixel (column, row) is at (256 column + 128, 256 row + 128). Places stay below
`LIMIT`, so that edge functions are exact in 64 bits: 2 * (2 * 2^29)^2 = 2^61.
"""

import numpy as np

from foveal.base.jit import kernel

STEPS = 256  # of one pixel
HALF = 128
PLANES = 5  # near, and four far aside
LIMIT = float(1 << 29)
NARROW = 12  # up to so many columns testing each pixel is quicker than three divisions (measured: 8 to 16)


@kernel
def side(x, y, depth, plane, near, slope):
    """How far a point is inside one of the planes near, left, right, bottom, top."""
    if plane == 0:
        return depth - near
    if plane == 1:
        return slope * depth + x
    if plane == 2:
        return slope * depth - x
    if plane == 3:
        return slope * depth + y
    return slope * depth - y


@kernel
def is_inside(x, y, depth, near, slope):
    """Whether `side` is not negative for any plane: the sign of a sum is exact, so this is the same."""
    return depth >= near and abs(x) <= slope * depth and abs(y) <= slope * depth


@kernel
def place(x, y, depth, pixels_per_radian, width, height, out):
    """The place of a point of the camera's frame. False if it is too far aside to be represented."""
    across = np.floor(STEPS * (0.5 * width + pixels_per_radian * x / depth) + 0.5)
    down = np.floor(STEPS * (0.5 * height - pixels_per_radian * y / depth) + 0.5)
    if not (abs(across) <= LIMIT and abs(down) <= LIMIT):
        return False
    out[0] = np.int32(across)
    out[1] = np.int32(down)
    return True


@kernel
def project(positions, eye, basis, lens, slope, first, last, seen, places, nearness):
    """Vertices to the camera's frame (x right, y up, depth ahead), to places, and to 1 / depth.

    The eye is subtracted first: coordinates of any size keep their precision near it. Nearness 0 marks
    what must be clipped: before the near plane, or further aside than `slope` times its depth. It is
    exactly what `clip` cuts off, so an edge is cut in both of its triangles or in neither.
    """
    pixels_per_radian, width, height, near = lens
    for i in range(first, last):
        dx = positions[i, 0] - eye[0]
        dy = positions[i, 1] - eye[1]
        dz = positions[i, 2] - eye[2]
        x = basis[0, 0] * dx + basis[0, 1] * dy + basis[0, 2] * dz
        y = basis[1, 0] * dx + basis[1, 1] * dy + basis[1, 2] * dz
        depth = -(basis[2, 0] * dx + basis[2, 1] * dy + basis[2, 2] * dz)
        seen[i, 0] = x
        seen[i, 1] = y
        seen[i, 2] = depth
        nearness[i] = 0.0
        if is_inside(x, y, depth, near, slope):
            place(x, y, depth, pixels_per_radian, width, height, places[i])
            nearness[i] = 1.0 / depth


@kernel
def find_bands(faces, seen, places, nearness, lens, band_rows, first, last, bands):
    """The first and last band of rows that each face may touch; (-1, -1): none, (-1, 0): to be clipped."""
    _, width, height, near = lens
    for f in range(first, last):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        bands[f, 0] = -1
        bands[f, 1] = -1
        if nearness[a] == 0.0 or nearness[b] == 0.0 or nearness[c] == 0.0:
            if seen[a, 2] >= near or seen[b, 2] >= near or seen[c, 2] >= near:
                bands[f, 1] = 0
            continue
        left = min(places[a, 0], places[b, 0], places[c, 0])
        right = max(places[a, 0], places[b, 0], places[c, 0])
        top = min(places[a, 1], places[b, 1], places[c, 1])
        bottom = max(places[a, 1], places[b, 1], places[c, 1])
        first_column, last_column = max((left + HALF - 1) >> 8, 0), min((right - HALF) >> 8, width - 1)
        first_row, last_row = max((top + HALF - 1) >> 8, 0), min((bottom - HALF) >> 8, height - 1)
        if first_column <= last_column and first_row <= last_row:
            bands[f, 0] = first_row // band_rows
            bands[f, 1] = last_row // band_rows


@kernel
def count_bands(bands, counts):
    """Add to `counts[band + 1]` for each face and band; returns how many faces are to be clipped."""
    clipped = 0
    for f in range(len(bands)):
        if bands[f, 0] >= 0:
            for band in range(bands[f, 0], bands[f, 1] + 1):
                counts[band + 1] += 1
        elif bands[f, 1] == 0:
            clipped += 1
    return clipped


@kernel
def list_bands(bands, next_entry, entries, clipped):
    """The faces of each band, rising, one band after the other; and those that are to be clipped."""
    count = 0
    for f in range(len(bands)):
        if bands[f, 0] >= 0:
            for band in range(bands[f, 0], bands[f, 1] + 1):
                entries[next_entry[band]] = f
                next_entry[band] += 1
        elif bands[f, 1] == 0:
            clipped[count] = f
            count += 1


@kernel
def _narrow(value, step, left, right):
    """The columns from `left` to `right` where an edge function, `value` at `left`, is not negative."""
    if step > 0:
        if value < 0:
            return left + (-value + step - 1) // step, right
    elif value < 0:
        return left, left - 1
    elif step < 0:
        return left, min(right, left + value // -step)
    return left, right


@kernel
def _edge(places, p, q, x, y):
    """(value at a sample, step a column, bias) of the edge from p to q; inside where value + bias >= 0.

    The top-left rule: a sample on an edge belongs to the triangle to the right of it, or below it.
    """
    px, py = np.int64(places[p, 0]), np.int64(places[p, 1])
    qx, qy = np.int64(places[q, 0]), np.int64(places[q, 1])
    value = (qx - px) * (y - py) - (qy - py) * (x - px)
    is_top_left = qy < py or (qy == py and qx > px)
    return value, -(qy - py) * STEPS, 0 if is_top_left else -1


@kernel
def fill(entries, faces, names, places, nearness, width, first_row, nearest, face_ids):
    """Draw faces into the rows of `nearest` (rows, width), which begin at `first_row`.

    Of several at one sample the nearest stays, of equally near ones the lowest. `names`, if not empty,
    gives the original face of each.
    """
    last_row = first_row + len(nearest) - 1
    for f in entries:
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        area = (np.int64(places[b, 0]) - places[a, 0]) * (np.int64(places[c, 1]) - places[a, 1])
        area -= (np.int64(places[b, 1]) - places[a, 1]) * (np.int64(places[c, 0]) - places[a, 0])
        if area == 0:
            continue
        if area < 0:  # seen from behind: turn it round, both sides are drawn
            b, c, area = c, b, -area
        name = names[f] if len(names) > 0 else f
        near_a, near_b, near_c = nearness[a], nearness[b], nearness[c]
        left = max((min(places[a, 0], places[b, 0], places[c, 0]) + HALF - 1) >> 8, 0)
        right = min((max(places[a, 0], places[b, 0], places[c, 0]) - HALF) >> 8, width - 1)
        top = max((min(places[a, 1], places[b, 1], places[c, 1]) + HALF - 1) >> 8, first_row)
        bottom = min((max(places[a, 1], places[b, 1], places[c, 1]) - HALF) >> 8, last_row)
        x = np.int64(left) * STEPS + HALF
        for row in range(top, bottom + 1):
            y = np.int64(row) * STEPS + HALF
            value_a, step_a, bias_a = _edge(places, b, c, x, y)
            value_b, step_b, bias_b = _edge(places, c, a, x, y)
            value_c, step_c, bias_c = _edge(places, a, b, x, y)
            begin, end = left, right
            if end - begin > NARROW:
                low_a, high_a = _narrow(value_a + bias_a, step_a, left, right)
                low_b, high_b = _narrow(value_b + bias_b, step_b, left, right)
                low_c, high_c = _narrow(value_c + bias_c, step_c, left, right)
                begin, end = max(low_a, low_b, low_c), min(high_a, high_b, high_c)
                value_a += (begin - left) * step_a
                value_b += (begin - left) * step_b
                value_c += (begin - left) * step_c
            for column in range(begin, end + 1):
                if ((value_a + bias_a) | (value_b + bias_b) | (value_c + bias_c)) >= 0:
                    near = (value_a * near_a + value_b * near_b + value_c * near_c) / area
                    stored = nearest[row - first_row, column]
                    if near > stored or (near == stored and name < face_ids[row - first_row, column]):
                        nearest[row - first_row, column] = near
                        face_ids[row - first_row, column] = name
                value_a += step_a
                value_b += step_b
                value_c += step_c
