# mypy: allow-untyped-defs, allow-untyped-calls
"""Which faces of a √3 refinement are split for a view, and bringing the mesh there from wherever it is.

A face is wanted split if it meets the criteria and one of its parents (the split faces that its newest
corners are from) is wanted. It is needed split if it is wanted or parent of a needed one. Both read
positions of uniform subdivision only; so the mesh depends on the view, not on the way to it.

Answers are kept with their slack: `drift` is how far the eye and the frustum moved in all since the
beginning, and `face_until`, `vertex_until` say up to which drift an answer holds. On an orbit of one
degree nine in ten hold.
"""

import numpy as np

from foveal.base.jit import kernel

from ._kernels_criteria import is_wanted
from ._kernels_sqrt3 import split
from ._kernels_sqrt3_layout import (
    FACES,
    FREE,
    MEETS,
    NEEDED,
    NONE,
    VERTICES,
    WANTED,
    generation,
    half,
    is_half,
)
from ._kernels_sqrt3_points import position, virtual_apex
from ._kernels_sqrt3_undo import unsplit

#: Slots that a single examination may use: forced splits go down through the generations.
ROOM = 512


@kernel
def wants_triangle(net, u, v, w, level, view, limits):
    """(is wanted, slack) of the face of generation `level` at these vertices."""
    ax, ay, az = position(net, u, level)
    bx, by, bz = position(net, v, level)
    cx, cy, cz = position(net, w, level)
    return is_wanted(view, limits, level, ax, ay, az, bx, by, bz, cx, cy, cz, net.normals, u, v, w)


@kernel
def has_wanted_parent(net, u, v, w, level):
    """Whether a face of generation `level` at these vertices has a parent that is wanted, or needs none."""
    if level == 0:
        return True
    return (
        (net.births[u] == level and (net.flags[u] & WANTED) != 0)
        or (net.births[v] == level and (net.flags[v] & WANTED) != 0)
        or (net.births[w] == level and (net.flags[w] & WANTED) != 0)
    )


@kernel
def review(net, order, view, limits, drift):
    """Set WANTED anew for the vertices of `order`, by rising birth, then NEEDED from last to first."""
    for v in order:
        a, b, c = net.triples[v, 0], net.triples[v, 1], net.triples[v, 2]
        level = net.births[v] - 1
        if not has_wanted_parent(net, a, b, c, level):
            net.flags[v] &= MEETS
            continue
        if net.vertex_until[v] <= drift:
            meets, slack = wants_triangle(net, a, b, c, level, view, limits)
            net.flags[v] = MEETS if meets else 0
            net.vertex_until[v] = drift + slack
        net.flags[v] = MEETS | WANTED if net.flags[v] & MEETS else 0
    for i in range(len(order) - 1, -1, -1):
        v = order[i]
        if net.flags[v] & (WANTED | NEEDED):
            for k in range(3):
                u = net.triples[v, k]
                if net.births[u] == net.births[v] - 1 and net.births[u] > 0:
                    net.flags[u] |= NEEDED
                    if net.pairs[u] != NONE:
                        net.flags[net.pairs[u]] |= NEEDED


@kernel
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


@kernel
def coarsen(net, order):
    """Undo the splits whose vertices are not needed, finest first; returns how many."""
    undone = 0
    for i in range(len(order) - 1, -1, -1):
        v = order[i]
        if net.flags[v] & (WANTED | NEEDED) == 0 and net.births[v] != FREE:
            unsplit(net, v)
            undone += 1
    return undone


@kernel
def enqueue(f, queue, ends, queued):
    """Put a face at the end of the queue, a ring, unless it waits there already. ends: first, how many."""
    if not queued[f]:
        queued[f] = True
        i = ends[0] + ends[1]
        queue[i if i < len(queue) else i - len(queue)] = f
        ends[1] += 1


@kernel
def enqueue_around(net, v, queue, ends, queued):
    """Put the faces at a new vertex into the queue."""
    for is_back in (False, True):
        first = np.int64(net.around[v])
        f = first
        for _ in range(16):
            enqueue(f, queue, ends, queued)
            k = 0 if net.faces[f, 0] == v else (1 if net.faces[f, 1] == v else 2)
            f = np.int64(net.beside[f, k if is_back else (k + 2) % 3])
            if f in (NONE, first):
                break
        if f == first:
            break


@kernel
def split_and_enqueue(net, f, is_own, until, queue, ends, queued):
    """Split face f and put the faces at its new vertices into the queue."""
    b = split(net, f)
    c = np.int64(net.pairs[b])
    net.flags[b] = MEETS | WANTED if is_own else NEEDED
    net.vertex_until[b] = until
    enqueue_around(net, b, queue, ends, queued)
    if c != NONE:
        net.flags[c], net.vertex_until[c] = net.flags[b], until
        enqueue_around(net, c, queue, ends, queued)


@kernel
def examine(net, f, view, limits, drift):
    """(is wanted, until which drift) of a face; a drift of 0 where its parents have to be asked again."""
    level = generation(net.states[f])
    u, v, w = net.faces[f, 0], net.faces[f, 1], net.faces[f, 2]
    if not has_wanted_parent(net, u, v, w, level):
        return False, 0.0
    meets, slack = wants_triangle(net, u, v, w, level, view, limits)
    return meets, drift + slack


@kernel
def examine_beyond(net, h, view, limits, drift):
    """The same of the two faces that half h is to be part of: whether one of them is wanted."""
    level = generation(net.states[h]) + 1
    w, x, b = net.faces[h, 0], net.faces[h, 1], net.faces[h, 2]
    if (net.flags[b] & WANTED) == 0:
        return False, 0.0
    dx, dy, dz = virtual_apex(net, h)
    wx, wy, wz = position(net, w, level)
    xx, xy, xz = position(net, x, level)
    bx, by, bz = position(net, b, level)
    meets, slack = is_wanted(view, limits, level, wx, wy, wz, dx, dy, dz, bx, by, bz, net.normals, w, x, b)
    if meets:
        return True, 0.0
    meets, other = is_wanted(view, limits, level, xx, xy, xz, bx, by, bz, dx, dy, dz, net.normals, x, b, w)
    return meets, drift + min(slack, other)


@kernel
def waiting(net, drift, queue, queued):
    """Put the faces whose answers no longer hold into the empty queue; returns how many."""
    count = 0
    for f in range(net.counts[FACES]):
        if net.face_until[f] <= drift and net.states[f] != FREE:
            queue[count] = f
            queued[f] = True
            count += 1
    return count


@kernel
def refine(net, queue, ends, queued, chain, view, limits, drift):
    """Split what is wanted, beginning with the faces in the queue; whether it is done.

    Stops early when slots run out: the caller makes room and goes on. First in, first out: so most mates are
    split when a half's turn comes, and need not be imagined (against last in: half the time).
    """
    while ends[1] > 0:
        if net.counts[FACES] + ROOM > len(net.faces) or net.counts[VERTICES] + ROOM > len(net.points):
            return False
        f = np.int64(queue[ends[0]])
        ends[0] = ends[0] + 1 if ends[0] + 1 < len(queue) else 0
        ends[1] -= 1
        queued[f] = False
        if net.states[f] == FREE or net.face_until[f] > drift:
            continue
        if is_half(net.states[f]):
            is_own, until = examine_beyond(net, f, view, limits, drift)
            if is_own:
                force(net, f, queue, ends, queued, chain, view, limits, drift)
            else:
                net.face_until[f] = until
            continue
        is_own, until = examine(net, f, view, limits, drift)
        if is_own:
            split_and_enqueue(net, f, True, until, queue, ends, queued)
        else:
            net.face_until[f] = until
    return True


@kernel
def force(net, f, queue, ends, queued, chain, view, limits, drift):
    """Split the mate of half f; where a half of the last generation is in its place, its mate first."""
    level = generation(net.states[f])
    chain[0], depth = f, 1
    while depth > 0:
        h = np.int64(chain[depth - 1])
        n = np.int64(net.beside[h, 0])
        if net.states[h] != half(level - depth + 1):
            depth -= 1
        elif is_half(net.states[n]):
            chain[depth] = n
            depth += 1
        else:
            is_own, until = examine(net, n, view, limits, drift)
            split_and_enqueue(net, n, is_own, until, queue, ends, queued)
            depth -= 1


@kernel
def place(net, levels, out):
    """levels[v]: the highest generation of the faces at v; out[v]: its position there."""
    for v in range(len(levels)):
        levels[v] = net.births[v]
    for f in range(net.counts[FACES]):
        if net.states[f] != FREE:
            for k in range(3):
                levels[net.faces[f, k]] = max(levels[net.faces[f, k]], generation(net.states[f]))
    for v in range(len(levels)):
        if net.births[v] != FREE:
            out[v, 0], out[v, 1], out[v, 2] = position(net, v, levels[v])
