# mypy: allow-untyped-defs, allow-untyped-calls
"""A step of a ring seen from the weights of what comes after, and left eigenvectors by it.

In loops of one order, not as products of matrices: libraries sum these in orders of their own, and the page
is to have the same weights to the last bit.
"""

import math

from foveal.base.jit import lean


@lean
def pull(faces, spokes, sharpness, row, centres, out):
    """Weights on a ring, to `out`, that give what `row` gives on the ring a step on; `centres` is scratch."""
    n = len(spokes)
    for i in range(len(row)):
        out[i] = 0.0
    for i in range(faces):
        centres[i] = row[1 + n + i]
    for i in range(n):
        share, weight = min(spokes[i], 1.0), row[1 + i]
        both = share * weight / 2 + (1 - share) * weight / 4
        out[0] += both
        out[1 + i] += both
        centres[i - 1 if i > 0 else faces - 1] += (1 - share) * weight / 4
        centres[i % faces] += (1 - share) * weight / 4
    pull_vertex(spokes, sharpness, row[0], centres, out)
    for i in range(faces):
        quarter = centres[i] / 4
        out[0] += quarter
        out[1 + i] += quarter
        out[1 + (i + 1) % n] += quarter
        out[1 + n + i] += quarter


@lean
def kind_of(spokes, sharpness, level):
    """Which rule moves the vertex after `level` steps: 0 smooth, 1 crease, 2 corner."""
    count = 0
    for s in spokes:
        count += s > level
    return 2 if sharpness > level or count > 2 else 1 if count == 2 else 0


@lean
def pull_vertex(spokes, sharpness, weight, centres, out):
    """The vertex moves by its rule; by both, weighted, in the step in which the rule changes."""
    kind, then = kind_of(spokes, sharpness, 0.0), kind_of(spokes, sharpness, 1.0)
    if kind == then:
        pull_rule(spokes, 0.0, kind, weight, centres, out)
        return
    total, count = 0.0, 0
    for s in spokes:
        if 0 < s <= 1:
            total += s
            count += 1
    if 0 < sharpness <= 1:
        total += sharpness
        count += 1
    share = min(total / count, 1.0)
    pull_rule(spokes, 0.0, kind, share * weight, centres, out)
    pull_rule(spokes, 1.0, then, (1 - share) * weight, centres, out)


@lean
def pull_rule(spokes, level, kind, weight, centres, out):
    """One rule, of the spokes sharper than `level`."""
    n = len(spokes)
    if kind == 2:
        out[0] += weight
    elif kind == 1:
        out[0] += 0.75 * weight
        for i in range(n):
            if spokes[i] > level:
                out[1 + i] += weight / 8
    else:
        out[0] += weight * (n - 2) / n
        for i in range(n):
            out[1 + i] += weight / (n * n)
            centres[i] += weight / (n * n)


@lean
def settle_point(spokes, turns, row, centres, out):
    """The limit point of a dart: `row` pulled back until it stays."""
    n = len(spokes)
    for _ in range(turns):
        pull(n, spokes, 0.0, row, centres, out)
        total = 0.0
        for w in out:
            total += w
        for i in range(len(row)):
            row[i] = out[i] / total


@lean
def settle_tangent(spokes, turns, point, row, centres, out):
    """Of the vectors that the reflection which keeps e_0 keeps, the one after the limit point.

    What belongs to the point has the sum of its weights, since a ring that is one point stays there.
    """
    n = len(spokes)
    for _ in range(turns):
        pull(n, spokes, 0.0, row, centres, out)
        row[0] = out[0]
        for i in range(n):
            row[1 + i] = 0.5 * (out[1 + i] + out[1 + (n - i) % n])
            row[1 + n + i] = 0.5 * (out[1 + n + i] + out[1 + n + n - 1 - i])
        total, square = 0.0, 0.0
        for w in row:
            total += w
        for i in range(len(row)):
            row[i] -= total * point[i]
            square += row[i] * row[i]
        length = math.sqrt(square)
        for i in range(len(row)):
            row[i] /= length
