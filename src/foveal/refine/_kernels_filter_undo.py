# mypy: allow-untyped-defs, allow-untyped-calls
"""The inverses of the elementary actions: each finds the mesh as the action left it, restores all bits."""

import numpy as np

from foveal.base.jit import lean

from ._kernels_extract import NONE, corner_of
from ._kernels_filter import FACES, MOVES, SPLITS, SWAPS, VERTICES, relink


@lean
def unsplit_all(net, begin):
    """Undo the splits from `begin` on, last first."""
    while net.counts[SPLITS] > begin:
        net.counts[SPLITS] -= 1
        entry = np.int64(net.splits[net.counts[SPLITS]])
        f = entry >> 1
        net.counts[FACES] -= 2
        net.levels[f] -= 1
        if entry & 1:
            uncut(net, f)
        else:
            unsplit_at_middle(net, f)


@lean
def unsplit_at_middle(net, f):
    """Faces (a, b, v), (c, a, v), (b, c, v) become (a, b, c); the last two were the last that were made."""
    g = net.counts[FACES]
    h = g + 1
    net.counts[VERTICES] -= 1
    a, c = net.corners[f, 0], net.corners[g, 0]
    n1, n2 = net.beside[h, 0], net.beside[g, 0]
    net.corners[f, 2] = c
    net.beside[f, 1], net.beside[f, 2] = n1, n2
    relink(net, n2, a, f)
    relink(net, n1, c, f)
    if net.around[c] == g:
        net.around[c] = f


@lean
def uncut(net, f):
    """Faces (p, q, c), (c, a, p), (b, c, q) become (a, b, c) in place; the last two were made last."""
    g = net.counts[FACES]
    h = g + 1
    net.counts[VERTICES] -= 2
    k = 0 if net.beside[f, 0] == NONE else (1 if net.beside[f, 1] == NONE else 2)
    k1, k2 = (k + 1) % 3, (k + 2) % 3
    a, b, c = net.corners[g, 1], net.corners[h, 0], net.corners[f, k2]
    n1, n2 = net.beside[h, 0], net.beside[g, 0]
    net.corners[f, k], net.corners[f, k1] = a, b
    net.beside[f, k1], net.beside[f, k2] = n1, n2
    relink(net, n2, a, f)
    relink(net, n1, c, f)
    if net.around[a] == g:
        net.around[a] = f
    if net.around[b] == h:
        net.around[b] = f


@lean
def unmove_all(net, begin):
    """Put vertices back, from the last move to `begin`."""
    while net.counts[MOVES] > begin:
        net.counts[MOVES] -= 1
        i = net.counts[MOVES]
        for axis in range(3):
            net.positions[net.moved[i], axis] = net.before[i, axis]


@lean
def unswap_all(net, begin):
    """Undo the swaps from `begin` on, last first: (d, b, v), (v, a, d) become (a, b, v), (b, a, d)."""
    while net.counts[SWAPS] > begin:
        net.counts[SWAPS] -= 1
        entry = np.int64(net.swaps[net.counts[SWAPS]])
        f = entry >> 2
        n = np.int64(net.beside[f, 2])
        b, v = net.corners[f, 1], net.corners[f, 2]
        k = corner_of(net.corners, n, v)
        k1, k2 = (k + 1) % 3, (k + 2) % 3
        a = net.corners[n, k1]
        n2, f2 = net.beside[f, 0], net.beside[n, k]
        net.corners[f, 0], net.corners[n, k] = a, b
        net.beside[f, 0], net.beside[f, 2] = n, f2
        net.beside[n, k], net.beside[n, k2] = f, n2
        relink(net, n2, b, n)
        relink(net, f2, a, f)
        if entry & 1:
            net.around[a] = f
        if entry & 2:
            net.around[b] = n
