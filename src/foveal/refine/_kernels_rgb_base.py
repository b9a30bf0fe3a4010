# mypy: allow-untyped-defs, allow-untyped-calls
"""The control mesh of an RGB triangulation."""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_address import BASE_KEY, enter
from ._kernels_rgb_layout import (
    BASE_COUNT,
    BORN,
    BUTTERFLY,
    FREE,
    LIMIT,
    PRESENT,
    SCHEME,
    VERTICES,
)
from ._kernels_rgb_points import away, cross, unit
from ._kernels_turn import turn


@lean
def base_vertices(net, positions, starts, ring, is_border):
    """Positions, limits, shrinks and limit normals of the control mesh's vertices."""
    is_loop = net.counts[SCHEME] != BUTTERFLY
    for v in range(len(positions)):
        vertex = net.vertices[v]
        begin, end = starts[v], starts[v + 1]
        n = end - begin
        net.vertices[v].birth, net.vertices[v].flags = 0, BORN | LIMIT | PRESENT
        vertex.key = v + BASE_KEY
        vertex.shrink = 0.25
        turn_cos = turn(1, n)[0] if n > 1 else 1.0
        share = 0.375 + 0.25 * turn_cos
        if n > 0 and not is_border[v]:
            vertex.shrink = share * share
        alpha = 0.625 - vertex.shrink
        for axis in range(3):
            p = positions[v, axis]
            vertex.born[axis] = vertex.limit[axis] = p
            if n == 0 or not is_loop:
                continue
            if is_border[v]:
                vertex.limit[axis] = (
                    4.0 * p + (positions[ring[begin], axis] + positions[ring[end - 1], axis])
                ) / 6.0
                continue
            total = 0.0
            for i in range(begin, end):
                total += positions[ring[i], axis]
            vertex.limit[axis] = (3.0 * p + 8.0 * alpha * total / n) / (3.0 + 8.0 * alpha)


@lean
def base_normals(net):
    """The mean of each vertex's triangles' normals, by area, and how far those are from it."""
    for f in range(len(net.base)):
        x, y, z = area(net, f)
        for k in range(3):
            normal = net.vertices[net.base[f].corners[k]].normal
            normal[0] += x
            normal[1] += y
            normal[2] += z
    for v in range(net.counts[BASE_COUNT]):
        vertex = net.vertices[v]
        x, y, z = unit(vertex.normal[0], vertex.normal[1], vertex.normal[2])
        vertex.normal[0], vertex.normal[1], vertex.normal[2] = x, y, z
    for f in range(len(net.base)):
        x, y, z = area(net, f)
        x, y, z = unit(x, y, z)
        for k in range(3):
            vertex = net.vertices[net.base[f].corners[k]]
            n = vertex.normal
            vertex.spread = max(vertex.spread, math.sqrt(away(x, y, z, n[0], n[1], n[2])))


@lean
def area(net, f):
    """Twice the area vector of a triangle of the control mesh."""
    a, b, c = (
        net.vertices[net.base[f].corners[0]].born,
        net.vertices[net.base[f].corners[1]].born,
        net.vertices[net.base[f].corners[2]].born,
    )
    return cross(b[0] - a[0], b[1] - a[1], b[2] - a[2], c[0] - a[0], c[1] - a[1], c[2] - a[2])


@lean
def fill_table(net):
    """Enter all vertices but the control mesh's into an empty table."""
    for v in range(net.counts[BASE_COUNT], net.counts[VERTICES]):
        if net.vertices[v].birth != FREE:
            enter(net, net.vertices[v].key, np.int64(v))
