# mypy: allow-untyped-defs, allow-untyped-calls
"""Edges handed out to a function of the user's, and what it answered."""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import NEVER
from ._kernels_rgb_address import LEVELS, middle_key, slot_of
from ._kernels_rgb_criteria import is_asked
from ._kernels_rgb_known import ASK_BORN
from ._kernels_rgb_layout import (
    BORN,
    FREE_CODE,
    MEETS,
    NONE,
    WAITING,
    dequeue,
    edge_level,
    find_edge,
)
from ._kernels_rgb_points import ensure, ensure_at, position
from ._kernels_rgb_update import UNTOLD, force, has_room, is_from_here
from ._kernels_rgb_wanted import reconsider

#: There is no view.
NO_DRIFT = (0, 1.0)


@lean
def describe(net, a, b, level, v, i, ends, levels, middles):
    """Write the i-th edge."""
    ensure_at(net, a, level)
    ensure_at(net, b, level)
    if net.vertices[v].flags & BORN == 0:
        ensure(net, v, ASK_BORN)
    ends[i, 0, 0], ends[i, 0, 1], ends[i, 0, 2] = position(net, a, level)
    ends[i, 1, 0], ends[i, 1, 1], ends[i, 1, 2] = position(net, b, level)
    levels[i] = level
    for axis in range(3):
        middles[i, axis] = net.vertices[v].born[axis]


@lean
def describe_split(net, order, begin, ends, levels, middles):
    """Write the edges that these vertices split, from the begin-th on; where it stopped for want of slots."""
    for i in range(begin, len(order)):
        if not has_room(net):
            return i
        v = np.int64(order[i])
        d, level = net.vertices[v].diamond, np.int64(net.vertices[v].birth) - 1
        describe(net, np.int64(d[0]), np.int64(d[1]), level, v, i, ends, levels, middles)
    return len(order)


@lean
def set_meets(net, order, answers):
    """Note whether the edges that these vertices split meet the criteria; no drift makes that out of date."""
    for i in range(len(order)):
        v = order[i]
        vertex = net.vertices[v]
        vertex.flags = (vertex.flags | MEETS) if answers[i] else (vertex.flags & ~MEETS)
        vertex.until = NEVER
        reconsider(net, np.int64(v))


@lean
def candidates(net, pairs, ends, levels, middles):
    """Write the edges that are asked at the faces in the queue, until slots or places run out."""
    count = 0
    while net.counts[WAITING] > 0 and count + 3 <= len(pairs) and has_room(net):
        f = dequeue(net)
        face = net.faces[f]
        if face.code == FREE_CODE:
            continue
        for k in range(3):
            if face.until[k] == NEVER:
                continue
            face.until[k] = NEVER
            level = edge_level(face.code, k)
            if level == NONE or level >= LEVELS or not is_from_here(face, k):
                continue
            a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
            if is_asked(net, a, b, level):
                v = slot_of(net, middle_key(net, np.int64(face.base), a, b))
                describe(net, a, b, level, v, count, ends, levels, middles)
                pairs[count, 0], pairs[count, 1] = a, b
                count += 1
    return count


@lean
def split_pairs(net, pairs, begin, view, limits):
    """Split these edges from the begin-th on, unless something forced that; where slots ran out."""
    for i in range(begin, len(pairs)):
        h = find_edge(net, np.int64(pairs[i, 0]), np.int64(pairs[i, 1]))
        if h != NONE and not force(net, h // 3, h % 3, UNTOLD, view, limits, NO_DRIFT):
            return i
    return len(pairs)
