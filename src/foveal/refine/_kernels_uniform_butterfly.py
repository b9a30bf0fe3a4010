# mypy: allow-untyped-defs, allow-untyped-calls
"""New vertices by the modified butterfly scheme with tension w = 0; old ones never move.

Based on: D. Zorin, P. Schröder, W. Sweldens. Interpolating subdivision for meshes with arbitrary topology.
SIGGRAPH 1996, section 3. The border is ours where the paper says nothing: see `foveal.refine.butterfly`.
"""

import math

from foveal.base.jit import kernel

from ._kernels_uniform import around, ends, opposite


@kernel
def butterfly_midpoints(faces, edges, halves, positions, valences, is_border, before, after, out):
    """The new vertex of each edge. `before` and `after` are the border's neighbours of its vertices."""
    for e in range(len(halves)):
        h, g = halves[e, 0], halves[e, 1]
        a, b, _ = ends(faces, h)
        if g < 0:
            p, q = before[a], after[b]
            for axis in range(3):
                out[e, axis] = 0.5625 * (positions[a, axis] + positions[b, axis]) - 0.0625 * (
                    positions[p, axis] + positions[q, axis]
                )
            continue
        is_odd_a = not is_border[a] and valences[a] != 6
        is_odd_b = not is_border[b] and valences[b] != 6
        for axis in range(3):
            out[e, axis] = 0.0
        share = 0.5 if is_odd_a and is_odd_b else 1.0
        if is_odd_a:
            add_star(faces, edges, halves, positions, h, valences[a], share, out[e])
        if is_odd_b:
            add_star(faces, edges, halves, positions, g, valences[b], share, out[e])
        if not is_odd_a and not is_odd_b:
            add_wings(faces, edges, halves, positions, h, out[e])
            add_wings(faces, edges, halves, positions, g, out[e])


@kernel
def add_wings(faces, edges, halves, positions, h, out):
    """Half of the regular stencil: 1/4 for each end, 1/8 across the face of h, -1/16 for its two wings.

    A wing beyond the border is the reflection of the vertex across: it completes a parallelogram.
    """
    a, b, c = ends(faces, h)
    for axis in range(3):
        out[axis] += 0.25 * (positions[a, axis] + positions[b, axis]) + 0.125 * positions[c, axis]
    for side in range(2):
        i = around(h) if side == 0 else around(around(h))
        j = opposite(edges, halves, i)
        if j >= 0:
            _, _, w = ends(faces, j)
            for axis in range(3):
                out[axis] -= 0.0625 * positions[w, axis]
        else:
            u, v, w = ends(faces, i)
            for axis in range(3):
                out[axis] -= 0.0625 * (positions[u, axis] + positions[v, axis] - positions[w, axis])


@kernel
def add_star(faces, edges, halves, positions, h, n, share, out):
    """The stencil of the vertex of valence n that h leaves, towards the end of h, times `share`."""
    v, _, _ = ends(faces, h)
    for axis in range(3):
        out[axis] += 0.75 * share * positions[v, axis]
    for j in range(n):
        _, b, _ = ends(faces, h)
        s = share * star_weight(j, n)
        for axis in range(3):
            out[axis] += s * positions[b, axis]
        h = opposite(edges, halves, around(around(h)))


@kernel
def star_weight(j, n):
    """The weight of ring vertex j of n, where j = 0 is the edge's other end; they add up to 1/4."""
    if n == 2:  # two triangles back to back: the paper has no such vertex; with both ends alike, the middle
        return 0.25 if j == 0 else 0.0
    if n == 3:
        return 5.0 / 12.0 if j == 0 else -1.0 / 12.0
    if n == 4:
        return 0.375 if j == 0 else (-0.125 if j == 2 else 0.0)
    angle = 2.0 * math.pi * j / n
    return (0.25 + math.cos(angle) + 0.5 * math.cos(2.0 * angle)) / n
