# mypy: allow-untyped-defs, allow-untyped-calls
"""Rings of a polygon mesh: the corners of faces around each vertex, counter-clockwise.

A corner of a face stands also for the edge from it to the next corner.
"""

from foveal.base.jit import lean


@lean
def rings(corners, previous, mates, first, starts, ring, place):
    """ring[starts[v]:starts[v + 1]]: the corners at v from first[v] on; place[h]: where h is among them."""
    for v in range(len(starts) - 1):
        h = first[v]
        for i in range(starts[v + 1] - starts[v]):
            ring[starts[v] + i] = h
            place[h] = i
            h = mates[previous[h]]


@lean
def fill_rings(corners, mates, sharp, fan_starts, fan, ring_starts, ring, spokes):
    """Of quadrangles: the ring's vertices, e then f, and the sharpness of the spokes."""
    for v in range(len(fan_starts) - 1):
        begin, end = fan_starts[v], fan_starts[v + 1]
        at = ring_starts[v]
        for i in range(begin, end):
            h = fan[i]
            face = h - h % 4
            ring[at] = corners[face + (h + 1) % 4]
            spokes[at] = sharp[h]
            at += 1
        if end > begin and mates[fan[begin]] < 0:
            h = fan[end - 1]
            before = h - h % 4 + (h + 3) % 4
            ring[at] = corners[before]
            spokes[at] = sharp[before]
            at += 1
        for i in range(begin, end):
            h = fan[i]
            ring[at] = corners[h - h % 4 + (h + 2) % 4]
            at += 1


@lean
def fill_grid(corners, mates, place, fans, ring_starts, ring, grid):
    """grid[f]: the sixteen vertices of the table at depth 0, row by row; what is absent is the own corner.

    Where a corner has other than four faces, the cell across it means nothing.
    """
    for f in range(len(grid)):
        for k in range(4):
            h = 4 * f + k
            v = corners[h]
            n, begin = fans[v], ring_starts[v]
            spokes = ring_starts[v + 1] - begin - n
            is_open = spokes > n
            # From the corner's own frame (row, column) to the table's, turned k times.
            for i in range(4):
                row, column = (0, -1, -1, -1)[i], (0, 1, 0, -1)[i]
                to, o = v, place[h]
                if i == 1 and (o > 0 or not is_open):
                    to = ring[begin + spokes + (o - 1) % n]
                elif i == 2 and (o > 0 or not is_open):
                    to = ring[begin + (o - 1) % spokes]
                elif i == 3 and n == 4 and not is_open:
                    to = ring[begin + spokes + (o + 2) % n]
                for _ in range(k):
                    row, column = column, -row
                if k == 1 or k == 2:
                    column += 1
                if k >= 2:
                    row += 1
                grid[f, 4 * (row + 1) + column + 1] = to


@lean
def touched(net, is_moved, is_vertex, is_patch):
    """Which vertices have something that moved in their rings, and which patches have such a corner."""
    for v in range(len(is_vertex)):
        is_near = is_moved[v]
        for i in range(net.ring_starts[v], net.ring_starts[v + 1]):
            is_near = is_near or is_moved[net.ring[i]]
        is_vertex[v] = is_near
    for f in range(len(is_patch)):
        h = 4 * f
        is_patch[f] = (
            is_vertex[net.corners[h]]
            or is_vertex[net.corners[h + 1]]
            or is_vertex[net.corners[h + 2]]
            or is_vertex[net.corners[h + 3]]
        )
