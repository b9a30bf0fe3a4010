# mypy: allow-untyped-defs, allow-untyped-calls
"""What a vertex is expected to be, from what was decoded before it. Whole numbers only.

Differences of int32 may not fit an int32; they are kept modulo 2^32, which sums undo.
"""

import numpy as np

from foveal.base.jit import kernel


@kernel
def _wrapped(value):
    """`value` modulo 2^32, as an int32 has it."""
    return ((value + 0x80000000) & 0xFFFFFFFF) - 0x80000000


@kernel
def residuals(values, corners, base, out):
    """out[i] = values[i] - (values[a] + values[b] - values[apex]); corners of -1 mean `base`."""
    for i in range(len(values)):
        a, b, apex = corners[i]
        for j in range(values.shape[1]):
            if a < 0:
                out[i, j] = _wrapped(np.int64(values[i, j]) - base[j])
            else:
                guess = np.int64(values[a, j]) + values[b, j] - values[apex, j]
                out[i, j] = _wrapped(values[i, j] - guess)


@kernel
def restore(values, corners, base):
    """Inverse of `residuals`, in place."""
    for i in range(len(values)):
        a, b, apex = corners[i]
        for j in range(values.shape[1]):
            if a < 0:
                values[i, j] = _wrapped(values[i, j] + base[j])
            else:
                guess = np.int64(values[a, j]) + values[b, j] - values[apex, j]
                values[i, j] = _wrapped(values[i, j] + guess)


@kernel
def guess_normals(positions, faces, most, sums, out):
    """Octahedral normals in [-most, most] of the sum of each vertex's triangles; sums (n, 3) is zero.

    Sums are modulo 2^64, which only coordinates beyond 2^29 can reach: a bad guess then, but the same
    when encoding and decoding.
    """
    edge = np.empty((2, 3), np.int64)
    for f in range(len(faces)):
        for j in range(3):
            at = np.int64(positions[faces[f, 0], j])
            edge[0, j] = positions[faces[f, 1], j] - at
            edge[1, j] = positions[faces[f, 2], j] - at
        for j in range(3):
            k = (j + 1) % 3
            o = (j + 2) % 3
            area = edge[0, k] * edge[1, o] - edge[0, o] * edge[1, k]
            for corner in range(3):
                sums[faces[f, corner], j] += area
    for i in range(len(sums)):
        x, y, z = sums[i]
        while max(x, y, z) >= 1 << 40 or min(x, y, z) <= -(1 << 40):
            x >>= 1
            y >>= 1
            z >>= 1
        total = abs(x) + abs(y) + abs(z)
        if total == 0:
            out[i, 0] = 0
            out[i, 1] = 0
            continue
        if z < 0:
            u = (total - abs(y)) * (1 if x >= 0 else -1)
            v = (total - abs(x)) * (1 if y >= 0 else -1)
        else:
            u = x
            v = y
        out[i, 0] = (2 * u * most + total) // (2 * total)
        out[i, 1] = (2 * v * most + total) // (2 * total)


@kernel
def to_luma(colours, out):
    """Y, Cb, Cr by the reversible transform of JPEG 2000: Y = (R + 2 G + B) / 4, Cb = B - G, Cr = R - G."""
    for i in range(len(colours)):
        r = np.int32(colours[i, 0])
        g = np.int32(colours[i, 1])
        b = np.int32(colours[i, 2])
        out[i, 0] = (r + 2 * g + b) >> 2
        out[i, 1] = b - g
        out[i, 2] = r - g


@kernel
def from_luma(values, colours):
    """Inverse of `to_luma`; False if a value is no colour."""
    for i in range(len(values)):
        y = np.int64(values[i, 0])
        cb = np.int64(values[i, 1])
        cr = np.int64(values[i, 2])
        g = y - ((cb + cr) >> 2)
        r = cr + g
        b = cb + g
        if min(r, g, b) < 0 or max(r, g, b) > 255:
            return False
        colours[i, 0] = r
        colours[i, 1] = g
        colours[i, 2] = b
    return True
