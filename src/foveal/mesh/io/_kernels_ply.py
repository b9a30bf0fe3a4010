# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the PLY reader: rows with lists in them, to numbers, to triangles."""

import math

import numpy as np

from foveal.base.jit import kernel

# Kinds of fields in a row.
SCALAR, SKIPPED, POLYGON, STRIPS = 0, 1, 2, 3
# What `walk_rows` remembers between calls.
ROW, FIELD, LEFT, SEEN, FIRST, BEFORE, LAST, SMALL, FAULT, USED = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9
POLYGONS = 10  # of the last call
STATE_SIZE = 11
# Faults: a list's count, or an index, that is no such thing.
BAD_COUNT, BAD_INDEX = 1, 2
SIZES = np.array([1, 1, 2, 2, 4, 4, 4, 8, 8, 8])
"""Bytes of int8, uint8, int16, uint16, int32, uint32, float32, float64, int64, uint64."""


@kernel
def _decode(buffer, at, kind, is_big, raw, as_float32, as_float64):
    """The number of type `kind` at `at`; `raw` is 8 bytes of scratch seen as floats by the others."""
    size = SIZES[kind]
    bits = np.uint64(0)
    for i in range(size):
        byte = buffer[at + i] if is_big else buffer[at + size - 1 - i]
        bits = (bits << np.uint64(8)) | np.uint64(byte)
    raw[0] = bits
    if kind == 6:
        return float(as_float32[0])
    if kind == 7:
        return as_float64[0]
    if kind == 9 or kind == 1 or kind == 3 or kind == 5:
        return float(bits)
    shift = np.uint64(64 - 8 * size)
    return float(np.int64(bits << shift) >> np.int64(shift))


@kernel
def decode_rows(buffer, end, kinds, types, count_types, is_big, rows, state, values):
    """Read rows with lists from binary data into `values`, counts included: bytes used, values.

    `state` is the row, the field and the items left of the list that is open (-1 where none is).
    """
    raw = np.zeros(1, dtype=np.uint64)
    as_float32 = raw.view(np.float32)
    as_float64 = raw.view(np.float64)
    at = 0
    count = 0
    row, field, left = state[0], state[1], state[2]
    while row < rows:
        is_list = kinds[field] != SCALAR
        kind = count_types[field] if is_list and left < 0 else types[field]
        if at + SIZES[kind] > end:
            break
        value = _decode(buffer, at, kind, is_big, raw, as_float32, as_float64)
        at += SIZES[kind]
        values[count] = value
        count += 1
        if is_list and left < 0:
            if not 0 <= value <= 1e15:  # told by walk_rows, which meets the same number
                row = rows
                break
            left = np.int64(value)
        elif is_list:
            left -= 1
        if not is_list or left == 0:
            left = -1
            field += 1
            if field == len(kinds):
                field = 0
                row += 1
    state[0], state[1], state[2] = row, field, left
    return at, count


@kernel
def walk_rows(values, kinds, rows, state, scalars, faces, sizes):
    """Follow rows with lists: scalars into `scalars[row]`, triangles into `faces`; how many triangles.

    Polygons are fans around their first corner, and `sizes` has their corners. In strips -1 begins anew
    and every second triangle is turned over. Any number of values may come at a time; `state` remembers
    where the walk is.
    """
    row, field, left, seen = state[ROW], state[FIELD], state[LEFT], state[SEEN]
    first, before, last = state[FIRST], state[BEFORE], state[LAST]
    begin = row
    count = 0
    polygons = 0
    used = 0
    while row < rows and used < len(values):
        value = values[used]
        kind = kinds[field]
        used += 1
        if kind == SCALAR:
            scalars[row - begin, field] = value
        elif left < 0:
            if not 0 <= value <= 1e15 or value != math.floor(value):
                state[FAULT] = BAD_COUNT
                break
            left = np.int64(value)
            seen = 0
            if kind == POLYGON and left >= 3:
                sizes[polygons] = left
                polygons += 1
            state[SMALL] += 1 if kind == POLYGON and left < 3 else 0
        else:
            left -= 1
            if kind != SKIPPED:
                if not abs(value) <= 1e15 or value != math.floor(value):
                    state[FAULT] = BAD_INDEX
                    break
                corner = np.int64(value)
                if kind == STRIPS and corner == -1:
                    seen = 0
                else:
                    if seen == 0:
                        first = corner
                    if seen >= 2:
                        is_turned = kind == STRIPS and seen % 2 == 1
                        faces[count, 0] = first if kind == POLYGON else (last if is_turned else before)
                        faces[count, 1] = before if is_turned else last
                        faces[count, 2] = corner
                        count += 1
                        if kind == STRIPS:
                            sizes[polygons] = 3
                            polygons += 1
                    before = last
                    last = corner
                    seen += 1
        if kind == SCALAR or left == 0:
            left = -1
            field += 1
            if field == len(kinds):
                field = 0
                row += 1
    state[ROW], state[FIELD], state[LEFT], state[SEEN] = row, field, left, seen
    state[FIRST], state[BEFORE], state[LAST], state[USED] = first, before, last, used
    state[POLYGONS] = polygons
    return count
