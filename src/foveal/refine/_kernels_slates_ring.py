# mypy: allow-untyped-defs, allow-untyped-calls
"""The ring of a control vertex, a step further. It depends on nothing outside itself.

Sums run in the ring's own order, or over pairs across from each other, so that they are the same numbers
whichever patch computes them; those of points that are in the table too are written as there.
"""

from foveal.base.jit import lean

from ._kernels_slates_layout import REGULAR, TAGGED


@lean
def fill_ring(net, points, v, out, o):
    """Copy v and its ring to words o on."""
    for x in range(3):
        out[o + x] = points[v, x]
    begin = net.ring_starts[v]
    for j in range(net.ring_starts[v + 1] - begin):
        for x in range(3):
            out[o + 3 * (j + 1) + x] = points[net.ring[begin + j], x]


@lean
def ring_step(net, v, level, a, i, b, o):
    """From words i on of a to words o on of b; `level` steps were done before."""
    faces = net.fans[v]
    begin = net.ring_starts[v]
    spokes = net.ring_starts[v + 1] - begin - faces
    is_tagged = net.kinds[v] == TAGGED
    f, g = i + 3 * (1 + spokes), o + 3 * (1 + spokes)
    for j in range(faces):
        e = i + 3 * (1 + j)
        following = e + 3 if j + 1 < spokes else i + 3
        for x in range(3):
            b[g + 3 * j + x] = 0.25 * ((a[i + x] + a[f + 3 * j + x]) + (a[e + x] + a[following + x]))
    for j in range(spokes):
        share = min(max(net.spokes[begin + j] - level, 0.0), 1.0) if is_tagged else 0.0
        e = 3 * (1 + j)
        before, after = g + 3 * (j - 1 if j > 0 else faces - 1), g + 3 * (j if j < faces else 0)
        for x in range(3):
            middle = 0.5 * (a[i + x] + a[i + e + x])
            if share < 1.0:
                smooth = 0.25 * ((a[i + x] + a[i + e + x]) + (b[before + x] + b[after + x]))
                middle = smooth if share == 0.0 else share * middle + (1.0 - share) * smooth
            b[o + e + x] = middle
    if is_tagged:
        move_tagged(net, v, level, a, i, b, o)
    else:
        move_smooth(net, v, a, i, b, o, 1.0)


@lean
def move_smooth(net, v, a, i, b, o, share):
    """Add `share` times the smooth rule's point to what `share` leaves of the vertex."""
    faces = net.fans[v]
    f = o + 3 * (1 + faces)
    kept, part = (faces - 2.0) / faces, 1.0 / (faces * faces)
    for x in range(3):
        if net.kinds[v] == REGULAR:
            e = i + 3 + x
            spokes = (a[e] + a[e + 6]) + (a[e + 3] + a[e + 9])
            centres = (b[f + x] + b[f + 6 + x]) + (b[f + 3 + x] + b[f + 9 + x])
            b[o + x] = 0.5 * a[i + x] + 0.0625 * (spokes + centres)
            continue
        total = 0.0
        for j in range(faces):
            total += a[i + 3 * (1 + j) + x] + b[f + 3 * j + x]
        point = kept * a[i + x] + part * total
        b[o + x] = point if share == 1.0 else b[o + x] + share * point


@lean
def rule_of(net, v, level):
    """0 smooth, 1 crease, 2 corner; and of a crease which two spokes."""
    begin = net.ring_starts[v]
    count, first, second = 0, 0, 0
    for j in range(net.ring_starts[v + 1] - begin - net.fans[v]):
        if net.spokes[begin + j] > level:
            count += 1
            first, second = second, j
    if net.vertex_sharp[v] > level or count > 2:
        return 2, 0, 0
    return (1 if count == 2 else 0), first, second


@lean
def blend(net, v, level):
    """How much of the present rule, where the next one is another: the mean of what ends now, at most 1."""
    begin = net.ring_starts[v]
    total, count = 0.0, 0
    for j in range(net.ring_starts[v + 1] - begin - net.fans[v]):
        left = net.spokes[begin + j] - level
        if 0.0 < left <= 1.0:
            total += left
            count += 1
    left = net.vertex_sharp[v] - level
    if 0.0 < left <= 1.0:
        total += left
        count += 1
    return min(total / count, 1.0)


@lean
def move_tagged(net, v, level, a, i, b, o):
    """By the vertex's rule; by both, weighted, in the step in which the rule changes."""
    rule, first, second = rule_of(net, v, level)
    then, later, latest = rule_of(net, v, level + 1)
    share = 1.0 if rule == then else blend(net, v, level)
    for x in range(3):
        b[o + x] = 0.0
    for turn in range(2):
        if share > 0.0:
            if rule == 0:
                move_smooth(net, v, a, i, b, o, share)
            else:
                for x in range(3):
                    point = a[i + x]
                    if rule == 1:
                        ends = a[i + 3 * (1 + first) + x] + a[i + 3 * (1 + second) + x]
                        point = 0.75 * point + 0.125 * ends
                    b[o + x] += share * point
        if turn == 0:
            rule, first, second, share = then, later, latest, 1.0 - share
