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
def side_depth(net, depths, entry, k, patches):
    """The depth of side k: the larger of those of its faces, in one placement; of what is not shown -1."""
    f = entry % patches
    beyond = net.mates[4 * f + k]
    if beyond < 0 or depths[entry] < 0:
        return depths[entry]
    return max(depths[entry], depths[entry - f + beyond // 4])


@lean
def edge_depths(net, depths, out):
    """out[4 e + k]: the depth of side k of entry e."""
    for entry in range(len(depths)):
        for k in range(4):
            out[4 * entry + k] = side_depth(net, depths, entry, k, len(net.grid))


@lean
def triangles_at(net, depths, entry, patches):
    """Of an entry."""
    return triangles_of(
        depths[entry],
        side_depth(net, depths, entry, 0, patches),
        side_depth(net, depths, entry, 1, patches),
        side_depth(net, depths, entry, 2, patches),
        side_depth(net, depths, entry, 3, patches),
    )


@lean
def count_triangles(net, depths):
    """Of all entries."""
    total = 0
    for entry in range(len(depths)):
        total += triangles_at(net, depths, entry, len(net.grid))
    return total


@lean
def rise(net, depths, order, upper, budget, total):
    """Take entries in order to their upper depth, as many as a budget allows; `total` are there before."""
    patches = len(net.grid)
    for entry in order:
        depth = depths[entry]
        more = -triangles_around(net, depths, entry, patches)
        depths[entry] = upper[entry]
        more += triangles_around(net, depths, entry, patches)
        if total + more > budget:
            depths[entry] = depth
            break
        total += more


@lean
def triangles_around(net, depths, entry, patches):
    """Of an entry and those beside it, each once."""
    f = entry % patches
    total = triangles_at(net, depths, entry, patches)
    for k in range(4):
        beyond = net.mates[4 * f + k] // 4
        is_first = beyond >= 0
        for j in range(k):
            is_first = is_first and net.mates[4 * f + j] // 4 != beyond
        if is_first:
            total += triangles_at(net, depths, entry - f + beyond, patches)
    return total


@lean
def triangles_of_each(chosen, depths, sides, out):
    """out[entry], of the chosen."""
    for entry in chosen:
        h = 4 * entry
        out[entry] = triangles_of(depths[entry], sides[h], sides[h + 1], sides[h + 2], sides[h + 3])


@lean
def triangles_of(d, first, second, third, fourth):
    """Of a patch of depth d with sides of these depths."""
    if d < 0:
        return 0
    n = 1 << d
    rows, columns = (first > d) + (third > d), (second > d) + (fourth > d)
    if rows + columns == 0:
        return 2 * n * n
    fans = 1 if n == 1 else (rows + columns) * n - rows * columns
    pieces = 4 * fans + (1 << first) + (1 << second) + (1 << third) + (1 << fourth) - 4 * n
    return 2 * (n * n - fans) + pieces + (rows + columns) * 2 * (n - 1)


@lean
def gather_wanted(depths, sides, blocks, rims):
    """The deepest block and rims that any placement wants of each patch; of rims those of fans alone."""
    for entry in range(len(depths)):
        f, d = entry % len(blocks), depths[entry]
        is_fan = False
        for k in range(4):
            side = sides[4 * entry + k]
            if side > d:
                is_fan = True
                rims[4 * f + k] = max(rims[4 * f + k], side)
        blocks[f] = max(blocks[f], d + 1 if is_fan else d)


@lean
def compare(depths, old_depths, sides, old_sides, is_elsewhere, out):
    """Which entries are to be written anew."""
    for entry in range(len(out)):
        is_other = depths[entry] != old_depths[entry]
        for h in range(4 * entry, 4 * entry + 4):
            is_other = is_other or sides[h] != old_sides[h]
        out[entry] = is_other or (is_elsewhere[entry % len(is_elsewhere)] and depths[entry] >= 0)


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
def show_levels(chosen, depths, places, counts, out):
    """The depth of entries `chosen` in each of their rows."""
    for entry in chosen:
        for o in range(places[entry], places[entry] + counts[entry]):
            out[o, 0] = depths[entry]


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
