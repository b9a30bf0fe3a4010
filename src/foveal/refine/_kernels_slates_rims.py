# mypy: allow-untyped-defs, allow-untyped-calls
"""The points of one side of a patch at any depth, by a slate of three rows: outside, on it, inside.

A step needs no more than these, so the work is linear in the points. Corners come from their rings on both
ends; all rules are written as in the table, so that the numbers are those the deeper patch beyond has.
"""

from foveal.base.jit import lean

from ._kernels_slates_ring import fill_ring, ring_step
from ._kernels_slates_sides import side_point


@lean
def rims(net, work, points, corner_points, corner_normals, sides, depths, places, out, is_surface):
    """2^depth + 1 rows of `out` for each of `sides`, corner to corner, with the normals of its own patch."""
    for i in range(len(sides)):
        h, depth, place = sides[i], depths[i], places[i]
        f = h - h % 4
        after = f + (h + 1) % 4
        start_rim(net, work, points, h, after)
        n = 2
        for level in range(depth):
            rim_step(net, work, h, after, level, n)
            n = 2 * n - 1
            left, stride = net.sharp[h] - level - 1, 1 << (depth - level - 1)
            mask = net.side_masks[net.side_class[h], level + 1]
            for c in range(1, n - 1, 2):
                side_point(
                    work.slates[1 - (level & 1)], 3 * (n + c), 1, 3, 3 * n, left, mask, is_surface,
                    out.positions, out.normals, place + c * stride,
                )  # fmt: skip
        for end in range(2):
            corner, o = (after if end else h), place + (end << depth)
            for x in range(3):
                out.positions[o, x] = corner_points[net.corners[corner], x]
                if is_surface:
                    out.normals[o, x] = corner_normals[net.normal_of[corner], x]


@lean
def start_rim(net, work, points, h, after):
    """Rows of two points, and the rings of both ends in work.rings."""
    a = work.slates[0]
    for end in range(2):
        corner = after if end else h
        fill_ring(net, points, net.corners[corner], work.rings[0, end], 0)
        put_end(net, corner, end, work.rings[0, end], a, 2)


@lean
def put_end(net, corner, end, ring, a, n):
    """An end's three points into rows of n; what is absent outside is the corner itself."""
    v = net.corners[corner]
    spokes = net.ring_starts[v + 1] - net.ring_starts[v] - net.fans[v]
    is_open = spokes > net.fans[v]
    # Seen from the first end the side is spoke o and o + 1 is inside; from the second it is o + 1, o inside.
    inside, outside = net.place[corner] + (1 - end), net.place[corner] + (2 if end else -1)
    is_absent = is_open and not 0 <= outside < spokes
    i, o = 3 * (1 + inside % spokes), 0 if is_absent else 3 * (1 + outside % spokes)
    at = 3 * (n - 1) * end
    for x in range(3):
        a[at + x], a[3 * n + at + x], a[6 * n + at + x] = ring[o + x], ring[x], ring[i + x]


@lean
def rim_step(net, work, h, after, level, n):
    """From rows of n points to rows of 2 n - 1."""
    a, b = work.slates[level & 1], work.slates[1 - (level & 1)]
    m = 3 * (2 * n - 1)
    share = min(max(net.sharp[h] - level, 0.0), 1.0)
    for r in range(2):  # face points: in rows 0 and 2
        for c in range(n - 1):
            p, q = 3 * (r * n + c), 2 * r * m + 6 * c + 3
            for x in range(p, p + 3):
                b[q + x - p] = 0.25 * ((a[x] + a[x + 3 * n + 3]) + (a[x + 3] + a[x + 3 * n]))
    for c in range(n - 1):
        for x in range(3):
            p, q = 3 * (n + c) + x, m + 6 * c + x
            middle = 0.5 * (a[p] + a[p + 3])
            smooth = 0.25 * ((a[p] + a[p + 3]) + (b[q + 3 + m] + b[q + 3 - m]))
            b[q + 3] = mixed(share, middle, smooth)
            if c > 0:
                b[q - m] = 0.25 * ((a[p - 3 * n] + a[p]) + (b[q - m + 3] + b[q - m - 3]))
                b[q + m] = 0.25 * ((a[p] + a[p + 3 * n]) + (b[q + m + 3] + b[q + m - 3]))
                edges = (a[p + 3] + a[p - 3]) + (a[p + 3 * n] + a[p - 3 * n])
                centres = (b[q + m + 3] + b[q - m - 3]) + (b[q - m + 3] + b[q + m - 3])
                crease = 0.75 * a[p] + 0.125 * (a[p - 3] + a[p + 3])
                b[q] = mixed(share, crease, 0.5 * a[p] + 0.0625 * (edges + centres))
    for end in range(2):
        corner = after if end else h
        ring = work.rings[1 - (level & 1), end]
        ring_step(net, net.corners[corner], level, work.rings[level & 1, end], 0, ring, 0)
        put_end(net, corner, end, ring, b, 2 * n - 1)


@lean
def mixed(share, sharp, smooth):
    """As far as it is sharp the one, else the other."""
    if share == 0.0:
        return smooth
    return sharp if share == 1.0 else share * sharp + (1.0 - share) * smooth
