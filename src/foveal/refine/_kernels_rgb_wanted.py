# mypy: allow-untyped-defs, allow-untyped-calls
"""Which splits of an RGB triangulation are wanted for themselves, which are needed, and what follows of news.

An edge is wanted split if it meets the criteria and is asked at all: `is_asked` says by which splits, which
are coarser ones or halves of the same level. It is needed split if it is wanted, or if a needed one's
triangles take it: then an end or apex of that one was born on its level, and this is the edge which that
vertex splits. All that reads positions of uniform subdivision only, so the mesh depends on the view and not
on the way to it.

Wanted is a flag; by how many splits a vertex is taken is counted, and by how many wanted ones of half edges.
So a change is followed from vertex to vertex, and what did not change is not looked at.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import until
from ._kernels_rgb_criteria import is_asked, wants_edge
from ._kernels_rgb_layout import (
    DOUBTFUL,
    MEETS,
    NONE,
    STACK,
    WANTED,
    ask_around,
    corner_at,
)


@lean
def answer(net, v, view, limits, drift):
    """Ask whether the edge that v splits meets the criteria; whether that is news."""
    vertex = net.vertices[v]
    a, b, met = np.int64(vertex.diamond[0]), np.int64(vertex.diamond[1]), net.vertices[v].flags & MEETS
    meets, near, far = wants_edge(net, a, b, np.int64(net.vertices[v].birth) - 1, view, limits)
    net.vertices[v].flags = (net.vertices[v].flags | MEETS) if meets else (net.vertices[v].flags & ~MEETS)
    vertex.until = until(drift, near, far)
    return (net.vertices[v].flags & MEETS) != met


@lean
def judge(net, v):
    """Set whether a vertex is wanted, by its edge's makers and by what is known of the criteria."""
    vertex = net.vertices[v]
    a, b = np.int64(vertex.diamond[0]), np.int64(vertex.diamond[1])
    if net.vertices[v].flags & MEETS and is_asked(net, a, b, np.int64(net.vertices[v].birth) - 1):
        net.vertices[v].flags |= WANTED
    else:
        net.vertices[v].flags &= ~WANTED


@lean
def consider_new(net, v):
    """Set whether a new vertex is wanted, and what follows. What it would make is not there yet."""
    judge(net, v)
    if net.vertices[v].flags & WANTED:
        follow(net, take(net, 0, v, 1))
    else:
        doubt(net, v)


@lean
def reconsider(net, v):
    """Set anew whether v is wanted, and all that follows if that is news."""
    net.counts[STACK] = v
    follow(net, 1)


@lean
def follow(net, top):
    """The same of the first `top` vertices on the stack."""
    while top > 0:
        top -= 1
        w = net.counts[STACK + top]
        was_wanted = net.vertices[w].flags & WANTED
        judge(net, w)
        if net.vertices[w].flags & WANTED == was_wanted:
            continue
        if was_wanted:
            doubt(net, w)
        else:
            ask_around(net, w)
        top = push_made(net, top, w)
        top = take(net, top, w, -1 if was_wanted else 1)


@lean
def take(net, top, v, change):
    """Count for what the split v of a half edge takes that a wanted half does, or no longer."""
    diamond, level = net.vertices[v].diamond, net.vertices[v].birth - 1
    if level == 0 or (net.vertices[diamond[0]].birth == level and net.vertices[diamond[1]].birth == level):
        return top
    for k in range(4):
        u = np.int64(diamond[k])
        if u != NONE and net.vertices[u].birth == level:
            before = net.vertices[u].halves
            net.vertices[u].halves = before + change
            if before == 0:
                ask_around(net, u)
            if before == 0 or before + change == 0:
                top = push_made(net, top, u)
    return top


@lean
def push_made(net, top, v):
    """Put the vertices that split the edges which v makes onto the chain: all of those end at v."""
    first = np.int64(net.vertices[v].around)
    f = first
    while f != NONE:
        face = net.faces[f]
        k = corner_at(face, v)
        top = push_made_to(net, top, v, np.int64(face.corners[(k + 1) % 3]))
        last = np.int64(face.corners[(k + 2) % 3])
        f = np.int64(face.beside[(k + 2) % 3])
        if f == first:
            return top
        if f == NONE:
            top = push_made_to(net, top, v, last)
    f = np.int64(net.faces[first].beside[corner_at(net.faces[first], v)])
    while f != NONE:  # a border: the other way
        face = net.faces[f]
        k = corner_at(face, v)
        top = push_made_to(net, top, v, np.int64(face.corners[(k + 1) % 3]))
        f = np.int64(face.beside[k])
    return top


@lean
def push_made_to(net, top, v, w):
    """The same of the one edge that goes from v towards its neighbour w, which may split a piece of it."""
    level = net.vertices[v].birth + 1
    while net.vertices[w].birth >= level:
        a, b = np.int64(net.vertices[w].diamond[0]), np.int64(net.vertices[w].diamond[1])
        if v != a and v != b:
            return top
        if net.vertices[w].birth == level:
            net.counts[STACK + top] = w
            return top + 1
        w = b if v == a else a
    return top


@lean
def need(net, v, change):
    """Count for the splits that v's triangles take that v takes them, or no longer."""
    diamond, level = net.vertices[v].diamond, net.vertices[v].birth - 1
    if level == 0:
        return
    for k in range(4):
        u = np.int64(diamond[k])
        if u != NONE and net.vertices[u].birth == level:
            net.vertices[u].needed += change
            if net.vertices[u].needed == 0:
                doubt(net, u)


@lean
def doubt(net, v):
    """Have it seen to whether v is to be in the mesh."""
    vertex = net.vertices[v]
    if not vertex.is_doubtful:
        vertex.is_doubtful = True
        vertex.next = net.counts[DOUBTFUL]
        net.counts[DOUBTFUL] = v
