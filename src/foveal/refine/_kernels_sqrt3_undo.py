# mypy: allow-untyped-defs, allow-untyped-calls
"""The inverses of √3 refinement's operators: flip an edge back, make one face of three."""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import EXPIRED, NEVER, both
from ._kernels_sqrt3_layout import MEETS, NONE, WANTED, corner_at, is_half, whole
from ._kernels_sqrt3_slots import give_face, give_vertex, put, relink, set_state, sew


@lean
def unflip(net, f, n):
    """The inverse of `flip`, for f = (w, c, b) and n = (x, b, c).

    A half that may be asked need not be, as long as both faces and the third (`is_third_wanted`) need not.
    """
    one, two, vertices = net.faces[f], net.faces[n], net.vertices
    w, c, b, x = one.corners[0], one.corners[1], one.corners[2], two.corners[0]
    f0, f2, n0, n2 = one.beside[0], one.beside[2], two.beside[0], two.beside[2]
    state, known = one.state - 1, np.int64(EXPIRED)
    if not (one.is_queued or two.is_queued):
        known = both(net.faces[f].until, net.faces[n].until)
    put(net, f, w, x, b, n, n0, f2, state, known if net.flags[b] & WANTED != 0 else np.int64(NEVER))
    put(net, n, x, w, c, f, f0, n2, state, known if net.flags[c] & WANTED != 0 else np.int64(NEVER))
    relink(net, n0, b, f)
    relink(net, f0, c, n)
    vertices[w].around, vertices[x].around, vertices[b].around, vertices[c].around = f, f, f, n


@lean
def is_flipped(net, f):
    """Whether a face of the last generation is one of two that a flip made: its edge 1 is the new one."""
    face = net.faces[f]
    return net.births[face.corners[1]] == net.births[face.corners[2]]


@lean
def last_promoted(net, v):
    """A face at v that was a half, or NONE."""
    state = whole(np.int64(net.births[v]))
    first = np.int64(net.vertices[v].around)
    for is_back in (False, True):
        f = first
        while f >= 0:
            # The middle face of a cut border edge was none: its edge 1 is on the border.
            if net.faces[f].state == state and not (is_flipped(net, f) and net.faces[f].beside[1] < 0):
                return f
            k = corner_at(net.faces[f], v)
            f = np.int64(net.faces[f].beside[k if is_back else (k + 2) % 3])
            if f == first:
                return NONE
    return NONE


@lean
def unflip_all(net, v):
    """Undo the flips around vertex v, and the promotion at a border: its faces are halves again."""
    f = last_promoted(net, v)
    while f != NONE:
        if is_flipped(net, f):
            unflip(net, f, np.int64(net.faces[f].beside[1]))
        else:
            set_state(net, f, net.faces[f].state - 1, EXPIRED)
        f = last_promoted(net, v)


@lean
def known_until(net, v):
    """Up to which word of drift the birth face of v, no longer split, need not be asked.

    Where it meets the criteria it was for want of a wanted parent that it is split no longer.
    """
    return np.int64(NEVER) if net.flags[v] & MEETS != 0 else net.vertices[v].until


@lean
def unsplit(net, v):
    """Undo the split that made vertex v (and those with it), none of whose faces is split."""
    unflip_all(net, v)
    if net.vertices[v].pair != NONE:
        uncut_all(net, v, np.int64(net.vertices[v].pair))
        return
    vertex = net.vertices[v]
    a, b, c = vertex.triple[0], vertex.triple[1], vertex.triple[2]
    f = np.int64(vertex.around)
    while net.faces[f].corners[0] != a:
        f = np.int64(net.faces[f].beside[1])
    g = np.int64(net.faces[f].beside[1])
    h = np.int64(net.faces[g].beside[1])
    n0, n1, n2 = net.faces[f].beside[0], net.faces[g].beside[0], net.faces[h].beside[0]
    put(net, f, a, b, c, n0, n1, n2, net.faces[f].state - 1, known_until(net, v))
    relink(net, n1, c, f)
    relink(net, n2, a, f)
    net.vertices[a].around = net.vertices[b].around = net.vertices[c].around = f
    give_face(net, g)
    give_face(net, h)
    give_vertex(net, v)


@lean
def uncut_all(net, p, q):
    """Undo the cut of a border edge that made p and q, in either order, and at a seam that beyond."""
    t = np.int64(net.vertices[p].twin)
    unflip_all(net, q)
    if t == NONE:
        uncut(net, p, q)
        return
    u = np.int64(net.vertices[t].pair)
    unflip_all(net, t)
    unflip_all(net, u)
    f, n = uncut(net, p, q), uncut(net, t, u)
    sew(net, f, 0, n, 0)


@lean
def uncut(net, p, q):
    """Make the three faces of a cut one again, their halves being unflipped; returns it.

    What is beyond its edge on the border is left to be said.
    """
    vertex = net.vertices[p]
    a, b, c = vertex.triple[0], vertex.triple[1], vertex.triple[2]
    level = net.births[p] - 1
    f = np.int64(vertex.around)
    face = net.faces[f]
    if face.corners[0] != c or is_half(face.state) or (face.corners[1] != p and face.corners[2] != p):
        f = np.int64(face.beside[2]) if face.corners[0] == c else np.int64(face.beside[1])
    g, h = np.int64(net.faces[f].beside[0]), np.int64(net.faces[f].beside[2])
    n1, n2 = net.faces[h].beside[0], net.faces[g].beside[0]
    put(net, f, a, b, c, NONE, n1, n2, whole(level), known_until(net, p))
    relink(net, n1, c, f)
    relink(net, n2, a, f)
    net.vertices[a].around = net.vertices[b].around = net.vertices[c].around = f
    give_face(net, g)
    give_face(net, h)
    give_vertex(net, p)
    give_vertex(net, q)
    return f
