# mypy: allow-untyped-defs, allow-untyped-calls
"""What is shown of a √3 refinement."""

import numpy as np

from foveal.base.jit import lean

from ._kernels_sqrt3_layout import BORDER, FREE, NONE, UNMEASURED, generation
from ._kernels_sqrt3_measure import measure
from ._kernels_sqrt3_points import position


@lean
def show_faces(net, corners, levels, highest):
    """corners, levels: of each face slot, zeros where it is free; highest[v]: of the levels at vertex v."""
    for v in range(len(highest)):
        highest[v] = net.births[v]
    for f in range(len(corners)):
        face = net.faces[f]
        is_used = face.state != FREE
        level = generation(face.state) if is_used else 0
        levels[f] = level
        for k in range(3):
            v = face.corners[k] if is_used else 0
            corners[f, k] = v
            if is_used:
                highest[v] = max(highest[v], level)


@lean
def show_vertices(net, is_limit, highest, positions, starts):
    """positions: on the highest level of the faces there, or in the limit; starts: on the level of birth.

    At a seam of the faces on both sides, which may have come to different levels.
    """
    for v in range(len(positions)):
        vertex = net.vertices[v]
        x, y, z = vertex.born[0], vertex.born[1], vertex.born[2]
        starts[v, 0], starts[v, 1], starts[v, 2] = x, y, z
        if net.births[v] != FREE:
            if is_limit:
                x, y, z = limit(net, np.int64(v))
            else:
                twin = vertex.twin
                x, y, z = position(net, v, highest[v] if twin == NONE else max(highest[v], highest[twin]))
        positions[v, 0], positions[v, 1], positions[v, 2] = x, y, z


@lean
def limit(net, v):
    """Where vertex v goes. It is measured if need be: then none of its faces is finer than itself."""
    vertex = net.vertices[v]
    if vertex.kind == UNMEASURED:
        measure(net, v)
    if vertex.kind == BORDER:
        return (
            vertex.born[0] + vertex.third[0] / 6.0,
            vertex.born[1] + vertex.third[1] / 6.0,
            vertex.born[2] + vertex.third[2] / 6.0,
        )
    return vertex.limit[0], vertex.limit[1], vertex.limit[2]
