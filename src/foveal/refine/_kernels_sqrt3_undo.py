# mypy: allow-untyped-defs, allow-untyped-calls
"""The inverses of √3 refinement's operators: flip an edge back, make one face of three."""

import numpy as np

from foveal.base.jit import kernel

from ._kernels_sqrt3 import put, relink
from ._kernels_sqrt3_layout import FREE, FREE_FACES, FREE_VERTICES, NONE, is_half, whole


@kernel
def give_face(net, f):
    """Free a face slot."""
    net.states[f] = FREE
    net.free_faces[net.counts[FREE_FACES]] = f
    net.counts[FREE_FACES] += 1


@kernel
def give_vertex(net, v):
    """Free a vertex slot."""
    net.births[v] = FREE
    net.free_vertices[net.counts[FREE_VERTICES]] = v
    net.counts[FREE_VERTICES] += 1


@kernel
def unflip(net, f, n):
    """The inverse of `flip`, for f = (w, c, b) and n = (x, b, c)."""
    w, c, b, x = net.faces[f, 0], net.faces[f, 1], net.faces[f, 2], net.faces[n, 0]
    f0, f2, n0, n2 = net.beside[f, 0], net.beside[f, 2], net.beside[n, 0], net.beside[n, 2]
    state = net.states[f] - 1
    put(net, f, w, x, b, n, n0, f2, state)
    put(net, n, x, w, c, f, f0, n2, state)
    relink(net, n0, b, f)
    relink(net, f0, c, n)
    net.around[w], net.around[x], net.around[b], net.around[c] = f, f, f, n


@kernel
def unflip_all(net, v):
    """Undo the flips around vertex v, and the promotion at a border: its faces are halves again."""
    level = net.births[v]
    fan = np.empty(16, np.int64)
    count = 0
    for way in range(2):
        f = np.int64(net.around[v])
        while f != NONE and count < 16:
            if way == 0 or f != net.around[v]:
                fan[count] = f
                count += 1
            k = 0 if net.faces[f, 0] == v else (1 if net.faces[f, 1] == v else 2)
            f = np.int64(net.beside[f, (k + 2) % 3 if way == 0 else k])
            if f == net.around[v]:
                break
        if f == net.around[v]:
            break
    for i in range(count):
        f = fan[i]
        if net.states[f] != whole(level):
            continue
        is_flipped = net.births[net.faces[f, 1]] == net.births[net.faces[f, 2]]
        if is_flipped and net.beside[f, 1] != NONE:
            unflip(net, f, np.int64(net.beside[f, 1]))
        elif not is_flipped:
            net.states[f] -= 1
            net.face_until[f] = 0.0


@kernel
def unsplit(net, v):
    """Undo the split that made vertex v (and its pair), none of whose faces is split."""
    unflip_all(net, v)
    p = np.int64(net.pairs[v])
    if p != NONE:
        unflip_all(net, p)
        uncut(net, v, p)
        return
    a, b, c = net.triples[v, 0], net.triples[v, 1], net.triples[v, 2]
    f = np.int64(net.around[v])
    while net.faces[f, 0] != a:
        f = np.int64(net.beside[f, 1])
    g = np.int64(net.beside[f, 1])
    h = np.int64(net.beside[g, 1])
    n0, n1, n2 = net.beside[f, 0], net.beside[g, 0], net.beside[h, 0]
    put(net, f, a, b, c, n0, n1, n2, net.states[f] - 1)
    relink(net, n1, c, f)
    relink(net, n2, a, f)
    net.around[a] = net.around[b] = net.around[c] = f
    give_face(net, g)
    give_face(net, h)
    give_vertex(net, v)


@kernel
def uncut(net, p, q):
    """Undo the cut of a border edge that made p and q, in either order, their halves being unflipped."""
    a, b, c = net.triples[p, 0], net.triples[p, 1], net.triples[p, 2]
    level = net.births[p] - 1
    f = np.int64(net.around[p])
    if net.faces[f, 0] != c or is_half(net.states[f]) or (net.faces[f, 1] != p and net.faces[f, 2] != p):
        f = np.int64(net.beside[f, 2]) if net.faces[f, 0] == c else np.int64(net.beside[f, 1])
    g, h = np.int64(net.beside[f, 0]), np.int64(net.beside[f, 2])
    n1, n2 = net.beside[h, 0], net.beside[g, 0]
    put(net, f, a, b, c, NONE, n1, n2, whole(level))
    relink(net, n1, c, f)
    relink(net, n2, a, f)
    net.around[a] = net.around[b] = net.around[c] = f
    give_face(net, g)
    give_face(net, h)
    give_vertex(net, p)
    give_vertex(net, q)
