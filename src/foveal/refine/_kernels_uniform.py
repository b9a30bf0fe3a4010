# mypy: allow-untyped-defs, allow-untyped-calls
"""Quadrisection on flat arrays: no hashing and no search, each level follows from the last in closed form.

A half-edge h = 3 f + k runs from corner k of face f to corner k + 1. `edges` (m, 3) numbers the edge of each,
`halves` (e, 2) holds the two half-edges of each, -1 for the one that a border edge lacks. The new vertex of
edge e is number v + e. Face f has children 4 f + k at its corners and 4 f + 3 in its middle; what lies on
half-edge k of a face is half-edge k of a child. Edges 2 e and 2 e + 1 are the halves of edge e, and edge
2 E + 3 f + k parts child k from the middle.
"""

from foveal.base.jit import kernel


@kernel
def number_edges(faces, beside, edges, halves):
    """Number the edges of a control mesh in order of its half-edges; returns how many there are."""
    count = 0
    for f in range(len(faces)):
        for k in range(3):
            g = beside[f, k]
            if g >= 0 and g < f:
                continue
            edges[f, k] = count
            halves[count, 0], halves[count, 1] = 3 * f + k, -1
            if g >= 0:
                end = faces[f, (k + 1) % 3]
                j = 0 if faces[g, 0] == end else (1 if faces[g, 1] == end else 2)
                edges[g, j] = count
                halves[count, 1] = 3 * g + j
            count += 1
    return count


@kernel
def split_faces(faces, edges, vertices, fine_faces):
    """The four children of each face; `vertices` is how many there are before."""
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ab, bc, ca = vertices + edges[f, 0], vertices + edges[f, 1], vertices + edges[f, 2]
        i = 4 * f
        fine_faces[i, 0], fine_faces[i, 1], fine_faces[i, 2] = a, ab, ca
        fine_faces[i + 1, 0], fine_faces[i + 1, 1], fine_faces[i + 1, 2] = ab, b, bc
        fine_faces[i + 2, 0], fine_faces[i + 2, 1], fine_faces[i + 2, 2] = ca, bc, c
        fine_faces[i + 3, 0], fine_faces[i + 3, 1], fine_faces[i + 3, 2] = bc, ca, ab


@kernel
def split_edges(edges, halves, fine_edges, fine_halves):
    """The edges of the children: two for each edge, three inside each face."""
    inside = 2 * len(halves)
    for f in range(len(edges)):
        for k in range(3):
            n = k + 1 if k < 2 else 0
            e = edges[f, k]
            side = 0 if halves[e, 0] == 3 * f + k else 1
            # The first half belongs to the child at corner k, the second to that at the next corner.
            near, far = 2 * e + side, 2 * e + 1 - side
            fine_edges[4 * f + k, k], fine_edges[4 * f + n, k] = near, far
            fine_halves[near, side], fine_halves[far, side] = 12 * f + 4 * k, 12 * f + 3 * n + k
            if halves[e, 1] < 0:
                fine_halves[near, 1], fine_halves[far, 1] = -1, -1
            i = inside + 3 * f + k
            fine_edges[4 * f + k, n], fine_edges[4 * f + 3, n] = i, i
            fine_halves[i, 0], fine_halves[i, 1] = 12 * f + 3 * k + n, 12 * f + 9 + n


@kernel
def ends(faces, h):
    """(a, b, c): the half-edge h runs from a to b, and c is across its face."""
    f, k = h // 3, h % 3
    return faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]


@kernel
def add_rings(faces, halves, positions, is_border, sums):
    """Add to each vertex its neighbours', on the border its neighbours' along the border."""
    for e in range(len(halves)):
        a, b, _ = ends(faces, halves[e, 0])
        along = halves[e, 1] < 0
        if along or not is_border[a]:
            for axis in range(3):
                sums[a, axis] += positions[b, axis]
        if along or not is_border[b]:
            for axis in range(3):
                sums[b, axis] += positions[a, axis]


@kernel
def relax(positions, keeps, shares, out):
    """A share of what `out` holds, the sum of a vertex's neighbours, and the rest of the vertex itself."""
    for v in range(len(positions)):
        for axis in range(3):
            out[v, axis] = keeps[v] * positions[v, axis] + shares[v] * out[v, axis]


@kernel
def loop_midpoints(faces, halves, positions, out):
    """The new vertex of each edge by Loop's mask 3, 3, 1, 1; on the border the middle."""
    for e in range(len(halves)):
        a, b, c = ends(faces, halves[e, 0])
        if halves[e, 1] < 0:
            for axis in range(3):
                out[e, axis] = 0.5 * (positions[a, axis] + positions[b, axis])
            continue
        _, _, d = ends(faces, halves[e, 1])
        for axis in range(3):
            out[e, axis] = 0.375 * (positions[a, axis] + positions[b, axis]) + 0.125 * (
                positions[c, axis] + positions[d, axis]
            )


@kernel
def opposite(edges, halves, h):
    """The half-edge that runs the other way, or -1."""
    e = edges[h // 3, h % 3]
    return halves[e, 1] if halves[e, 0] == h else halves[e, 0]


@kernel
def around(h):
    """The half-edge after h in its face."""
    return h - 2 if h % 3 == 2 else h + 1


@kernel
def first_half_edges(faces, halves, first):
    """One half-edge that leaves each vertex: at the border the one along it, else any; -1 for none."""
    first[:] = -1
    for h in range(3 * len(faces)):
        first[faces[h // 3, h % 3]] = h
    for e in range(len(halves)):
        if halves[e, 1] < 0:
            h = halves[e, 0]
            first[faces[h // 3, h % 3]] = h


@kernel
def ring_of(faces, edges, halves, h, ring):
    """The neighbours of the vertex that h leaves, counter-clockwise from h; returns how many.

    On the border h must be the half-edge along it; the previous border vertex comes last.
    """
    n, begin = 0, h
    while True:
        _, b, c = ends(faces, h)
        ring[n] = b
        n += 1
        before = around(around(h))
        h = opposite(edges, halves, before)
        if h < 0:
            ring[n] = c
            return n + 1
        if h == begin:
            return n
