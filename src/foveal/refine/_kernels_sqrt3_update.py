# mypy: allow-untyped-defs, allow-untyped-calls
"""Which faces of a √3 refinement are split for a view, and bringing the mesh there from wherever it is.

A face is wanted split if it meets the criteria and one of its parents (the split faces that its newest
corners are from) is wanted. It is needed split if it is wanted, or parent of a needed one, or beside a
wanted one whose third at their edge meets the criteria. All this reads positions of uniform subdivision only;
so the mesh depends on the view, not on the way to it.

Answers are kept for as long as `_kernels_drift.py` says: `until` is a word of it. On an orbit of one degree
nineteen in twenty hold.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import EXPIRED, NEVER, holds, until
from ._kernels_sqrt3 import beyond_cut, cut_seam, split
from ._kernels_sqrt3_ask import (
    examine,
    examine_half,
    is_seen_beyond,
    wants_triangle,
    was_wanted_by_parent,
)
from ._kernels_sqrt3_layout import (
    DOUBTFUL,
    FACES,
    FREE,
    FREE_VERTICES,
    MEETS,
    NONE,
    QUEUED,
    STACK,
    VERTICES,
    WANTED,
    corner_at,
    is_half,
)
from ._kernels_sqrt3_slots import dequeue, doubt, enqueue, next_child
from ._kernels_sqrt3_undo import unsplit

#: Slots that a single examination may use: forced splits go down through the generations. Along a seam also
#: the face beyond may be behind, and what it waits for: there a single split is asked for at a time.
ROOM, LITTLE_ROOM = 512, 8


@lean
def review(net, view, limits, drift):
    """Ask anew where answers no longer hold, and see what follows of what is wanted."""
    for i in range(net.counts[VERTICES]):
        if net.births[i] <= 0 or holds(net.vertices[i].until, drift):
            continue
        v, vertex = np.int64(i), net.vertices[i]
        a, b, c = vertex.triple[0], vertex.triple[1], vertex.triple[2]
        meets, near, far = wants_triangle(net, a, b, c, net.births[v] - 1, view, limits)
        net.vertices[v].until = until(drift, near, far)
        if meets != (net.flags[v] & MEETS != 0):
            net.flags[v] ^= MEETS
            reconsider(net, v)


@lean
def reconsider(net, v):
    """Set anew whether v is wanted, and its children if that is news."""
    net.counts[STACK], top = v, 1
    while top > 0:
        top -= 1
        w = net.counts[STACK + top]
        is_now = net.flags[w] & MEETS != 0 and was_wanted_by_parent(net, w)
        if is_now == (net.flags[w] & WANTED != 0):
            continue
        net.flags[w] ^= WANTED
        if is_now:
            wake(net, w)
        else:
            doubt(net, w)
        c = np.int64(net.vertices[w].child)
        while c != NONE:
            net.counts[STACK + top] = c
            top += 1
            c = next_child(net, w, c)


@lean
def wake(net, v):
    """Let the faces at v be asked that were not, since they had no wanted parent."""
    first = np.int64(net.vertices[v].around)
    for is_back in (False, True):
        f = first
        while f >= 0:
            if net.faces[f].until == NEVER:
                net.faces[f].until = EXPIRED
                enqueue(net, f)
            k = corner_at(net.faces[f], v)
            f = np.int64(net.faces[f].beside[k if is_back else (k + 2) % 3])
            if f == first:
                return


@lean
def coarsen(net, view, limits, drift):
    """Undo the splits that may have to go and are not needed, and those needed by them alone; how many."""
    undone, held = 0, np.int64(NONE)
    while net.counts[DOUBTFUL] != NONE:
        v = net.counts[DOUBTFUL]
        vertex = net.vertices[v]
        net.counts[DOUBTFUL] = vertex.next
        is_to_go = net.births[v] > 0 and not is_needed(net, v)
        if is_to_go and is_held(net, v, view, limits, drift):
            vertex.next, held = held, v
            continue
        vertex.is_doubtful = False
        if is_to_go:
            unsplit(net, v)
            undone += 1
    net.counts[DOUBTFUL] = held  # from the next view they may look different
    return undone


@lean
def is_needed(net, v):
    """Whether a vertex, or one that came with it, at a border or beyond a seam, is wanted or has children."""
    for k in range(4):
        u = with_it(net, v, k)
        if u != NONE and (net.flags[u] & WANTED != 0 or net.vertices[u].child != NONE):
            return True
    return False


@lean
def is_held(net, v, view, limits, drift):
    """Whether a third beside has one of these kept."""
    for k in range(4):
        u = with_it(net, v, k)
        if u != NONE and is_seen_beyond(net, u, view, limits, drift):
            return True
    return False


@lean
def with_it(net, v, k):
    """The k-th of the vertices that came with v, or NONE: itself, its pair, its twin, its twin's pair."""
    p, t = np.int64(net.vertices[v].pair), np.int64(net.vertices[v].twin)
    if k < 2:
        return v if k == 0 else p
    if t == NONE or k == 2:
        return t
    return np.int64(net.vertices[t].pair)


@lean
def wake_expired(net, drift):
    """Put the faces whose answers no longer hold into the queue."""
    for f in range(net.counts[FACES]):
        if not holds(net.faces[f].until, drift) and net.faces[f].state != FREE:
            enqueue(net, f)


@lean
def split_as(net, f, is_own, known, view, limits, drift):
    """Split face f, which is wanted itself (is_own, up to which word that is known) or only needed.

    Where it is cut at a seam, the face beyond is split with it.
    """
    n = beyond_cut(net, f)
    if n == NONE:
        mark(net, split(net, f), is_own, known)
        return
    is_other, other = examine(net, n, view, limits, drift)
    p = cut_seam(net, f, n)
    mark(net, p, is_own, known)
    mark(net, np.int64(net.vertices[p].twin), is_other, other)


@lean
def mark(net, b, is_own, known):
    """Say of a new vertex, and its pair, whether its birth face was wanted split itself."""
    c = np.int64(net.vertices[b].pair)
    if is_own:
        net.flags[b] |= MEETS | WANTED
    else:
        doubt(net, b)
    net.vertices[b].until = known if is_own else EXPIRED
    if c != NONE:
        net.flags[c], net.vertices[c].until = net.flags[b], net.vertices[b].until


@lean
def has_room(net, room):
    """Whether so many slots are left for new faces and vertices."""
    return net.counts[FACES] + room <= len(net.faces) and net.counts[VERTICES] + room <= len(net.vertices)


@lean
def refine(net, most, chain, view, limits, drift):
    """Split what is wanted, beginning with the faces in the queue, until there are `most` vertices.

    Returns False when slots run out: the caller makes room and goes on. First in, first out: so most mates
    are split when a half's turn comes, and need not be imagined (against last in: half the time).
    """
    while net.counts[QUEUED] > 0 and net.counts[VERTICES] - net.counts[FREE_VERTICES] < most:
        if not has_room(net, ROOM):
            return False
        f = dequeue(net)
        if net.faces[f].state == FREE or holds(net.faces[f].until, drift):
            continue
        if is_half(net.faces[f].state):
            is_own, known = examine_half(net, f, view, limits, drift)
        else:
            is_own, known = examine(net, f, view, limits, drift)
        net.faces[f].until = EXPIRED if is_own else known
        if not is_own:
            continue
        if waits_for(net, f) == NONE:
            split_as(net, f, True, known, view, limits, drift)
        elif not force(net, f, chain, view, limits, drift):
            enqueue(net, f)
            return False
    return True


@lean
def waits_for(net, f):
    """What is to be split, or if a half to become a face, before f is; or NONE.

    A half waits for its mate, or the half of the last generation in its place; a face to be cut at a seam
    for that beyond, which may be the face before the last split, or still a half of the cut before that.
    """
    if is_half(net.faces[f].state):
        return np.int64(net.faces[f].beside[0])
    n = beyond_cut(net, f)
    return n if n != NONE and net.faces[n].state != net.faces[f].state else np.int64(NONE)


@lean
def force(net, f, chain, view, limits, drift):
    """Split face f, or make half f a face by splitting its mate, and first what they wait for.

    chain (n, 2): what waits for the next, and the state it had; from one to the third a generation is gone
    down. Returns False when slots run out: what was done is no less right.
    """
    chain[0, 0], chain[0, 1], depth = f, net.faces[f].state, 1
    while depth > 0:
        if not has_room(net, LITTLE_ROOM):
            return False
        h = np.int64(chain[depth - 1, 0])
        n = waits_for(net, h)
        if net.faces[h].state != chain[depth - 1, 1]:
            depth -= 1
        elif n != NONE:
            chain[depth, 0], chain[depth, 1] = n, net.faces[n].state
            depth += 1
        else:
            is_own, known = examine(net, h, view, limits, drift)
            split_as(net, h, is_own, known, view, limits, drift)
            depth -= 1
    return True
