# mypy: allow-untyped-defs, allow-untyped-calls
"""Statistics over many patches: sums for least squares, counts of symbols."""

import numpy as np

from foveal.base.jit import kernel
from foveal.coding._kernels_rans import STATE_B

from ._kernels_encode import NUMBER
from ._kernels_geometry import degree_class, predict, settled
from ._kernels_layout import DEGREES, ESCAPE, FIRST, MET, MIDDLE, SPLIT, START, WALK_AT, WALK_FAR


@kernel
def accumulate(positions, degree, corners, vertices, weights, turn, squares, products):
    """Add every predicted vertex to the normal equations of its kind.

    What is fitted is the difference from the parallelogram b - o, relative to the size of the triangles
    there; in the second turn a vertex that `weights` predict badly counts less.
    """
    points = np.empty((4, 3))
    rows = np.empty(4, np.int64)
    for v in range(vertices):
        if corners[v, 5] == FIRST:
            continue
        x, y, z, _, _, _, size = predict(positions, degree, v, corners[v], weights)
        kind = settled(corners[v, 5])
        a = corners[v, 0]
        rows[0] = 0
        rows[1] = 1 + degree_class(degree[a])
        rows[2] = 1 + DEGREES + degree_class(degree[corners[v, 1]])
        rows[3] = 1 + 2 * DEGREES + degree_class(degree[v])
        for i in range(4):
            for axis in range(3):
                points[i, axis] = float(positions[corners[v, 1 + i], axis]) - positions[a, axis]
        weight = 1.0 / (1.0 + size) ** 2
        if turn > 0:
            off = abs(positions[v, 0] - x) + abs(positions[v, 1] - y) + abs(positions[v, 2] - z)
            weight = 1.0 / ((1.0 + size) * (2.0 + off))
        for i in range(16):
            row = 4 * rows[i >> 2] + (i & 3)
            p = points[i & 3]
            total = 0.0
            for axis in range(3):
                target = float(positions[v, axis]) - positions[a, axis] - points[0, axis] + points[1, axis]
                total += p[axis] * target
            products[kind, row] += weight * total
            for j in range(16):
                q = points[j & 3]
                squares[kind, row, 4 * rows[j >> 2] + (j & 3)] += weight * (
                    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
                )


@kernel
def magnitudes(contexts, values, sums):
    """sums[context] += (1, |value|)."""
    for i in range(len(contexts)):
        if contexts[i] != NUMBER:
            context = contexts[i] & ~STATE_B
            sums[context, 0] += 1
            sums[context, 1] += min(abs(values[i]), 1 << 20)


@kernel
def count_values(contexts, values, shift_of, counts):
    """Count the symbols that values become."""
    for i in range(len(contexts)):
        if contexts[i] != NUMBER:
            context = contexts[i] & ~STATE_B
            symbol = (values[i] >> np.int64(shift_of[context])) + MIDDLE
            if symbol < 0 or symbol >= ESCAPE:
                symbol = ESCAPE
            counts[context, symbol] += 1


@kernel
def count_codes(codes, code_contexts, extra, counts):
    """Count codes and walks."""
    e = 0
    for i in range(len(codes)):
        code = codes[i]
        if code == START:
            pattern = extra[e]
            e += 1
            for k in range(3):
                if not pattern >> k & 1:
                    e += 1
            continue
        counts[code_contexts[i], code] += 1
        if code == SPLIT:
            counts[WALK_AT, extra[e]] += 1
            e += 2 if extra[e] == WALK_FAR else 1
        elif code == MET:
            e += 1
