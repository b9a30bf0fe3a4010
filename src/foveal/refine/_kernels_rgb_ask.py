# mypy: allow-untyped-defs, allow-untyped-calls
"""Edges handed out to a function of the user's, and what it answered."""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_address import LEVELS, middle_key, slot_of
from ._kernels_rgb_criteria import has_wanted_maker
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
from ._kernels_rgb_update import across, force, has_room, is_asked_at, middle_of, reconsider


@lean
def describe(net, a, b, level, v, i, ends, levels, middles):
    """Write the i-th edge."""
    ensure_at(net, a, level)
    ensure_at(net, b, level)
    if net.flags[v] & BORN == 0:
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
        d = net.vertices[v].diamond
        describe(
            net, np.int64(d[0]), np.int64(d[1]), np.int64(net.births[v]) - 1, v, i, ends, levels, middles
        )
    return len(order)


@lean
def set_meets(net, order, answers):
    """Note whether the edges that these vertices split meet the criteria; no drift makes that out of date."""
    for i in range(len(order)):
        v = order[i]
        net.flags[v] = (net.flags[v] | MEETS) if answers[i] else (net.flags[v] & ~MEETS)
        net.vertices[v].until = math.inf
        reconsider(net, np.int64(v))


@lean
def candidates(net, pairs, ends, levels, middles):
    """Write the edges with a wanted maker at the faces in the queue, until slots or places run out.

    `pairs`: the ends of the edge to be split for each, which is itself if it is there.
    """
    count = 0
    while net.counts[WAITING] > 0 and count + 3 <= len(pairs) and has_room(net):
        f = dequeue(net)
        face = net.faces[f]
        if face.code == FREE_CODE:
            continue
        for k in range(3):
            if face.until[k] == math.inf:
                continue
            face.until[k] = math.inf
            level = edge_level(face.code, k)
            if level != NONE and not is_asked_at(face, k):
                continue
            g, j = np.int64(f), np.int64(k)
            a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
            if level == NONE:  # an inner edge that is not there yet: what makes it would be split
                g, j, a = across(net, f)
                level = np.int64(net.births[a])
                b = middle_of(net, g, j) if level < LEVELS else b
            if level < LEVELS and has_wanted_maker(net, a, b, level):
                v = slot_of(net, middle_key(net, np.int64(face.base), a, b))
                describe(net, a, b, level, v, count, ends, levels, middles)
                other = net.faces[g]
                pairs[count, 0], pairs[count, 1] = other.corners[j], other.corners[(j + 1) % 3]
                count += 1
    return count


@lean
def split_pairs(net, pairs, begin, view, limits):
    """Split these edges from the begin-th on, unless something forced that; where slots ran out."""
    for i in range(begin, len(pairs)):
        h = find_edge(net, np.int64(pairs[i, 0]), np.int64(pairs[i, 1]))
        if h != NONE and not force(net, h // 3, h % 3, 0.0, view, limits, -1.0):
            return i
    return len(pairs)
