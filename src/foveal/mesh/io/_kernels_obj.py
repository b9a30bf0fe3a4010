# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the OBJ reader: one line after the other, by its first word."""

import numpy as np

from foveal.base.jit import kernel

from ._kernels import parse_number

# Bits of `wanted`: which lines are read. Others are passed by, those of vertices counted.
POINTS, UVS, NORMALS, FACES, MATERIALS, TAGS = 1, 2, 4, 8, 16, 32
# `counts`, kept over the whole file: vertices, texture coordinates, normals, corners whose normal is
# not the vertex's own number, polygons of fewer than three corners.
VERTICES, COORDINATES, DIRECTIONS, STRAY, SMALL = 0, 1, 2, 3, 4
COUNTS_SIZE = 5
# `result`, of one call: rows filled, then what stopped it.
POINT_ROWS, UV_ROWS, NORMAL_ROWS, TRIANGLES, POLYGONS, DOUBTS, FAULT, FAULT_AT = 0, 1, 2, 3, 4, 5, 6, 7
RESULT_SIZE = 8
BAD_NUMBERS, BAD_CORNER, BAD_INDEX, STATEMENT = 1, 2, 3, 4
SLOW_COLUMNS = 4  # begin, end, flat index, table (0 points, 1 uvs, 2 normals)


@kernel
def _is_blank(c):
    return c == 32 or c == 9 or c == 92  # a backslash joins this line to the next


@kernel
def _at_end_of_line(buffer, at, end):
    """Whether the line ends at `at`, where a backslash before the line's end does not count."""
    return at >= end or buffer[at] == 10 or buffer[at] == 13 or buffer[at] == 35  # #


@kernel
def _skip_blanks(buffer, at, end):
    while at < end and _is_blank(buffer[at]):
        if buffer[at] == 92:
            while at + 1 < end and (buffer[at + 1] == 13 or buffer[at + 1] == 10):
                at += 1
                if buffer[at] == 10:
                    break
        at += 1
    return at


@kernel
def _parse_row(buffer, at, end, row, slow, doubts, flat, table):
    """Read up to len(row) numbers of a line: where it stops, how many, rows of `slow`."""
    count = 0
    while count < len(row):
        at = _skip_blanks(buffer, at, end)
        if _at_end_of_line(buffer, at, end):
            break
        begin = at
        value, at, is_exact = parse_number(buffer, at, end)
        if not is_exact or (at < end and buffer[at] > 32):
            while at < end and buffer[at] > 32:
                at += 1
            slow[doubts, 0] = begin
            slow[doubts, 1] = at
            slow[doubts, 2] = flat + count
            slow[doubts, 3] = table
            doubts += 1
        row[count] = value
        count += 1
    return at, count, doubts


@kernel
def _parse_index(buffer, at, end):
    """A whole number: its value, where it ends, whether there is one."""
    is_negative = at < end and buffer[at] == 45
    if is_negative:
        at += 1
    begin = at
    value = np.int64(0)
    while at < end and 48 <= buffer[at] <= 57 and at - begin < 18:
        value = value * 10 + np.int64(buffer[at]) - 48
        at += 1
    return -value if is_negative else value, at, at > begin


@kernel
def _parse_corner(buffer, at, end, corner):
    """Read `v`, `v/vt`, `v//vn` or `v/vt/vn` into corner[:3], 0 where absent: where it ends, success."""
    corner[1] = 0
    corner[2] = 0
    corner[0], at, is_good = _parse_index(buffer, at, end)
    for part in range(1, 3):
        if is_good and at < end and buffer[at] == 47:  # /
            at += 1
            if at < end and buffer[at] != 47 and buffer[at] > 32:
                corner[part], at, is_good = _parse_index(buffer, at, end)
    return at, is_good and (at >= end or buffer[at] <= 32 or buffer[at] == 92)


@kernel
def _parse_face(buffer, at, end, counts, triangles, triangle_uvs, sizes, filled, polygons, corner):
    """Read a polygon as a fan: where it stops, triangles and polygons now, and a fault or 0."""
    seen = 0
    first, last, first_uv, last_uv = np.int64(0), np.int64(0), np.int64(0), np.int64(0)
    while True:
        at = _skip_blanks(buffer, at, end)
        if _at_end_of_line(buffer, at, end):
            break
        at, is_good = _parse_corner(buffer, at, end, corner)
        if not is_good:
            return at, filled, polygons, BAD_CORNER
        for part in range(3):  # from 1-based and relative to 0-based, -1 where absent
            corner[part] += counts[part] if corner[part] < 0 else -1
        if corner[0] < 0:
            return at, filled, polygons, BAD_INDEX
        counts[STRAY] += 1 if corner[2] != corner[0] else 0
        if seen == 0:
            first, first_uv = corner[0], corner[1]
        if seen >= 2:
            triangles[filled, 0], triangles[filled, 1], triangles[filled, 2] = first, last, corner[0]
            triangle_uvs[filled, 0], triangle_uvs[filled, 1] = first_uv, last_uv
            triangle_uvs[filled, 2] = corner[1]
            filled += 1
        last, last_uv = corner[0], corner[1]
        seen += 1
    if seen < 3:
        counts[SMALL] += 1
    else:
        sizes[polygons] = seen
        polygons += 1
    return at, filled, polygons, 0


@kernel
def parse_lines(
    buffer, at, wanted, counts, points, uvs, normals, triangles, triangle_uvs, sizes, slow, result
):
    """Read whole lines from `at` on, and return where it stopped: at the end, a fault, a statement.

    A point's row is x, y, z, red, green, blue; red is -1 where the line has no colour.
    """
    end = len(buffer)
    corner = np.zeros(3, dtype=np.int64)
    result[:] = 0
    while at < end:
        at = _skip_blanks(buffer, at, end)
        if at >= end:
            break
        line = at
        c = buffer[at]
        c1 = buffer[at + 1] if at + 1 < end else np.uint8(10)
        c2 = buffer[at + 2] if at + 2 < end else np.uint8(10)
        fault = 0
        if c == 118 and _is_blank(c1):  # v
            if wanted & POINTS:
                i = result[POINT_ROWS]
                row = points[i]
                at, n, result[DOUBTS] = _parse_row(buffer, at + 1, end, row, slow, result[DOUBTS], 6 * i, 0)
                fault = BAD_NUMBERS if n < 3 else 0
                if n < 6:
                    row[3] = -1.0
                result[POINT_ROWS] += 1
            counts[VERTICES] += 1
        elif c == 118 and c1 == 116 and _is_blank(c2):  # vt
            if wanted & UVS:
                i = result[UV_ROWS]
                uvs[i, 1] = 0.0
                at, n, result[DOUBTS] = _parse_row(
                    buffer, at + 2, end, uvs[i], slow, result[DOUBTS], 2 * i, 1
                )
                fault = BAD_NUMBERS if n < 1 else 0
                result[UV_ROWS] += 1
            counts[COORDINATES] += 1
        elif c == 118 and c1 == 110 and _is_blank(c2):  # vn
            if wanted & NORMALS:
                i = result[NORMAL_ROWS]
                row = normals[i]
                at, n, result[DOUBTS] = _parse_row(buffer, at + 2, end, row, slow, result[DOUBTS], 3 * i, 2)
                fault = BAD_NUMBERS if n < 3 else 0
                result[NORMAL_ROWS] += 1
            counts[DIRECTIONS] += 1
        elif c == 102 and _is_blank(c1) and wanted & FACES:  # f
            filled, polygons = result[TRIANGLES], result[POLYGONS]
            at, result[TRIANGLES], result[POLYGONS], fault = _parse_face(
                buffer, at + 1, end, counts, triangles, triangle_uvs, sizes, filled, polygons, corner
            )
        elif wanted & MATERIALS and ((c == 117 and c1 == 115 and c2 == 101) or (c == 109 and c1 == 116)):
            fault = STATEMENT  # use(mtl), mt(llib)
        elif wanted & TAGS and c == 116 and _is_blank(c1):  # t
            fault = STATEMENT
        if fault:
            result[FAULT] = fault
            result[FAULT_AT] = line
            return line
        while at < end and buffer[at] != 10 and buffer[at] != 13:
            at += 1
        while at < end and buffer[at] <= 32:
            at += 1
    return at
