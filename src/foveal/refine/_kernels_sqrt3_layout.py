# mypy: allow-untyped-defs, allow-untyped-calls
"""The packed words of a √3 refinement, by name.

A face is `faces[f]` (three vertices, counter-clockwise), `beside[f]` (the face beyond edge k, from corner
k to k + 1, or NONE) and `states[f]`. A face of generation k is a triangle of uniform subdivision's level
k. A half of generation k is a third of a split face whose old edge, its edge 0, could not be flipped yet,
since the face beyond is not split; its corner 2 is the new vertex.
"""

from foveal.base.jit import kernel

NONE = -1

#: States of faces: 2 generation, + 1 for halves; FREE for slots not in use.
FREE = -1

#: Kinds of vertices.
INSIDE, LATE, BORDER, UNMEASURED = 0, 1, 2, 3

#: Flags of vertices: its birth face is to be split for itself; for finer ones; it meets the criteria.
WANTED, NEEDED, MEETS = 1, 2, 4


@kernel
def generation(state):
    """Of a face or a half."""
    return state >> 1


@kernel
def is_half(state):
    """Whether it is a half, if it is anything."""
    return (state & 1) == 1


@kernel
def whole(level):
    """The state of a face of a generation."""
    return 2 * level


@kernel
def half(level):
    """The state of a half of a generation."""
    return 2 * level + 1


FACES, VERTICES, FREE_FACES, FREE_VERTICES = 0, 1, 2, 3
