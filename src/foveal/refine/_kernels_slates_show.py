# mypy: allow-untyped-defs, allow-untyped-calls
"""Triangles of patches, without gaps where depths differ.

A patch's quadrangles along a side beyond which it is deeper become fans: their hub is the limit of the next
step's face point, their rim has the deeper side's points, and where two of them are neighbours along the side
the edge between them is cut at its next limit point. All of these lie in the patch's own block, which is
computed a step deeper than it is shown then, or in the rim of the side.

Based on: Settgast, Müller, Fünfzig, Fellner, section 3.3.
"""

from foveal.base.jit import lean

from ._kernels_slates import side_rows


@lean
def edge_depths(net, depths, out):
    """out[4 f + k]: the depth of side k, the larger of those of its faces; -1 of what is not shown."""
    for h in range(len(out)):
        d = depths[h // 4]
        if net.mates[h] >= 0 and d >= 0:
            d = max(d, depths[net.mates[h] // 4])
        out[h] = d


@lean
def count_triangles(depths, sides, counts):
    """Of each patch; their sum."""
    total = 0
    for f in range(len(depths)):
        counts[f] = triangles_of(depths[f], sides, 4 * f)
        total += counts[f]
    return total


@lean
def triangles_of(d, sides, h):
    """Of a patch of depth d whose sides' depths are sides[h:h + 4]."""
    if d < 0:
        return 0
    n = 1 << d
    rows = (1 if sides[h] > d else 0) + (1 if sides[h + 2] > d else 0)
    columns = (1 if sides[h + 1] > d else 0) + (1 if sides[h + 3] > d else 0)
    if rows + columns == 0:
        return 2 * n * n
    fans = 1 if n == 1 else (rows + columns) * n - rows * columns
    pieces = 4 * fans
    for k in range(4):
        if sides[h + k] > d:
            pieces += (1 << sides[h + k]) - n + 2 * (n - 1)
    return 2 * (n * n - fans) + pieces


@lean
def show(blocks, chosen, depths, sides, places, patches, out):
    """Write triangles of entries `chosen`, patches of placements, to rows places[entry] on."""
    for i in range(len(chosen)):
        entry = chosen[i]
        f, d = entry % patches, depths[entry]
        if d < 0:
            continue
        h = 4 * entry
        is_even = True
        for k in range(4):
            is_even = is_even and sides[h + k] == d
        if is_even:
            show_even(blocks.places[f], blocks.depths[f], d, out, places[entry])
        else:
            show_fans(blocks, f, d, sides[h : h + 4], out, places[entry])


@lean
def show_even(base, deepest, d, out, o):
    """Two triangles for each quadrangle of a patch of depth d, in a block of a depth."""
    stride = 1 << (deepest - d)
    row = stride * ((1 << deepest) + 1)
    for r in range(1 << d):
        for c in range(1 << d):
            a = base + r * row + c * stride
            out[o, 0], out[o, 1], out[o, 2] = a, a + stride, a + stride + row
            out[o + 1, 0], out[o + 1, 1], out[o + 1, 2] = a, a + stride + row, a + row
            o += 2


@lean
def show_fans(blocks, f, d, sides, out, o):
    """The same, with fans along sides that are deeper."""
    n, deepest = 1 << d, blocks.depths[f]
    half = 1 << (deepest - d - 1)  # a block of one step more at least
    row = half * ((1 << deepest) + 1)
    for r in range(n):
        for c in range(n):
            a = blocks.places[f] + 2 * (r * row + c * half)
            is_fan = (r == 0 and sides[0] > d) or (c == n - 1 and sides[1] > d)
            is_fan = is_fan or (r == n - 1 and sides[2] > d) or (c == 0 and sides[3] > d)
            if is_fan:
                o = fan(blocks, f, d, sides, r, c, a, half, row, out, o)
                continue
            b = a + 2 * (row + half)
            out[o, 0], out[o, 1], out[o, 2] = a, a + 2 * half, b
            out[o + 1, 0], out[o + 1, 1], out[o + 1, 2] = a, b, a + 2 * row
            o += 2


@lean
def fan(blocks, f, d, sides, r, c, a, half, row, out, o):
    """A fan around the middle of the quadrangle of row r, column c, whose corner is a."""
    last = (1 << d) - 1
    hub, point = a + half + row, a
    for k in range(4):
        ahead = half if k == 0 else row if k == 1 else -half if k == 2 else -row
        is_border = (k == 0 and r == 0) or (k == 1 and c == last) or (k == 2 and r == last)
        is_border = is_border or (k == 3 and c == 0)
        if is_border and sides[k] > d:
            along = c if k == 0 else r if k == 1 else last - c if k == 2 else last - r
            pieces = 1 << (sides[k] - d)
            for t in range(1, pieces):
                beyond = rim_point(blocks, f, k, along * pieces + t, sides[k])
                out[o, 0], out[o, 1], out[o, 2] = hub, point, beyond
                point = beyond
                o += 1
        elif not is_border and is_cut(sides, d, k, r, c, last):
            out[o, 0], out[o, 1], out[o, 2] = hub, point, point_ahead(a, k, half, row) + ahead
            point = point_ahead(a, k, half, row) + ahead
            o += 1
        end = point_ahead(a, (k + 1) % 4, half, row)
        out[o, 0], out[o, 1], out[o, 2] = hub, point, end
        point = end
        o += 1
    return o


@lean
def point_ahead(a, k, half, row):
    """Corner k of a quadrangle."""
    if k == 0:
        return a
    if k == 1:
        return a + 2 * half
    return a + 2 * (half + row) if k == 2 else a + 2 * row


@lean
def is_cut(sides, d, k, r, c, last):
    """Whether the quadrangles at both sides of inner edge k are fans along one side."""
    if k == 0 or k == 2:
        return (c == 0 and sides[3] > d) or (c == last and sides[1] > d)
    return (r == 0 and sides[0] > d) or (r == last and sides[2] > d)


@lean
def rim_point(blocks, f, k, t, depth):
    """The row of point t of side k at a depth: of the block if that is deep enough, else of the rim."""
    deepest = blocks.depths[f]
    if depth <= deepest:
        begin, onwards = side_rows(k, (1 << deepest) + 1)
        return blocks.places[f] + begin + (t << (deepest - depth)) * onwards
    return blocks.rims[4 * f + k] + (t << (blocks.rim_depths[4 * f + k] - depth))
