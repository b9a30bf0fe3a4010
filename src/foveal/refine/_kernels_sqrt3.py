# mypy: allow-untyped-defs, allow-untyped-calls
"""Local operators of √3 refinement: split a face, flip an edge, in a `net.Net`.

Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import EXPIRED
from ._kernels_sqrt3_layout import (
    BORDER,
    NONE,
    PARENT,
    UNMEASURED,
    WANTED,
    generation,
    half,
    seam_face,
    whole,
)
from ._kernels_sqrt3_measure import measure_corners
from ._kernels_sqrt3_points import middle, near_point, position
from ._kernels_sqrt3_slots import adopt, put, relink, set_state, sew, take_face, take_vertex


@lean
def flip(net, h, n):
    """Two halves of one old edge (w, x) become two faces of the next generation.

    Half h = (w, x, b) becomes (w, c, b), its mate n = (x, w, c) becomes (x, b, c). What was asked of a half
    was asked of these two faces, too.
    """
    one, two, vertices = net.faces[h], net.faces[n], net.vertices
    w, x, b, c = one.corners[0], one.corners[1], one.corners[2], two.corners[2]
    h1, h2, n1, n2 = one.beside[1], one.beside[2], two.beside[1], two.beside[2]
    state, known = one.state + 1, max(known_of_half(net, h), known_of_half(net, n))
    put(net, h, w, c, b, n1, n, h2, state, known)
    put(net, n, x, b, c, h1, h, n2, state, known)
    relink(net, n1, c, h)
    relink(net, h1, b, n)
    vertices[w].around, vertices[x].around, vertices[b].around, vertices[c].around = h, n, h, h


@lean
def known_of_half(net, h):
    """Up to which word of drift it was found of half h that nothing it stands for is wanted, or EXPIRED.

    What waits in the queue may be out of date.
    """
    is_told = net.flags[net.faces[h].corners[2]] & WANTED != 0 and not net.faces[h].is_queued
    return net.faces[h].until if is_told else np.int64(EXPIRED)


@lean
def settle(net, h):
    """A new half becomes a face of the next generation, if nothing is beyond its old edge or a half is."""
    face = net.faces[h]
    n = face.beside[0]
    if n < 0:
        set_state(net, h, face.state + 1, EXPIRED)
    elif net.faces[n].state == face.state and net.faces[n].beside[0] == h:
        flip(net, h, n)


@lean
def parents(net, u, v, w, level):
    """Flags that say which corners of a face are of its own generation."""
    if level == 0:
        return 0
    return (
        (PARENT if net.births[u] == level else 0)
        | (2 * PARENT if net.births[v] == level else 0)
        | (4 * PARENT if net.births[w] == level else 0)
    )


@lean
def born(net, a, b, c, pair, level, kind):
    """A new vertex, of the face a, b, c of a level; its flags say but its parents."""
    v = take_vertex(net)
    vertex = net.vertices[v]
    vertex.triple[0], vertex.triple[1], vertex.triple[2], vertex.pair = a, b, c, pair
    vertex.twin = NONE
    vertex.kind = kind
    vertex.child = NONE
    net.births[v] = level + 1
    net.flags[v] = parents(net, a, b, c, level)
    adopt(net, v)
    return v


@lean
def split(net, f):
    """Split a face of generation k that is not to be cut at a seam.

    Returns the new vertex, or the first of two on a border.
    """
    face = net.faces[f]
    level = generation(face.state)
    if level % 2 == 1 and face.beside[0] < 0:
        p = cut(net, f)
        settle_cut(net, f)
        return p
    u, v, w = face.corners[0], face.corners[1], face.corners[2]
    if level > 0:
        measure_corners(net, f)
    n0, n1, n2 = face.beside[0], face.beside[1], face.beside[2]
    b = born(net, u, v, w, NONE, level, UNMEASURED)
    vertex = net.vertices[b]
    vertex.born[0], vertex.born[1], vertex.born[2] = middle(net, f, level)
    vertex.limit[0] = math.nan  # unmeasured: whoever reads it would show
    g, h = take_face(net), take_face(net)
    put(net, f, u, v, b, n0, g, h, half(level), EXPIRED)
    put(net, g, v, w, b, n1, h, f, half(level), EXPIRED)
    put(net, h, w, u, b, n2, f, g, half(level), EXPIRED)
    relink(net, n1, w, g)
    relink(net, n2, u, h)
    net.vertices[u].around, net.vertices[v].around, net.vertices[w].around, vertex.around = f, g, h, f
    settle(net, f)
    settle(net, g)
    settle(net, h)
    return b


@lean
def beyond_cut(net, f):
    """The face beyond the seam at which face f is to be cut, or NONE if there is none."""
    face = net.faces[f]
    word = np.int64(face.beside[0])
    return seam_face(word) if word < NONE and generation(face.state) % 2 == 1 else np.int64(NONE)


@lean
def cut_seam(net, f, n):
    """Split the two faces of an odd generation at a seam; returns the first new vertex of f."""
    p, r = cut(net, f), cut(net, n)
    q, s = net.vertices[p].pair, net.vertices[r].pair
    net.vertices[p].twin, net.vertices[s].twin = s, p
    net.vertices[q].twin, net.vertices[r].twin = r, q
    sew(net, f, 1, n, 1)
    sew(net, np.int64(net.faces[f].beside[0]), 1, np.int64(net.faces[n].beside[2]), 2)
    sew(net, np.int64(net.faces[f].beside[2]), 2, np.int64(net.faces[n].beside[0]), 1)
    settle_cut(net, f)
    settle_cut(net, n)
    return p


@lean
def settle_cut(net, f):
    """Settle the halves on both sides of the middle face f of a cut."""
    g, h = np.int64(net.faces[f].beside[0]), np.int64(net.faces[f].beside[2])
    settle(net, g)
    settle(net, h)


@lean
def cut(net, f):
    """Split a face of odd generation, in three from its border edge; returns the first new vertex.

    What is beyond the three edges on the border is left to be said, and the two halves to be settled.
    """
    face = net.faces[f]
    level = generation(face.state)
    a, b, c = face.corners[0], face.corners[1], face.corners[2]
    measure_corners(net, f)
    n1, n2 = face.beside[1], face.beside[2]
    ax, ay, az = position(net, a, level + 1)
    bx, by, bz = position(net, b, level + 1)
    px, py, pz = near_point(net, a, b, level, True)
    qx, qy, qz = near_point(net, a, b, level, False)
    p = born(net, a, b, c, NONE, level, BORDER)
    q = born(net, a, b, c, p, level, BORDER)
    net.vertices[p].pair = q
    put_border_point(net, p, ax, ay, az, px, py, pz, qx, qy, qz)
    put_border_point(net, q, px, py, pz, qx, qy, qz, bx, by, bz)
    for axis in range(3):
        net.normals[p, axis] = net.normals[q, axis] = net.normals[c, axis]
    g, h = take_face(net), take_face(net)
    put(net, f, c, p, q, g, NONE, h, whole(level + 1), EXPIRED)
    put(net, g, c, a, p, n2, NONE, f, half(level), EXPIRED)
    put(net, h, b, c, q, n1, f, NONE, half(level), EXPIRED)
    relink(net, n1, c, h)
    relink(net, n2, a, g)
    vertices = net.vertices
    vertices[a].around, vertices[b].around, vertices[c].around = g, h, f
    vertices[p].around, vertices[q].around = f, f
    return p


@lean
def put_border_point(net, v, px, py, pz, x, y, z, qx, qy, qz):
    """The three vectors of a border vertex between p and q."""
    vertex = net.vertices[v]
    vertex.born[0], vertex.born[1], vertex.born[2] = x, y, z
    vertex.limit[0], vertex.limit[1], vertex.limit[2] = qx - px, qy - py, qz - pz
    vertex.third[0] = px + qx - 2.0 * x
    vertex.third[1] = py + qy - 2.0 * y
    vertex.third[2] = pz + qz - 2.0 * z
