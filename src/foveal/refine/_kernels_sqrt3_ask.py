# mypy: allow-untyped-defs, allow-untyped-calls
"""Whether faces of a √3 refinement are wanted split, and up to which word of drift that holds.

`wants` and `wants_triangle` are compiled into their callers: an orbit's answers took a tenth longer else.
"""

import numpy as np

from foveal.base.jit import inlined, lean

from ._kernels_criteria import BALL, THIRD, is_wanted, longest_edge
from ._kernels_drift import EXPIRED, NEVER, both, until
from ._kernels_hidden import BASIS, is_hidden
from ._kernels_sqrt3_layout import PARENT, WANTED, corner_at, generation, is_half
from ._kernels_sqrt3_points import position, virtual_apex


@inlined
def wants(net, u, v, w, level, view, limits, ax, ay, az, bx, by, bz, cx, cy, cz):
    """(is wanted, near, far) of the face of generation `level` at these vertices and places."""
    if len(view) > BASIS:
        x, y, z = (ax + bx + cx) * THIRD, (ay + by + cy) * THIRD, (az + bz + cz) * THIRD
        if is_hidden(view, x, y, z, BALL * longest_edge(ax, ay, az, bx, by, bz, cx, cy, cz)):
            limits = limits[3:]
    return is_wanted(view, limits, level, ax, ay, az, bx, by, bz, cx, cy, cz, net.normals, u, v, w)


@inlined
def wants_triangle(net, u, v, w, level, view, limits):
    """The same where these vertices are on the level."""
    ax, ay, az = position(net, u, level)
    bx, by, bz = position(net, v, level)
    cx, cy, cz = position(net, w, level)
    return wants(net, u, v, w, level, view, limits, ax, ay, az, bx, by, bz, cx, cy, cz)


@lean
def has_wanted_parent(net, u, v, w, level):
    """Whether a face of generation `level` at these vertices has a parent that is wanted, or needs none."""
    if level == 0:
        return True
    return (
        (net.births[u] == level and (net.flags[u] & WANTED) != 0)
        or (net.births[v] == level and (net.flags[v] & WANTED) != 0)
        or (net.births[w] == level and (net.flags[w] & WANTED) != 0)
    )


@lean
def was_wanted_by_parent(net, v):
    """The same of the face in which vertex v was born, by its flags."""
    flags = net.flags[v]
    triple = net.vertices[v].triple
    return (
        net.births[v] == 1
        or ((flags & PARENT) != 0 and (net.flags[triple[0]] & WANTED) != 0)
        or ((flags & 2 * PARENT) != 0 and (net.flags[triple[1]] & WANTED) != 0)
        or ((flags & 4 * PARENT) != 0 and (net.flags[triple[2]] & WANTED) != 0)
    )


@lean
def examine(net, f, view, limits, drift):
    """(is wanted, up to which word) of a face. Without a wanted parent: until `wake` is told of one."""
    face = net.faces[f]
    level = generation(face.state)
    u, v, w = face.corners[0], face.corners[1], face.corners[2]
    if not has_wanted_parent(net, u, v, w, level):
        return False, NEVER
    meets, near, far = wants_triangle(net, u, v, w, level, view, limits)
    return meets, until(drift, near, far)


@lean
def wants_third(net, w, x, b, view, limits):
    """(is wanted, near, far) of the third, at edge w, x, of the birth face of b: whether that is to flip.

    That is what is seen as long as the face beyond is not split: the side of a front would stay as long as
    it was beside a back. Of what was seen of long edges nine in ten were such thirds.
    """
    level = net.births[b] - 1
    wx, wy, wz = position(net, w, level)
    xx, xy, xz = position(net, x, level)
    born = net.vertices[b].born
    # b may have no normal yet; w, the older, is asked in its place.
    return wants(net, w, x, w, level, view, limits, wx, wy, wz, xx, xy, xz, born[0], born[1], born[2])


@lean
def examine_half(net, h, view, limits, drift):
    """(is the face beyond to be split, up to which word) of a half.

    It is if the half itself is wanted, or one of the two faces that it is to be part of: for once these are
    there, from another view, their parent on this side is reason enough to keep and split them.
    """
    face = net.faces[h]
    level = generation(face.state) + 1
    w, x, b = np.int64(face.corners[0]), np.int64(face.corners[1]), np.int64(face.corners[2])
    if (net.flags[b] & WANTED) == 0:
        return False, NEVER
    meets, near, far = wants_third(net, w, x, b, view, limits)
    if meets:
        return True, EXPIRED
    dx, dy, dz = virtual_apex(net, h)
    wx, wy, wz = position(net, w, level)
    xx, xy, xz = position(net, x, level)
    bx, by, bz = position(net, b, level)
    meets, one_near, one_far = wants(net, w, x, b, level, view, limits, wx, wy, wz, dx, dy, dz, bx, by, bz)
    if meets:
        return True, EXPIRED
    meets, two_near, two_far = wants(net, x, b, w, level, view, limits, xx, xy, xz, bx, by, bz, dx, dy, dz)
    return meets, until(drift, min(near, min(one_near, two_near)), min(far, min(one_far, two_far)))


@lean
def is_seen_beyond(net, c, view, limits, drift):
    """Whether a third beside the birth face of c, that of a wanted vertex, has c kept."""
    first = np.int64(net.vertices[c].around)
    for is_back in (False, True):
        f = first
        while f >= 0:
            face = net.faces[f]
            k = corner_at(face, c)
            b, n = np.int64(face.corners[(k + 1) % 3]), np.int64(face.beside[k])
            # An edge between two vertices of one birth is what the flip of a longer one gave.
            is_flip = n >= 0 and net.births[b] == net.births[c]
            if is_flip and net.flags[b] & WANTED and is_third_wanted(net, f, n, b, view, limits, drift):
                return True
            f = np.int64(face.beside[k if is_back else (k + 2) % 3])
            if f == first:
                return False
    return False


@lean
def is_third_wanted(net, f, n, b, view, limits, drift):
    """Whether the third of b's birth face is wanted that went, in a flip, into the faces f and n.

    For how long it is not these two remember, should it come back.
    """
    meets, near, far = wants_third(net, oldest(net, f), oldest(net, n), b, view, limits)
    word = until(drift, near, far)
    net.faces[f].until, net.faces[n].until = both(net.faces[f].until, word), both(net.faces[n].until, word)
    return meets


@lean
def oldest(net, f):
    """The oldest corner of a face, or of that which half f is a third of."""
    face = net.faces[f]
    return np.int64(net.vertices[face.corners[2]].triple[0] if is_half(face.state) else face.corners[0])
