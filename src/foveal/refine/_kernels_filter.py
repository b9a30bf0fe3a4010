# mypy: allow-untyped-defs, allow-untyped-calls
"""The elementary actions of √3 refinement as published, on a `FilterNet`: split, cut, swap.

A third of a split face has its old edge as edge 0 and the new vertex as corner 2 (the paper's neighbour of
index 2, which is opposite corner 2).

Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
√3-subdivision, section 6.3; the cut is L. Kobbelt's border rule.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_extract import AREA, FRONT, INSIDE, KNOWN, NONE, SWAP, corner_of

#: Places in `counts`.
FACES, VERTICES, SPLITS, MOVES, SWAPS = 0, 1, 2, 3, 4

THIRD = 1.0 / 3.0


@lean
def put(net, f, a, b, c, x, y, z):
    """Write a face: corners, faces beyond."""
    net.corners[f, 0], net.corners[f, 1], net.corners[f, 2] = a, b, c
    net.beside[f, 0], net.beside[f, 1], net.beside[f, 2] = x, y, z


@lean
def relink(net, n, u, f):
    """Tell face n that f is beyond its edge that begins at u."""
    if n != NONE:
        net.beside[n, corner_of(net.corners, n, u)] = f


@lean
def split(net, f, is_odd, old):
    """Split face f in three at its middle, or on odd iterations at its border edge.

    `old` is how many vertices there were before this iteration.
    """
    borders = (
        (1 if net.beside[f, 0] == NONE else 0)
        + (1 if net.beside[f, 1] == NONE else 0)
        + (1 if net.beside[f, 2] == NONE else 0)
    )
    is_cut = is_odd and borders == 1  # in uniform subdivision no face has more on an odd iteration
    net.splits[net.counts[SPLITS]] = 2 * f + (1 if is_cut else 0)
    net.counts[SPLITS] += 1
    flags, level = net.flags[f] & (INSIDE | AREA | KNOWN | FRONT), net.levels[f] + 1
    g, h = net.counts[FACES], net.counts[FACES] + 1
    net.flags[f] = flags | (0 if is_cut else SWAP)
    net.flags[g] = net.flags[h] = flags | SWAP
    net.levels[f] = net.levels[g] = net.levels[h] = level
    if is_cut:
        cut(net, f, old)
    else:
        split_at_middle(net, f)


@lean
def split_at_middle(net, f):
    """Face (a, b, c) becomes (a, b, v), and two are made: (c, a, v), (b, c, v)."""
    g, v = net.counts[FACES], net.counts[VERTICES]
    h = g + 1
    net.counts[FACES] += 2
    net.counts[VERTICES] += 1
    a, b, c = net.corners[f, 0], net.corners[f, 1], net.corners[f, 2]
    n0, n1, n2 = net.beside[f, 0], net.beside[f, 1], net.beside[f, 2]
    for axis in range(3):
        total = net.positions[a, axis] + net.positions[b, axis] + net.positions[c, axis]
        net.positions[v, axis] = total * THIRD
    put(net, f, a, b, v, n0, h, g)
    put(net, g, c, a, v, n2, f, h)
    put(net, h, b, c, v, n1, g, f)
    relink(net, n2, a, g)
    relink(net, n1, c, h)
    net.around[v], net.marks[v] = f, 0
    if net.around[c] == f:
        net.around[c] = g


@lean
def cut(net, f, old):
    """The face at border edge a, b becomes (p, q, c) in place, and two are made: (c, a, p), (b, c, q)."""
    g, p = net.counts[FACES], net.counts[VERTICES]
    h, q = g + 1, p + 1
    k = 0 if net.beside[f, 0] == NONE else (1 if net.beside[f, 1] == NONE else 2)
    k1, k2 = (k + 1) % 3, (k + 2) % 3
    a, b, c = net.corners[f, k], net.corners[f, k1], net.corners[f, k2]
    before, after = border_end(net, a, True, old), border_end(net, b, False, old)
    for axis in range(3):
        x, y = net.positions[a, axis], net.positions[b, axis]
        net.positions[p, axis] = (net.positions[before, axis] + 16.0 * x + 10.0 * y) / 27.0
        net.positions[q, axis] = (10.0 * x + 16.0 * y + net.positions[after, axis]) / 27.0
    net.counts[FACES] += 2
    net.counts[VERTICES] += 2
    n1, n2 = net.beside[f, k1], net.beside[f, k2]
    net.corners[f, k], net.corners[f, k1] = p, q
    net.beside[f, k1], net.beside[f, k2] = h, g
    put(net, g, c, a, p, n2, NONE, f)
    put(net, h, b, c, q, n1, f, NONE)
    relink(net, n2, a, g)
    relink(net, n1, c, h)
    net.around[p] = net.around[q] = f
    net.marks[p] = net.marks[q] = 0
    if net.around[a] == f:
        net.around[a] = g
    if net.around[b] == f:
        net.around[b] = h


@lean
def border_end(net, v, is_before, old):
    """The vertex before v along the border, or after it, among the first `old`: new ones are passed over."""
    u = np.int64(v)
    while u == v or u >= old:
        f = np.int64(net.around[u])
        while True:
            k = corner_of(net.corners, f, u)
            n = np.int64(net.beside[f, (k + 2) % 3 if is_before else k])
            if n == NONE:
                break
            f = n
        u = np.int64(net.corners[f, (k + 2) % 3 if is_before else (k + 1) % 3])
        if u == v:  # a border of this vertex and new ones alone
            break
    return u


@lean
def swap(net, f):
    """Edge 0 of f = (a, b, v) and of the face (b, a, d) beyond: they become (d, b, v), (v, a, d).

    Not done where the new edge v, d is there already, which would close a vertex's last ring but two.
    Returns whether it was done.
    """
    n = np.int64(net.beside[f, 0])
    a, b, v = net.corners[f, 0], net.corners[f, 1], net.corners[f, 2]
    k = corner_of(net.corners, n, b)
    k2 = (k + 2) % 3
    d = net.corners[n, k2]
    if d == v or are_neighbours(net, f, v, d):
        return False
    f2, n2 = net.beside[f, 2], net.beside[n, k2]
    was_f, was_n = net.around[a] == f, net.around[b] == n
    net.swaps[net.counts[SWAPS]] = 4 * f + (1 if was_f else 0) + (2 if was_n else 0)
    net.counts[SWAPS] += 1
    net.corners[f, 0], net.corners[n, k] = d, v
    net.beside[f, 0], net.beside[f, 2] = n2, n
    net.beside[n, k], net.beside[n, k2] = f2, f
    relink(net, n2, b, f)
    relink(net, f2, a, n)
    if was_f:
        net.around[a] = n
    if was_n:
        net.around[b] = f
    mix_flags(net, f, n)
    return True


@lean
def mix_flags(net, f, n):
    """Of two faces that have swapped their edge only what both knew is still known."""
    one, two = net.flags[f], net.flags[n]
    known = one & two & (INSIDE | KNOWN)
    if (one ^ two) & FRONT:
        known &= ~KNOWN & 0xFF
    net.flags[f] = (one & (AREA | FRONT)) | known
    net.flags[n] = (two & (AREA | FRONT)) | known


@lean
def are_neighbours(net, f, v, d):
    """Whether vertices v, of face f, and d have an edge."""
    for is_back in (False, True):
        g = np.int64(f)
        while True:
            k = corner_of(net.corners, g, v)
            if net.corners[g, (k + 1) % 3] == d or net.corners[g, (k + 2) % 3] == d:
                return True
            g = np.int64(net.beside[g, k if is_back else (k + 2) % 3])
            if g == f:
                return False
            if g == NONE:
                break
    return False
