# mypy: allow-untyped-defs, allow-untyped-calls
"""Which faces of a √3 refinement are split for a view, and bringing the mesh there from wherever it is.

A face is wanted split if it meets the criteria and one of its parents (the split faces that its newest
corners are from) is wanted. It is needed split if it is wanted or parent of a needed one. Both read
positions of uniform subdivision only; so the mesh depends on the view, not on the way to it.

Answers are kept with their slack: `drift` is how far the eye and the frustum moved in all since the
beginning, and a face's and a vertex's `until` say up to which drift an answer holds. On an orbit of one
degree nine in ten hold.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_sqrt3 import split
from ._kernels_sqrt3_ask import ROUNDED, examine, examine_beyond, wants_triangle, was_wanted_by_parent
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
    generation,
    half,
    is_half,
)
from ._kernels_sqrt3_slots import dequeue, enqueue
from ._kernels_sqrt3_undo import unsplit

#: Slots that a single examination may use: forced splits go down through the generations.
ROOM = 512


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
        flags = net.flags[v]
        if flags & (WANTED | NEEDED):
            for k in range(3):
                if flags & (PARENT << k):
                    u = net.vertices[v].triple[k]
                    net.flags[u] |= NEEDED
                    if net.vertices[u].pair != NONE:
                        net.flags[net.vertices[u].pair] |= NEEDED


@lean
def wake(net, v):
    """Let the faces at v be asked that were not, since they had no wanted parent."""
    first = np.int64(net.vertices[v].around)
    for is_back in (False, True):
        f = first
        while f != NONE:
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
def split_as(net, f, is_own, until):
    """Split face f, which is wanted itself (is_own, until which drift) or only needed."""
    b = split(net, f)
    c = np.int64(net.vertices[b].pair)
    net.flags[b] |= MEETS | WANTED if is_own else NEEDED
    net.vertices[b].until = until if is_own else 0.0
    if c != NONE:
        net.flags[c], net.vertices[c].until = net.flags[b], net.vertices[b].until


@lean
def refine(net, most, chain, view, limits, drift):
    """Split what is wanted, beginning with the faces in the queue, until there are `most` vertices.

    Returns False when slots run out: the caller makes room and goes on. First in, first out: so most mates
    are split when a half's turn comes, and need not be imagined (against last in: half the time).
    """
    while net.counts[QUEUED] > 0 and net.counts[VERTICES] - net.counts[FREE_VERTICES] < most:
        if net.counts[FACES] + ROOM > len(net.faces) or net.counts[VERTICES] + ROOM > len(net.vertices):
            return False
        f = dequeue(net)
        if net.faces[f].state == FREE or net.faces[f].until > drift:
            continue
        if is_half(net.faces[f].state):
            is_own, until = examine_beyond(net, f, view, limits, drift)
            if is_own:
                force(net, f, chain, view, limits, drift)
            else:
                net.faces[f].until = until
            continue
        is_own, until = examine(net, f, view, limits, drift)
        if is_own:
            split_as(net, f, True, until)
        else:
            net.faces[f].until = until
    return True


@lean
def force(net, f, chain, view, limits, drift):
    """Split the mate of half f; where a half of the last generation is in its place, its mate first."""
    level = generation(net.faces[f].state)
    chain[0], depth = f, 1
    while depth > 0:
        h = np.int64(chain[depth - 1])
        n = np.int64(net.faces[h].beside[0])
        if net.faces[h].state != half(level - depth + 1):
            depth -= 1
        elif is_half(net.faces[n].state):
            chain[depth] = n
            depth += 1
        else:
            is_own, until = examine(net, n, view, limits, drift)
            split_as(net, n, is_own, until)
            depth -= 1
