# mypy: allow-untyped-defs, allow-untyped-calls
"""Whether faces of a √3 refinement are wanted split, and up to which drift of the view that holds."""

import math

from foveal.base.jit import lean

from ._kernels_criteria import BALL, THIRD, is_wanted, longest_edge
from ._kernels_hidden import BASIS, is_hidden
from ._kernels_sqrt3_layout import PARENT, WANTED, generation
from ._kernels_sqrt3_points import position, virtual_apex

#: What rounding a drift to 32 bits may have added is taken away before.
ROUNDED = 1.0 - 2.0**-22


@lean
def wants(net, u, v, w, level, view, limits, ax, ay, az, bx, by, bz, cx, cy, cz):
    """(is wanted, slack) of the face of generation `level` at these vertices and places."""
    if len(view) > BASIS:
        x, y, z = (ax + bx + cx) * THIRD, (ay + by + cy) * THIRD, (az + bz + cz) * THIRD
        if is_hidden(view, x, y, z, BALL * longest_edge(ax, ay, az, bx, by, bz, cx, cy, cz)):
            limits = limits[3:]
    return is_wanted(view, limits, level, ax, ay, az, bx, by, bz, cx, cy, cz, net.normals, u, v, w)


@lean
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
    """(is wanted, until which drift) of a face. Without a wanted parent: until `wake` is told of one."""
    face = net.faces[f]
    level = generation(face.state)
    u, v, w = face.corners[0], face.corners[1], face.corners[2]
    if not has_wanted_parent(net, u, v, w, level):
        return False, math.inf
    meets, slack = wants_triangle(net, u, v, w, level, view, limits)
    return meets, (drift + slack) * ROUNDED


@lean
def examine_beyond(net, h, view, limits, drift):
    """The same of the two faces that half h is to be part of: whether one of them is wanted."""
    face = net.faces[h]
    level = generation(face.state) + 1
    w, x, b = face.corners[0], face.corners[1], face.corners[2]
    if (net.flags[b] & WANTED) == 0:
        return False, math.inf
    dx, dy, dz = virtual_apex(net, h)
    wx, wy, wz = position(net, w, level)
    xx, xy, xz = position(net, x, level)
    bx, by, bz = position(net, b, level)
    meets, slack = wants(net, w, x, b, level, view, limits, wx, wy, wz, dx, dy, dz, bx, by, bz)
    if meets:
        return True, 0.0
    meets, other = wants(net, x, b, w, level, view, limits, xx, xy, xz, bx, by, bz, dx, dy, dz)
    return meets, (drift + min(slack, other)) * ROUNDED
