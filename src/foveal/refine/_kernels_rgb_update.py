# mypy: allow-untyped-defs, allow-untyped-calls
"""Bringing an RGB triangulation to a view, from wherever it is.

What is wanted and what is needed `_kernels_rgb_wanted.py` knows.

Answers are kept for as long as `_kernels_drift.py` says; `until` is a word of it.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import EXPIRED, NEVER, holds, until
from ._kernels_rgb_address import middle_key, slot_of
from ._kernels_rgb_criteria import is_asked, wants_edge
from ._kernels_rgb_known import ASK_BORN
from ._kernels_rgb_layout import (
    BASE_COUNT,
    BLUE,
    BORN,
    CHAIN,
    DOUBTFUL,
    FACES,
    FACES_IN_USE,
    FREE_CODE,
    GREEN,
    MEETS,
    MERGES,
    NONE,
    NORMAL,
    PRESENT,
    PRESENT_COUNT,
    SPLITS,
    VERTICES,
    WAITING,
    WANTED,
    colour,
    corner_at,
    dequeue,
    edge_level,
    enqueue,
    find_edge,
)
from ._kernels_rgb_merge import merge_topology
from ._kernels_rgb_points import ensure, set_normal
from ._kernels_rgb_split import opposite, split_topology
from ._kernels_rgb_wanted import answer, consider_new, need, reconsider

#: Known of an edge to be split: nothing, nor is it to be asked.
UNTOLD = -1

#: Slots that examining a face may use: forced splits and stencils go down through the levels.
ROOM = 1024


@lean
def split_edge(net, f, k):
    """Split edge k of face f, both of whose faces allow it; returns the new vertex."""
    face = net.faces[f]
    a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
    n = np.int64(face.beside[k])
    c = opposite(net, f, k)
    d = np.int64(NONE) if n == NONE else opposite(net, n, corner_at(net.faces[n], b))
    v = slot_of(net, middle_key(net, np.int64(face.base), a, b))
    vertex = net.vertices[v]
    vertex.diamond[0], vertex.diamond[1], vertex.diamond[2], vertex.diamond[3] = a, b, c, d
    net.vertices[v].flags |= PRESENT
    if net.vertices[v].flags & BORN == 0:
        ensure(net, v, ASK_BORN)
    if net.vertices[v].flags & NORMAL == 0:
        set_normal(net, v)
    vertex.until = EXPIRED
    split_topology(net, f, k, v)
    need(net, v, 1)
    net.counts[SPLITS] += 1
    net.counts[PRESENT_COUNT] += 1
    return v


@lean
def merge_vertex(net, v):
    """Take a mergeable vertex out of the mesh; what is known of it is kept.

    If its edge met the criteria, it was not asked, as its makers are not wanted.
    """
    met = net.vertices[v].flags & MEETS != 0
    merge_topology(net, v, np.int64(NEVER) if met else np.int64(net.vertices[v].until))
    need(net, v, -1)
    net.vertices[v].flags &= ~(PRESENT | WANTED | MEETS)
    net.vertices[v].around = NONE
    net.counts[MERGES] += 1
    net.counts[PRESENT_COUNT] -= 1


@lean
def obstacle(net, f, k):
    """3 g + h for the edge that is to be split before edge k of face f can be, or NONE."""
    face = net.faces[f]
    shade = colour(face.code)
    if shade == GREEN:
        return np.int64(NONE)
    if shade == BLUE:
        g = np.int64(face.beside[0])
        return 3 * g + colour(net.faces[g].code)
    return np.int64(NONE) if shade == k else 3 * f + shade


@lean
def force(net, f, k, known, view, limits, drift):
    """Split edge k of face f, and before it whatever has to be; False if there are too few slots left.

    That edge itself is known to be wanted up to the word `known`, or EXPIRED; UNTOLD where nothing of what is
    split is to be asked, since a function of the user's will be.
    """
    chain = net.counts
    chain[CHAIN], chain[CHAIN + 1] = net.faces[f].corners[k], net.faces[f].corners[(k + 1) % 3]
    depth, h = 1, 3 * f + k
    while depth > 0:
        if not has_room(net):
            return False
        if h == NONE:
            h = find_edge(net, chain[CHAIN + 2 * depth - 2], chain[CHAIN + 2 * depth - 1])
        if h == NONE:
            depth -= 1
            continue
        g, i = h // 3, h % 3
        o = obstacle(net, g, i)
        n = np.int64(net.faces[g].beside[i])
        if o == NONE and n != NONE:
            o = obstacle(net, n, corner_at(net.faces[n], net.faces[g].corners[(i + 1) % 3]))
        if o != NONE:
            face, j = net.faces[o // 3], o % 3
            chain[CHAIN + 2 * depth] = face.corners[j]
            chain[CHAIN + 2 * depth + 1] = face.corners[(j + 1) % 3]
            depth, h = depth + 1, o
            continue
        h = np.int64(NONE)
        v = split_edge(net, g, i)
        depth -= 1
        if depth == 0 and known > EXPIRED:
            net.vertices[v].flags |= MEETS
            net.vertices[v].until = known
        if known != UNTOLD and not holds(net.vertices[v].until, drift):
            answer(net, v, view, limits, drift)
        consider_new(net, v)
    return True


@lean
def has_room(net):
    """Whether slots will do for what one step may take."""
    return net.counts[FACES] + ROOM <= len(net.faces) and net.counts[VERTICES] + ROOM <= len(net.vertices)


@lean
def review(net, begin, view, limits, drift):
    """Ask anew where answers no longer hold, from a slot on, and see what follows of what is wanted.

    Returns where it stopped for want of slots, or the end.
    """
    for i in range(max(begin, net.counts[BASE_COUNT]), net.counts[VERTICES]):
        v = np.int64(i)
        if net.vertices[v].flags & PRESENT == 0 or holds(net.vertices[v].until, drift):
            continue
        if not has_room(net):
            return i
        if answer(net, v, view, limits, drift):
            reconsider(net, v)
    return net.counts[VERTICES]


@lean
def coarsen(net):
    """Take out what is neither wanted nor needed, and what was needed by that alone."""
    while net.counts[DOUBTFUL] != NONE:
        v = net.counts[DOUBTFUL]
        vertex = net.vertices[v]
        net.counts[DOUBTFUL] = vertex.next
        vertex.is_doubtful = False
        if net.vertices[v].flags & (PRESENT | WANTED) == PRESENT and vertex.needed == 0:
            merge_vertex(net, v)


@lean
def enqueue_expired(net, drift):
    """Put the faces into the queue of which an edge's answer no longer holds."""
    for f in range(net.counts[FACES]):
        face = net.faces[f]
        if face.code != FREE_CODE and not (
            holds(face.until[0], drift) and holds(face.until[1], drift) and holds(face.until[2], drift)
        ):
            enqueue(net, f)


@lean
def is_from_here(face, k):
    """Whether it is this face that asks its green edge k: each edge is asked from one side only."""
    return face.beside[k] == NONE or face.corners[k] < face.corners[(k + 1) % 3]


#: How `refine` ended.
DONE, NO_ROOM, ENOUGH = 0, 1, 2


@lean
def refine(net, view, limits, drift, most_splits, most_faces):
    """Split what is wanted, beginning with the faces in the queue, up to so many splits ever and faces."""
    while net.counts[WAITING] > 0:
        if not has_room(net):
            return NO_ROOM
        if net.counts[SPLITS] >= most_splits or net.counts[FACES_IN_USE] > most_faces:
            return ENOUGH
        f = dequeue(net)
        face = net.faces[f]
        if face.code == FREE_CODE:
            continue
        for k in range(3):
            if holds(face.until[k], drift):
                continue
            # So it stays for red edges, for those asked from the other side, and for those that are not
            # asked: should that change, it becomes EXPIRED.
            face.until[k] = NEVER
            level = edge_level(face.code, k)
            if level == NONE or not is_from_here(face, k):
                continue
            a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
            if not is_asked(net, a, b, level):
                continue
            meets, near, far = wants_edge(net, a, b, level, view, limits)
            if meets:
                face.until[k] = EXPIRED
                if not force(net, f, k, until(drift, near, far), view, limits, drift):
                    enqueue(net, f)
                    return NO_ROOM
                break  # the face is another now, and in the queue
            face.until[k] = until(drift, near, far)
    return DONE
