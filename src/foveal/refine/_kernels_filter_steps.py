# mypy: allow-untyped-defs, allow-untyped-calls
"""The refinement sequence: which faces an iteration splits, and its three steps but the filtering."""

import math

import numpy as np

from foveal.base.jit import lean
from foveal.mesh._kernels_area import area_vector

from . import _kernels_extract as known
from ._kernels_criteria import BACK, BEND, EDGE, EYE, FRONT, ITERATIONS, PIXELS, SILHOUETTE, THIRD
from ._kernels_extract import AREA, NONE, STRIP, SWAP
from ._kernels_filter import FACES, VERTICES, split, swap


@lean
def longest_edge(net, f, view):
    """(length, away): of the longest edge of face f, and how far the eye is from the face's middle."""
    a, b, c = net.corners[f, 0], net.corners[f, 1], net.corners[f, 2]
    ab = bc = ca = away = 0.0
    for axis in range(3):
        x, y, z = net.positions[a, axis], net.positions[b, axis], net.positions[c, axis]
        ab, bc, ca = ab + (y - x) * (y - x), bc + (z - y) * (z - y), ca + (x - z) * (x - z)
        reach = view[EYE + axis] - (x + y + z) * THIRD
        away += reach * reach
    return math.sqrt(max(ab, max(bc, ca))), math.sqrt(away)


@lean
def is_flat(net, f, limit):
    """Whether the normals of face f and of each face beside it differ by less: 1 - cos < limit."""
    x, y, z = area_vector(net.positions, net.corners, f)
    length = math.sqrt(x * x + y * y + z * z)
    for k in range(3):
        n = np.int64(net.beside[f, k])
        if n != NONE:
            a, b, c = area_vector(net.positions, net.corners, n)
            both = length * math.sqrt(a * a + b * b + c * c)
            if not both - (x * a + y * b + z * c) < limit * both:
                return False
    return True


@lean
def is_coarse(net, f, view, limits, kind, iteration):
    """Whether face f is to be split as one of a kind."""
    if iteration >= limits[kind, ITERATIONS]:
        return False
    if limits[kind, EDGE] > 0.0:
        longest, away = longest_edge(net, f, view)
        if view[PIXELS] * longest <= limits[kind, EDGE] * away:
            return False
    return not (limits[kind, BEND] > 0.0 and is_flat(net, f, limits[kind, BEND]))


@lean
def choose(net, candidates, strips, chosen, view, limits, iteration):
    """chosen: the faces to be split, silhouettes first; it begins with `strips` strip faces.

    The others lose their flags: with all their parts they are done. Returns how many silhouette faces are
    chosen, and how many faces in all.
    """
    count = 0
    for i in range(strips):
        f = np.int64(chosen[i])
        if is_coarse(net, f, view, limits, SILHOUETTE, iteration):
            chosen[count] = f
            count += 1
        else:
            net.flags[f] &= ~STRIP & 0xFF
    silhouettes = count
    for i in range(len(candidates)):
        f = np.int64(candidates[i])
        flags = net.flags[f]
        if flags & AREA:
            kind = FRONT if flags & known.FRONT else BACK
            if not is_coarse(net, f, view, limits, kind, iteration):
                net.flags[f] &= ~AREA & 0xFF
            elif not flags & STRIP:
                chosen[count] = f
                count += 1
        if not net.flags[f] & (AREA | STRIP):
            net.flags[f] = 0
    return silhouettes, count


@lean
def split_all(net, faces, is_odd, thirds):
    """Split `faces`; thirds: what they became."""
    old = np.int64(net.counts[VERTICES])
    for i in range(len(faces)):
        f = np.int64(faces[i])
        thirds[3 * i], thirds[3 * i + 1], thirds[3 * i + 2] = f, net.counts[FACES], net.counts[FACES] + 1
        split(net, f, is_odd, old)


@lean
def swap_all(net, thirds):
    """Swap the old edges of thirds, whatever is beyond them; each once."""
    for i in range(len(thirds)):
        f = np.int64(thirds[i])
        if net.flags[f] & SWAP:
            net.flags[f] &= ~SWAP & 0xFF
            if net.beside[f, 0] != NONE:
                swap(net, f)
