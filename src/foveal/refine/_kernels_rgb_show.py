# mypy: allow-untyped-defs, allow-untyped-calls
"""What is drawn of an RGB triangulation, and what is forgotten of it."""

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_address import remove
from ._kernels_rgb_known import ASK_LIMIT
from ._kernels_rgb_layout import (
    BASE_COUNT,
    CLOCK,
    FACES,
    FREE,
    FREE_CODE,
    FREE_VERTEX,
    HAND,
    IN_USE,
    LIMIT,
    PRESENT,
    PRESENT_COUNT,
    ROUND,
    SINCE,
    VERTICES,
)
from ._kernels_rgb_points import ensure, ensure_at, position
from ._kernels_rgb_update import has_room


@lean
def shown_levels(net, levels):
    """levels[v]: the highest level among a vertex and its neighbours in the mesh, on which it stands."""
    for v in range(net.counts[VERTICES]):
        levels[v] = net.vertices[v].birth if net.vertices[v].flags & PRESENT else FREE
    for f in range(net.counts[FACES]):
        face = net.faces[f]
        if face.code != FREE_CODE:
            a, b, c = face.corners[0], face.corners[1], face.corners[2]
            level = max(net.vertices[a].birth, max(net.vertices[b].birth, net.vertices[c].birth))
            levels[a] = max(levels[a], level)
            levels[b] = max(levels[b], level)
            levels[c] = max(levels[c], level)


@lean
def place_all(net, levels, begin, is_limit, out):
    """out[v]: where the vertices of the mesh stand, from `begin` on; where it stopped for want of slots."""
    for i in range(begin, len(levels)):
        if levels[i] == FREE:
            continue
        if not has_room(net):
            return i
        v = np.int64(i)
        if is_limit:
            if net.vertices[v].flags & LIMIT == 0:
                ensure(net, v, ASK_LIMIT)
            limit = net.vertices[v].limit
            out[v, 0], out[v, 1], out[v, 2] = limit[0], limit[1], limit[2]
        else:
            ensure_at(net, v, np.int64(levels[v]))
            out[v, 0], out[v, 1], out[v, 2] = position(net, v, np.int64(levels[v]))
    return len(levels)


@lean
def forget(net, capacity):
    """Let time go on, and keep of the vertices that are not in the mesh so many.

    A hand goes around the slots; those go that were not used since it came by last. So this costs what it
    frees: to look for the oldest of all took 3 ms of each degree of an orbit at 100,000 triangles.
    """
    counts = net.counts
    counts[CLOCK] += 1
    excess = counts[IN_USE] - counts[PRESENT_COUNT] - capacity
    while excess > 0:  # ends in the third round, in which nothing is younger than the second
        if counts[HAND] >= counts[VERTICES]:
            counts[HAND], counts[SINCE], counts[ROUND] = counts[BASE_COUNT], counts[ROUND], counts[CLOCK]
        v = counts[HAND]
        counts[HAND] += 1
        vertex = net.vertices[v]
        if vertex.birth == FREE or vertex.flags & PRESENT != 0 or np.int64(vertex.stamp) >= counts[SINCE]:
            continue
        remove(net, vertex.key)
        net.vertices[v].birth, net.vertices[v].flags = FREE, 0
        vertex.diamond[0] = counts[FREE_VERTEX]
        counts[FREE_VERTEX] = v
        counts[IN_USE] -= 1
        excess -= 1
