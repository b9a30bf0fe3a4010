# mypy: allow-untyped-defs, allow-untyped-calls
"""Where vertices go by the neighbours at hand: one filtering step, and the limit.

Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000, section 3 and, for borders, 5.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_extract import NONE, corner_of
from ._kernels_filter import MOVES


@lean
def ring_of(net, v):
    """(valence, x, y, z): how many neighbours an inner vertex has, and their sum; valence 0 on a border."""
    first = np.int64(net.around[v])
    f, n = first, 0
    x = y = z = 0.0
    while True:
        k = corner_of(net.corners, f, v)
        u = net.corners[f, (k + 1) % 3]
        x, y, z = x + net.positions[u, 0], y + net.positions[u, 1], z + net.positions[u, 2]
        n += 1
        f = np.int64(net.beside[f, (k + 2) % 3])
        if f == first:
            return n, x, y, z
        if f == NONE:
            return 0, x, y, z


@lean
def border_sum(net, v):
    """(x, y, z): the sum of the two neighbours of v along the border."""
    x = y = z = 0.0
    for is_before in (True, False):
        f = np.int64(net.around[v])
        while True:
            k = corner_of(net.corners, f, v)
            n = np.int64(net.beside[f, (k + 2) % 3 if is_before else k])
            if n == NONE:
                break
            f = n
        u = net.corners[f, (k + 2) % 3 if is_before else (k + 1) % 3]
        x, y, z = x + net.positions[u, 0], y + net.positions[u, 1], z + net.positions[u, 2]
    return x, y, z


@lean
def share_of(shares, n):
    """Kobbelt's weight of the ring's mean, (4 - 2 cos(2 pi / n)) / 9, from a table as far as it goes."""
    return shares[n] if n < len(shares) else (4.0 - 2.0 * math.cos(2.0 * math.pi / n)) / 9.0


@lean
def prepare_moves(net, faces, is_odd, shares):
    """Where the corners of `faces` are to move, in the mesh before they are split.

    Written beyond the history's end, once for each vertex that moves: `move_all` exchanges it for where the
    vertex was. Returns how many. Border vertices move on odd iterations.
    """
    count, end = 0, net.counts[MOVES]
    for i in range(len(faces)):
        for k in range(3):
            v = np.int64(net.corners[faces[i], k])
            if net.marks[v]:
                continue
            net.marks[v] = 1
            n, x, y, z = ring_of(net, v)
            if n == 0 and not is_odd:
                continue
            one, other = 19.0 / 27.0, 4.0 / 27.0
            if n == 0:
                x, y, z = border_sum(net, v)
            else:
                share = share_of(shares, n)
                one, other = 1.0 - share, share / n
            net.moved[end + count] = v
            net.before[end + count, 0] = one * net.positions[v, 0] + other * x
            net.before[end + count, 1] = one * net.positions[v, 1] + other * y
            net.before[end + count, 2] = one * net.positions[v, 2] + other * z
            count += 1
    for i in range(len(faces)):
        for k in range(3):
            net.marks[net.corners[faces[i], k]] = 0
    return count


@lean
def move_all(net, count):
    """Move the vertices of the `count` prepared moves, which then say where these were."""
    for i in range(net.counts[MOVES], net.counts[MOVES] + count):
        v = net.moved[i]
        for axis in range(3):
            there = net.before[i, axis]
            net.before[i, axis] = net.positions[v, axis]
            net.positions[v, axis] = there
    net.counts[MOVES] += count


@lean
def limits(net, shares, positions):
    """positions: where each vertex would go in the limit if the mesh at hand were subdivided everywhere."""
    for v in range(len(positions)):
        one, other, x, y, z = 1.0, 0.0, 0.0, 0.0, 0.0
        if net.around[v] != NONE:
            n, x, y, z = ring_of(net, np.int64(v))
            if n == 0:
                x, y, z = border_sum(net, np.int64(v))
                one, other = 4.0 / 6.0, 1.0 / 6.0
            else:
                share = share_of(shares, n)
                one = 1.0 / (1.0 + 3.0 * share)
                other = 3.0 * share / ((1.0 + 3.0 * share) * n)
        positions[v, 0] = one * net.positions[v, 0] + other * x
        positions[v, 1] = one * net.positions[v, 1] + other * y
        positions[v, 2] = one * net.positions[v, 2] + other * z
