# mypy: allow-untyped-defs, allow-untyped-calls
"""Edge collapse inside one cell, cheapest edge first: arrays in, arrays changed in place.

Based on: J. Cohen, D. Manocha, M. Olano. Simplifying polygonal models using successive mappings. IEEE
Visualization 1997 (the lazy queue: an edge is measured again when its turn comes, not whenever a vertex of
it moved. Against measuring at once, with the queue built at one go: 1.46 -> 0.88 s on the dragon, errors
0.4 % up).
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_allowed import breaks_link, shared_faces, turns_over, vanished
from ._kernels_quadrics import place

#: A collapse costs at least this share of the squared distance between what it takes away and what it
#: leaves. The quadric's mean does not see a tip that goes: on the dragon at 11 bits (871 K triangles in
#: cells of 16 K, seven levels) the errors were 0.51 0.69 1.8 1.8 3.1 4.5 7.4 mm with planes by area, 0.43
#: 0.62 1.1 1.6 2.5 5.7 7.7 by its root, 0.24 0.37 0.49 0.69 0.93 1.3 3.2 with this too; on igea, which has
#: nothing thin, a tenth up or down either way; file size within 0.1 %, 3 to 8 % more time. 1 orders by
#: extremes what is only rough (igea's middle levels got a tenth to a third worse), 1/9 lets more of the
#: dragon go (0.43 0.75 at the second and third level). Adding up the distances of all collapses before was
#: worse on both.
VANISHED = 0.25


@lean
def push(heap, size, key):
    """Put a key into the heap's array (least first) of `size` keys."""
    i = size
    while i > 0:
        parent = (i - 1) >> 1
        if heap[parent] <= key:
            break
        heap[i] = heap[parent]
        i = parent
    heap[i] = key


@lean
def sift(heap, size, i, key):
    """Let `key` sink from place i of a heap of `size` keys."""
    while True:
        child = 2 * i + 1
        if child >= size:
            break
        if child + 1 < size and heap[child + 1] < heap[child]:
            child += 1
        if heap[child] >= key:
            break
        heap[i] = heap[child]
        i = child
    heap[i] = key


@lean
def survivor(into, v):
    """The vertex that v has become."""
    while into[v] != v:
        into[v] = into[into[v]]
        v = np.int64(into[v])
    return v


@lean
def key_of(cost, slot):
    """Orders by cost: bits of a float that is not negative are ordered as it is; the slot breaks ties."""
    return (np.int64(np.float32(min(cost, 3e38)).view(np.int32)) << 32) | slot


@lean
def offer_all(positions, faces, alive, twins, quadrics, locked, versions, slots, heap, is_strict):
    """Fill the queue with every edge, once where the surface is a proper one; returns how many.

    A slot is (u, v, sum of their versions); (-1 - u, v, sum) once
    `collapse` has measured it.
    """
    count = 0
    for f in range(len(faces)):
        if not alive[f]:
            continue
        for k in range(3):
            u, v = np.int64(faces[f, k]), np.int64(faces[f, (k + 1) % 3])
            is_first = u < v or twins[f, k] < 0 or not is_strict
            if not is_first or (locked[u] and locked[v]):
                continue
            cost, _, _, _ = place(positions, quadrics, locked, u, v)
            slots[count, 0], slots[count, 1], slots[count, 2] = u, v, versions[u] + versions[v]
            heap[count] = key_of(cost, count)
            count += 1
    for i in range(count // 2 - 1, -1, -1):
        sift(heap, count, np.int64(i), heap[i])
    return count


@lean
def blend(attributes, positions, u, v, x, y, z):
    """Attributes of the new vertex, by where it lies along the edge."""
    ex, ey, ez = (
        positions[v, 0] - positions[u, 0],
        positions[v, 1] - positions[u, 1],
        positions[v, 2] - positions[u, 2],
    )
    squared = ex * ex + ey * ey + ez * ez
    s = 0.5
    if squared > 0.0:
        dx, dy, dz = x - positions[u, 0], y - positions[u, 1], z - positions[u, 2]
        s = min(1.0, max(0.0, (dx * ex + dy * ey + dz * ez) / squared))
    for k in range(attributes.shape[1]):
        attributes[u, k] += np.float32(s) * (attributes[v, k] - attributes[u, k])


@lean
def merge(faces, alive, starts, counts, refs, end, valence, u, v):
    """Rename v to u in all faces; what has both dies. u's list moves to `end`. Returns (died, end)."""
    died = 0
    begin = end
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if not alive[f]:
            continue
        if faces[f, 0] == v or faces[f, 1] == v or faces[f, 2] == v:
            alive[f] = False
            died += 1
            for k in range(3):
                valence[faces[f, k]] -= 1
        else:
            refs[end] = f
            end += 1
    for i in range(starts[v], starts[v] + counts[v]):
        f = refs[i]
        if not alive[f]:
            continue
        for k in range(3):
            if faces[f, k] == v:
                faces[f, k] = u
        refs[end] = f
        end += 1
    starts[u] = begin
    counts[u] = end - begin
    valence[u] = end - begin
    valence[v] = 0
    counts[v] = 0
    return died, end


@lean
def compact(alive, starts, counts, refs, fresh):
    """Copy the lists without dead faces into `fresh`; returns how much of it is used."""
    end = 0
    for v in range(len(starts)):
        begin = end
        for i in range(starts[v], starts[v] + counts[v]):
            if alive[refs[i]]:
                fresh[end] = refs[i]
                end += 1
        starts[v] = begin
        counts[v] = end - begin
    for i in range(end):  # a slice would take two seconds to compile
        refs[i] = fresh[i]
    return end


@lean
def collapse(
    positions,
    faces,
    alive,
    starts,
    counts,
    refs,
    fresh,
    end,
    valence,
    is_border,
    quadrics,
    attributes,
    locked,
    versions,
    into,
    slots,
    heap,
    queued,
    marks,
    worst,
    stamp,
    live,
    target,
    is_strict,
):
    """Collapse cheapest edges until `target` faces live or the queue is empty: (live, end, stamp).

    Strict: no face turns over and the topology stays. Not strict: anything goes that keeps locked
    vertices; each edge of a closed surface still has an even number of faces, since renaming one vertex
    maps cycles to cycles.
    """
    while live > target and queued > 0:
        slot = heap[0] & 0xFFFFFFFF
        queued -= 1
        if queued > 0:
            sift(heap, queued, np.int64(0), heap[queued])
        u, v = np.int64(slots[slot, 0]), np.int64(slots[slot, 1])
        is_measured = bool(u < 0)
        if is_measured:
            u = -1 - u
        u, v = survivor(into, u), survivor(into, v)
        if u == v or (locked[u] and locked[v]):
            continue
        now = versions[u] + versions[v]
        if now != slots[slot, 2]:
            cost, x, y, z = place(positions, quadrics, locked, u, v)
            slots[slot, 0] = u
            slots[slot, 1] = v
            slots[slot, 2] = now
            is_measured = False
            if queued > 0 and key_of(cost, slot) > heap[0]:
                push(heap, queued, key_of(cost, slot))
                queued += 1
                continue
        if locked[v]:
            u, v = v, u
        cost, x, y, z = place(positions, quadrics, locked, u, v)
        if is_strict:
            stamp += 2
            if breaks_link(faces, alive, starts, counts, refs, valence, is_border, marks, stamp, u, v):
                continue
            if turns_over(positions, faces, alive, starts, counts, refs, u, v, x, y, z):
                continue
            if turns_over(positions, faces, alive, starts, counts, refs, v, u, x, y, z):
                continue
            if not is_measured:
                enough = cost / VANISHED
                lost = VANISHED * vanished(
                    positions, faces, alive, starts, counts, refs, u, v, x, y, z, enough
                )
                if lost > cost:
                    slots[slot, 0] = -1 - slots[slot, 0]
                    push(heap, queued, key_of(lost, slot))
                    queued += 1
                    continue
        elif shared_faces(faces, alive, starts, counts, refs, u, v) >= live:
            continue  # a cell never becomes empty
        if end + counts[u] + counts[v] > len(refs):
            end = compact(alive, starts, counts, refs, fresh)
        if not locked[u]:
            blend(attributes, positions, u, v, x, y, z)
        died, end = merge(faces, alive, starts, counts, refs, end, valence, u, v)
        live -= died
        worst[0] = max(worst[0], cost)
        positions[u, 0] = x
        positions[u, 1] = y
        positions[u, 2] = z
        for k in range(11):
            quadrics[u, k] += quadrics[v, k]
        is_border[u] |= is_border[v]
        versions[u] = max(versions[u], versions[v]) + 1
        into[v] = u
    return live, end, stamp
