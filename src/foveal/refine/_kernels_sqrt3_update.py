# mypy: allow-untyped-defs, allow-untyped-calls
"""Which faces of a √3 refinement are split for a view, and bringing the mesh there from wherever it is.

A face is wanted split if it meets the criteria and one of its parents (the split faces that its newest
corners are from) is wanted. It is needed split if it is wanted, or parent of a needed one, or beside a
wanted one whose third at their edge meets the criteria. All this reads positions of uniform subdivision only;
so the mesh depends on the view, not on the way to it.

Answers are kept with their slack: `drift` is how far the eye and the frustum moved in all since the
beginning, and a face's and a vertex's `until` say up to which drift an answer holds. On an orbit of one
degree nine in ten hold.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_sqrt3 import beyond_cut, cut_seam, split
from ._kernels_sqrt3_ask import (
    ROUNDED,
    examine,
    examine_half,
    is_seen_beyond,
    wants_triangle,
    was_wanted_by_parent,
)
from ._kernels_sqrt3_layout import (
    FACES,
    FREE,
    FREE_VERTICES,
    MEETS,
    NEEDED,
    NONE,
    PARENT,
    PARENTS,
    QUEUED,
    VERTICES,
    WANTED,
    corner_at,
    is_half,
)
from ._kernels_sqrt3_slots import dequeue, enqueue
from ._kernels_sqrt3_undo import unsplit

#: Slots that a single examination may use: forced splits go down through the generations. Along a seam also
#: the face beyond may be behind, and what it waits for: there a single split is asked for at a time.
ROOM, LITTLE_ROOM = 512, 8


@lean
def sort_by_birth(births, count, starts, order):
    """order: the vertices born after level 0, by birth; returns how many."""
    starts[:] = 0
    for v in range(count):
        if births[v] > 0:
            starts[births[v] + 1] += 1
    for i in range(1, len(starts)):
        starts[i] += starts[i - 1]
    total = starts[len(starts) - 1]
    for v in range(count):
        if births[v] > 0:
            order[starts[births[v]]] = v
            starts[births[v]] += 1
    return total


@lean
def review(net, order, count, view, limits, drift):
    """Set WANTED anew for the vertices of `order`, by rising birth, then NEEDED from last to first."""
    for i in range(count):
        v = np.int64(order[i])
        flags = net.flags[v] & (MEETS | PARENTS)
        if was_wanted_by_parent(net, v):
            vertex = net.vertices[v]
            if vertex.until <= drift:
                level = net.births[v] - 1
                a, b, c = vertex.triple[0], vertex.triple[1], vertex.triple[2]
                meets, slack = wants_triangle(net, a, b, c, level, view, limits)
                flags = (flags & PARENTS) | (MEETS if meets else 0)
                vertex.until = (drift + slack) * ROUNDED
            if flags & MEETS:
                flags |= WANTED
        if flags & ~net.flags[v] & WANTED:
            wake(net, v)
        net.flags[v] = flags
    for i in range(count - 1, -1, -1):
        v = np.int64(order[i])
        if net.flags[v] & (WANTED | NEEDED) == 0 and is_seen_beyond(net, v, view, limits):
            need(net, v)
        if net.flags[v] & (WANTED | NEEDED):
            need_parents(net, v)
            twin = np.int64(net.vertices[v].twin)
            if twin != NONE:  # wanted on one side of a seam only, it may have come after
                need(net, twin)
                need_parents(net, twin)


@lean
def need_parents(net, v):
    """Keep the splits of which the birth face of vertex v is made."""
    flags = net.flags[v]
    for k in range(3):
        if flags & (PARENT << k):
            need(net, np.int64(net.vertices[v].triple[k]))


@lean
def need(net, v):
    """Keep the split that made vertex v, and at a seam that beyond."""
    net.flags[v] |= NEEDED
    p, t = np.int64(net.vertices[v].pair), np.int64(net.vertices[v].twin)
    if p != NONE:
        net.flags[p] |= NEEDED
    if t != NONE:
        net.flags[t] |= NEEDED
        net.flags[net.vertices[t].pair] |= NEEDED


@lean
def wake(net, v):
    """Let the faces at v be asked that were not, since they had no wanted parent."""
    first = np.int64(net.vertices[v].around)
    for is_back in (False, True):
        f = first
        while f >= 0:
            if net.faces[f].until == math.inf:
                net.faces[f].until = 0.0
                enqueue(net, f)
            k = corner_at(net.faces[f], v)
            f = np.int64(net.faces[f].beside[k if is_back else (k + 2) % 3])
            if f == first:
                return


@lean
def coarsen(net, order, count):
    """Undo the splits whose vertices are not needed, finest first; returns how many."""
    undone = 0
    for i in range(count - 1, -1, -1):
        v = np.int64(order[i])
        if net.flags[v] & (WANTED | NEEDED) == 0 and net.births[v] != FREE:
            unsplit(net, v)
            undone += 1
    return undone


@lean
def wake_expired(net, drift):
    """Put the faces whose answers no longer hold into the queue."""
    for f in range(net.counts[FACES]):
        if net.faces[f].until <= drift and net.faces[f].state != FREE:
            enqueue(net, f)


@lean
def split_as(net, f, is_own, until, view, limits, drift):
    """Split face f, which is wanted itself (is_own, until which drift) or only needed.

    Where it is cut at a seam, the face beyond is split with it.
    """
    n = beyond_cut(net, f)
    if n == NONE:
        mark(net, split(net, f), is_own, until)
        return
    is_other, other = examine(net, n, view, limits, drift)
    p = cut_seam(net, f, n)
    mark(net, p, is_own, until)
    mark(net, np.int64(net.vertices[p].twin), is_other, other)


@lean
def mark(net, b, is_own, until):
    """Say of a new vertex, and its pair, whether its birth face was wanted split itself."""
    c = np.int64(net.vertices[b].pair)
    net.flags[b] |= MEETS | WANTED if is_own else NEEDED
    net.vertices[b].until = until if is_own else 0.0
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
        if net.faces[f].state == FREE or net.faces[f].until > drift:
            continue
        if is_half(net.faces[f].state):
            is_own, until = examine_half(net, f, view, limits, drift)
        else:
            is_own, until = examine(net, f, view, limits, drift)
        if not is_own:
            net.faces[f].until = until
        elif waits_for(net, f) == NONE:
            split_as(net, f, True, until, view, limits, drift)
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
            is_own, until = examine(net, h, view, limits, drift)
            split_as(net, h, is_own, until, view, limits, drift)
            depth -= 1
    return True
