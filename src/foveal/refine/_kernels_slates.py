# mypy: allow-untyped-defs, allow-untyped-calls
"""Patches by two slates: a step from one into the other until the depth is reached, then limit points.

A table of depth d is 2^d + 3 points a side: the patch and a ring around it. Inside, one rule for all; sides
that are sharp and corners of other than four smooth faces are done anew after each step. Every sum is one
that does not change when the patch is turned, and a limit is taken in the step in which its point is new,
so that two patches agree on a border to the last bit, whatever their depths are.

Based on: V. Settgast, K. Müller, Chr. Fünfzig, D. Fellner. Adaptive tessellation of subdivision surfaces,
section 3.2; the rules of E. Catmull, J. Clark 1978, the limits of M. Halstead, M. Kass, T. DeRose 1993.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_slates_layout import LANES, LIMIT_SHARE, REGULAR, WORDS
from ._kernels_slates_ring import fill_ring, ring_step
from ._kernels_slates_sides import frame, side_point, side_step


@lean
def tessellate(net, work, points, corner_points, corner_normals, patches, places, depth, out, is_surface):
    """(2^depth + 1)^2 rows of `out` for each of `patches`, from row `places` on; row by row of the patch."""
    words = work.rings.shape[1] // 4 * 3  # WORDS, but not as a constant: see `step`
    for first in range(0, len(patches), LANES):
        lanes = min(LANES, len(patches) - first)
        for lane in range(LANES):  # lanes without a patch do the last one's work again
            f = patches[first + min(lane, lanes - 1)]
            for i in range(16):
                for x in range(3):
                    work.slates[0, i * WORDS + x * LANES + lane] = points[net.grid[f, i], x]
        is_plain = gather_corners(net, work, points, patches, first, lanes)
        n = 4
        for level in range(depth):
            a, b = work.slates[level & 1], work.slates[1 - (level & 1)]
            step(a, b, n, words)
            if not is_plain:
                mend(net, work, patches, first, lanes, level, a, b, n)
            n = 2 * n - 3
            limits(b, n, work.limits, places, first, lanes, words, depth - level - 1, out, is_surface)
            if not is_plain:
                side_limits(net, b, n, patches, places, first, lanes, level + 1, depth, out, is_surface)
        for lane in range(lanes):
            corner_limits(
                net, corner_points, corner_normals, patches[first + lane], places[first + lane], depth, out,
                is_surface,
            )  # fmt: skip


@lean
def gather_corners(net, work, points, patches, first, lanes):
    """Fill the rings of corners that need them; whether there is nothing but the table's rule."""
    is_plain = True
    for lane in range(lanes):
        for k in range(4):
            h = 4 * patches[first + lane] + k
            if net.kinds[net.corners[h]] != REGULAR:
                is_plain = False
                fill_ring(net, points, net.corners[h], work.rings[0, 4 * lane + k], 0)
    return is_plain  # a sharp side has tagged corners


@lean
def step(a, b, size, words):
    """From a table of `size` a side to one of 2 size - 3: face points, then edge points and old vertices.

    Indices are unsigned, since a signed one may count from the end and is asked each time, and `words` is
    no constant, since a short loop of known length is unrolled and then not made of vectors: 1.6 times as
    fast with both.
    """
    n, w, zero = np.uint64(size), np.uint64(words), np.uint64(0)
    last, two = np.uint64(size - 1), np.uint64(2 * words)
    row, after = n * w, np.uint64(2 * size - 3) * w
    for r in range(last):
        for c in range(last):
            p, q = r * row + c * w, r * (after + after) + c * two
            right, below, across = p + w, p + row, p + row + w
            for k in range(w):
                b[q + k] = 0.25 * ((a[p + k] + a[across + k]) + (a[right + k] + a[below + k]))
    for r in range(last):
        for c in range(last):
            p, q = r * row + c * w, r * (after + after) + c * two
            up, back, right, below = q - after - after, q - two, p + w, p + row
            if r > zero:
                o = q - after
                for k in range(w):
                    b[o + k] = 0.25 * ((a[p + k] + a[right + k]) + (b[q + k] + b[up + k]))
            if c > zero:
                o = q - w
                for k in range(w):
                    b[o + k] = 0.25 * ((a[p + k] + a[below + k]) + (b[q + k] + b[back + k]))
            if r > zero and c > zero:
                far, left, above, o = up - two, p - w, p - row, q - after - w
                for k in range(w):
                    edges = (a[right + k] + a[left + k]) + (a[below + k] + a[above + k])
                    centres = (b[q + k] + b[far + k]) + (b[up + k] + b[back + k])
                    b[o + k] = 0.5 * a[p + k] + 0.0625 * (edges + centres)


@lean
def mend(net, work, patches, first, lanes, level, a, b, n):
    """After a step: what is sharp on sides, then corners with their two spokes outside the patch."""
    for lane in range(lanes):
        for k in range(4):
            h = 4 * patches[first + lane] + k
            share = min(net.sharp[h] - level, 1.0)
            if share > 0.0:
                side_step(k, share, lane, a, n, b)
        for k in range(4):
            h = 4 * patches[first + lane] + k
            v = net.corners[h]
            if net.kinds[v] == REGULAR:
                continue
            ring = work.rings[1 - (level & 1), 4 * lane + k]
            ring_step(net, v, level, work.rings[level & 1, 4 * lane + k], 0, ring, 0)
            q, ahead, inside = frame(k, 2 * n - 3)
            put(ring, 0, b, q + lane)
            spokes = net.ring_starts[v + 1] - net.ring_starts[v] - net.fans[v]
            o, is_open = net.place[h], spokes > net.fans[v]
            # No remainders: a division each took a tenth of the time of a ring's step.
            if o > 0 or not is_open:
                put(ring, 3 * (o if o > 0 else spokes), b, q - inside + lane)
            if o + 2 < spokes:
                put(ring, 3 * (o + 3), b, q - ahead + lane)
            elif not is_open:
                put(ring, 3 * (o + 3 - spokes), b, q - ahead + lane)


@lean
def put(ring, i, table, q):
    """A point of a ring into a lane of the table."""
    for x in range(3):
        table[q + x * LANES] = ring[i + x]


@lean
def limits(a, n, scratch, places, first, lanes, words, left, out, is_surface):
    """Limit points and normals by the rule of four faces, of points new in this step; `left` are to do."""
    w, row, size = np.uint64(words), np.uint64(n * words), ((n - 3) << left) + 1
    two = w + w
    for r in range(1, n - 1):
        for c in range(1 + r % 2, n - 1, 1 + r % 2):
            p = np.uint64(r * n * words + c * words)
            e0, e1, e2, e3 = p + w, p + row, p - w, p - row
            f0, f1, f2, f3 = e1 + w, e1 - w, e3 - w, e3 + w
            for k in range(w):
                edges = (a[e0 + k] + a[e2 + k]) + (a[e1 + k] + a[e3 + k])
                diagonal = (a[f0 + k] + a[f2 + k]) + (a[f1 + k] + a[f3 + k])
                scratch[k] = (16.0 * a[p + k] + 4.0 * edges + diagonal) * LIMIT_SHARE
            for k in range(w):
                over = (a[f0 + k] + a[f3 + k]) - (a[f1 + k] + a[f2 + k])
                scratch[w + k] = 4.0 * (a[e0 + k] - a[e2 + k]) + over
            for k in range(w):
                over = (a[f0 + k] + a[f1 + k]) - (a[f2 + k] + a[f3 + k])
                scratch[two + k] = 4.0 * (a[e1 + k] - a[e3 + k]) + over
            if is_surface:
                cross(scratch)
            i = ((r - 1) << left) * size + ((c - 1) << left)
            for lane in range(lanes):
                o = np.uint64(places[first + lane] + i)
                put_row(out.positions, o, scratch, lane)
                if is_surface:
                    put_row(out.normals, o, scratch, 3 * WORDS + lane)


@lean
def put_row(rows, o, scratch, k):
    """One lane's three numbers."""
    rows[o, 0], rows[o, 1], rows[o, 2] = scratch[k], scratch[k + LANES], scratch[k + 2 * LANES]


@lean
def cross(scratch):
    """Unit normals of the two tangents; zero where they have no direction."""
    for k in range(LANES):
        ax, ay, az = scratch[WORDS + k], scratch[WORDS + LANES + k], scratch[WORDS + 2 * LANES + k]
        b = 2 * WORDS + k
        bx, by, bz = scratch[b], scratch[b + LANES], scratch[b + 2 * LANES]
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        length = np.sqrt(x * x + y * y + z * z)
        share = 1.0 / length if length > 0.0 else 0.0
        o = 3 * WORDS + k
        # The zero added makes -0 the other zero.
        scratch[o], scratch[o + LANES], scratch[o + 2 * LANES] = (
            x * share + 0.0,
            y * share + 0.0,
            z * share + 0.0,
        )


@lean
def side_limits(net, a, n, patches, places, first, lanes, level, depth, out, is_surface):
    """Points new inside sharp sides anew."""
    size, stride = (1 << depth) + 1, 1 << (depth - level)
    for lane in range(lanes):
        for k in range(4):
            h = 4 * patches[first + lane] + k
            left = net.sharp[h] - level
            if not left > 0.0:
                continue
            p, ahead, inside = frame(k, n)
            mask = net.side_masks[net.side_class[h], level]
            row, onwards = side_rows(k, size)
            for i in range(1, n - 3, 2):
                o = places[first + lane] + row + i * stride * onwards
                side_point(
                    a, p + i * ahead + lane, LANES, ahead, inside, left, mask, is_surface, out.positions,
                    out.normals, o,
                )  # fmt: skip


@lean
def side_rows(k, size):
    """Of side k in a patch's block of size by size rows: its first row, and from point to point."""
    if k == 0:
        return 0, 1
    if k == 1:
        return size - 1, size
    if k == 2:
        return size * size - 1, -1
    return size * (size - 1), -size


@lean
def corner_limits(net, corner_points, corner_normals, f, place, depth, out, is_surface):
    """The four corners, which were computed once for all patches."""
    size = (1 << depth) + 1
    for k in range(4):
        row, _ = side_rows(k, size)
        h = 4 * f + k
        for x in range(3):
            out.positions[place + row, x] = corner_points[net.corners[h], x]
            if is_surface:
                out.normals[place + row, x] = corner_normals[net.normal_of[h], x]
