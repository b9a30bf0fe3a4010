# mypy: allow-untyped-defs, allow-untyped-calls
"""Local operators of √3 refinement: split a face, flip an edge, in a `net.Net`.

Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000.
"""

import math

import numpy as np

from foveal.base.jit import kernel

from ._kernels_sqrt3_layout import (
    BORDER,
    FACES,
    FREE_FACES,
    FREE_VERTICES,
    NONE,
    UNMEASURED,
    VERTICES,
    generation,
    half,
    whole,
)
from ._kernels_sqrt3_measure import measure_corners
from ._kernels_sqrt3_points import middle, near_point, position


@kernel
def take_face(net):
    """A free face slot."""
    if net.counts[FREE_FACES] > 0:
        net.counts[FREE_FACES] -= 1
        return np.int64(net.free_faces[net.counts[FREE_FACES]])
    net.counts[FACES] += 1
    return np.int64(net.counts[FACES] - 1)


@kernel
def take_vertex(net):
    """A free vertex slot."""
    if net.counts[FREE_VERTICES] > 0:
        net.counts[FREE_VERTICES] -= 1
        return np.int64(net.free_vertices[net.counts[FREE_VERTICES]])
    net.counts[VERTICES] += 1
    return np.int64(net.counts[VERTICES] - 1)


@kernel
def put(net, f, a, b, c, x, y, z, state):
    """Write a face: corners, faces beyond, state."""
    net.faces[f, 0], net.faces[f, 1], net.faces[f, 2] = a, b, c
    net.beside[f, 0], net.beside[f, 1], net.beside[f, 2] = x, y, z
    net.states[f] = state
    net.face_until[f] = 0.0


@kernel
def relink(net, n, u, f):
    """Tell face n that f is beyond its edge that begins at u."""
    if n != NONE:
        for k in range(3):
            if net.faces[n, k] == u:
                net.beside[n, k] = f


@kernel
def flip(net, h, n):
    """Two halves of one old edge (w, x) become two faces of the next generation.

    Half h = (w, x, b) becomes (w, c, b), its mate n = (x, w, c) becomes (x, b, c).
    """
    w, x, b, c = net.faces[h, 0], net.faces[h, 1], net.faces[h, 2], net.faces[n, 2]
    h1, h2, n1, n2 = net.beside[h, 1], net.beside[h, 2], net.beside[n, 1], net.beside[n, 2]
    state = net.states[h] + 1
    put(net, h, w, c, b, n1, n, h2, state)
    put(net, n, x, b, c, h1, h, n2, state)
    relink(net, n1, c, h)
    relink(net, h1, b, n)
    net.around[w], net.around[x], net.around[b], net.around[c] = h, n, h, h


@kernel
def settle(net, h):
    """A new half becomes a face of the next generation, if nothing is beyond its old edge or a half is."""
    n = net.beside[h, 0]
    if n == NONE:
        net.states[h] += 1
        net.face_until[h] = 0.0
    elif net.states[n] == net.states[h] and net.beside[n, 0] == h:
        flip(net, h, n)


@kernel
def split(net, f):
    """Split a face of generation k; returns the new vertex, or the first of two on a border."""
    level = generation(net.states[f])
    if level % 2 == 1 and net.beside[f, 0] == NONE:
        return cut(net, f)
    u, v, w = net.faces[f, 0], net.faces[f, 1], net.faces[f, 2]
    if level > 0:
        measure_corners(net, f)
    n0, n1, n2 = net.beside[f, 0], net.beside[f, 1], net.beside[f, 2]
    b = take_vertex(net)
    x, y, z = middle(net, f, level)
    net.points[b, 0, 0], net.points[b, 0, 1], net.points[b, 0, 2] = x, y, z
    net.births[b], net.kinds[b] = level + 1, UNMEASURED
    net.triples[b, 0], net.triples[b, 1], net.triples[b, 2], net.pairs[b] = u, v, w, NONE
    net.points[b, 1, 0] = math.nan  # unmeasured: whoever reads it would show
    g, h = take_face(net), take_face(net)
    put(net, f, u, v, b, n0, g, h, half(level))
    put(net, g, v, w, b, n1, h, f, half(level))
    put(net, h, w, u, b, n2, f, g, half(level))
    relink(net, n1, w, g)
    relink(net, n2, u, h)
    net.around[u], net.around[v], net.around[w], net.around[b] = f, g, h, f
    settle(net, f)
    settle(net, g)
    settle(net, h)
    return b


@kernel
def cut(net, f):
    """Split a face of odd generation, in three from its border edge; returns the first new vertex."""
    level = generation(net.states[f])
    a, b, c = net.faces[f, 0], net.faces[f, 1], net.faces[f, 2]
    measure_corners(net, f)
    n1, n2 = net.beside[f, 1], net.beside[f, 2]
    ax, ay, az = position(net, a, level + 1)
    bx, by, bz = position(net, b, level + 1)
    px, py, pz = near_point(net, a, b, level, True)
    qx, qy, qz = near_point(net, a, b, level, False)
    p, q = take_vertex(net), take_vertex(net)
    net.pairs[p], net.pairs[q] = q, p
    put_border_point(net, p, ax, ay, az, px, py, pz, qx, qy, qz)
    put_border_point(net, q, px, py, pz, qx, qy, qz, bx, by, bz)
    for v in (p, q):
        net.births[v], net.kinds[v] = level + 1, BORDER
        net.triples[v, 0], net.triples[v, 1], net.triples[v, 2] = a, b, c
        for axis in range(3):
            net.normals[v, axis] = net.normals[c, axis]
    g, h = take_face(net), take_face(net)
    put(net, f, c, p, q, g, NONE, h, whole(level + 1))
    put(net, g, c, a, p, n2, NONE, f, half(level))
    put(net, h, b, c, q, n1, f, NONE, half(level))
    relink(net, n1, c, h)
    relink(net, n2, a, g)
    net.around[a], net.around[b], net.around[c], net.around[p], net.around[q] = g, h, f, f, f
    settle(net, g)
    settle(net, h)
    return p


@kernel
def put_border_point(net, v, px, py, pz, x, y, z, qx, qy, qz):
    """The three vectors of a border vertex between p and q."""
    net.points[v, 0, 0], net.points[v, 0, 1], net.points[v, 0, 2] = x, y, z
    net.points[v, 1, 0], net.points[v, 1, 1], net.points[v, 1, 2] = qx - px, qy - py, qz - pz
    net.points[v, 2, 0], net.points[v, 2, 1], net.points[v, 2, 2] = (
        px - 2.0 * x + qx,
        py - 2.0 * y + qy,
        pz - 2.0 * z + qz,
    )
