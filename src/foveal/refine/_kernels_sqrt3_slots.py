# mypy: allow-untyped-defs, allow-untyped-calls
"""Slots of a √3 refinement: taking, freeing, writing faces; and the queue of faces to be asked."""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import EXPIRED
from ._kernels_sqrt3_layout import (
    DOUBTFUL,
    FACES,
    FIRST,
    FREE,
    FREE_FACE,
    FREE_FACES,
    FREE_VERTEX,
    FREE_VERTICES,
    NONE,
    PARENT,
    QUEUED,
    VERTICES,
    seam,
    seam_edge,
    seam_face,
)


@lean
def take_face(net):
    """A free face slot."""
    f = net.counts[FACES]
    if net.counts[FREE_FACES] > 0:
        f = net.counts[FREE_FACE]
        net.counts[FREE_FACES] -= 1
        net.counts[FREE_FACE] = net.faces[f].beside[0]
    else:
        net.counts[FACES] += 1
    return f


@lean
def take_vertex(net):
    """A free vertex slot."""
    v = net.counts[VERTICES]
    if net.counts[FREE_VERTICES] > 0:
        v = net.counts[FREE_VERTEX]
        net.counts[FREE_VERTICES] -= 1
        net.counts[FREE_VERTEX] = net.vertices[v].triple[0]
    else:
        net.counts[VERTICES] += 1
    return v


@lean
def give_face(net, f):
    """Free a face slot."""
    net.faces[f].state = FREE
    net.faces[f].beside[0] = net.counts[FREE_FACE]
    net.counts[FREE_FACE] = f
    net.counts[FREE_FACES] += 1


@lean
def adopt(net, v):
    """Make a new vertex known to its parents."""
    for k in range(3):
        if net.flags[v] & (PARENT << k):
            parent = net.vertices[net.vertices[v].triple[k]]
            net.vertices[v].siblings[k] = parent.child
            parent.child = v


@lean
def disown(net, v):
    """The inverse. A parent that has no child left may have to go."""
    for k in range(3):
        if net.flags[v] & (PARENT << k):
            u = np.int64(net.vertices[v].triple[k])
            c = np.int64(net.vertices[u].child)
            if c == v:
                net.vertices[u].child = net.vertices[v].siblings[k]
                if net.vertices[u].child == NONE:
                    doubt(net, u)
                continue
            while next_child(net, u, c) != v:
                c = next_child(net, u, c)
            net.vertices[c].siblings[birth_corner(net, c, u)] = net.vertices[v].siblings[k]


@lean
def birth_corner(net, v, u):
    """Which corner of v's birth face u is."""
    triple = net.vertices[v].triple
    return 0 if triple[0] == u else (1 if triple[1] == u else 2)


@lean
def next_child(net, u, c):
    """The child of u after c, or NONE."""
    return np.int64(net.vertices[c].siblings[birth_corner(net, c, u)])


@lean
def doubt(net, v):
    """Have it seen to whether v is to be in the mesh."""
    vertex = net.vertices[v]
    if not vertex.is_doubtful:  # which it may be from the slot's last use: once is enough
        vertex.is_doubtful = True
        vertex.next = net.counts[DOUBTFUL]
        net.counts[DOUBTFUL] = v


@lean
def give_vertex(net, v):
    """Free a vertex slot."""
    disown(net, v)
    net.births[v] = FREE
    net.vertices[v].triple[0] = net.counts[FREE_VERTEX]
    net.counts[FREE_VERTEX] = v
    net.counts[FREE_VERTICES] += 1


@lean
def enqueue(net, f):
    """Let a face be asked, unless it waits already."""
    if not net.faces[f].is_queued:
        net.faces[f].is_queued = True
        i = net.counts[FIRST] + net.counts[QUEUED]
        net.queue[i if i < len(net.queue) else i - len(net.queue)] = f
        net.counts[QUEUED] += 1


@lean
def dequeue(net):
    """The face that has waited longest."""
    i = net.counts[FIRST]
    f = np.int64(net.queue[i])
    net.counts[FIRST] = i + 1 if i + 1 < len(net.queue) else 0
    net.counts[QUEUED] -= 1
    net.faces[f].is_queued = False
    return f


@lean
def put(net, f, a, b, c, x, y, z, state, known):
    """Write a face: corners, faces beyond, state, and up to which word of drift it need not be asked."""
    face = net.faces[f]
    face.corners[0], face.corners[1], face.corners[2] = a, b, c
    face.beside[0], face.beside[1], face.beside[2] = x, y, z
    if min(x, min(y, z)) < NONE:
        tell_beyond(net, f)
    set_state(net, f, state, known)


@lean
def tell_beyond(net, f):
    """Tell the faces beyond the seams of face f where it is."""
    for k in range(3):
        word = np.int64(net.faces[f].beside[k])
        if word < NONE:
            net.faces[seam_face(word)].beside[seam_edge(word)] = seam(f, k)


@lean
def sew(net, f, j, n, k):
    """Edge j of face f and edge k of face n are the two sides of a seam."""
    net.faces[f].beside[j], net.faces[n].beside[k] = seam(n, k), seam(f, j)


@lean
def set_state(net, f, state, known):
    """Make a face another kind; it need not be asked up to a word of drift, or must be if that is EXPIRED."""
    net.faces[f].state = state
    net.faces[f].until = known
    if known == EXPIRED:
        enqueue(net, f)


@lean
def relink(net, n, u, f):
    """Tell face n, if it is one, that f is beyond its edge that begins at u."""
    if n >= 0:
        face = net.faces[n]
        for k in range(3):
            if face.corners[k] == u:
                face.beside[k] = f
