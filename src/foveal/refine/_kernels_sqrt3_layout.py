# mypy: allow-untyped-defs, allow-untyped-calls
"""The packed words of a √3 refinement, by name.

A face has three corners, counter-clockwise, and a state. A face of generation k is a triangle of uniform
subdivision's level k. A half of generation k is a third of a split face whose old edge, its edge 0, could not
be flipped yet, since the face beyond is not split; its corner 2 is the new vertex.

A seam is a sharp edge, along which the mesh is cut open: each side has vertices of its own, and the rules of
a border. `beside` is negative at both: NONE at a border, at a seam which edge of which face is beyond.
"""

from foveal.base.jit import lean

NONE = -1

#: States of faces: 2 generation, + 1 for halves; FREE for slots not in use.
FREE = -1

#: Kinds of vertices.
INSIDE, LATE, BORDER, UNMEASURED, CORNER = 0, 1, 2, 3, 4

#: Flags of vertices: its birth face is to be split for itself; it meets the criteria; and which corners of
#: the birth face are its parents, 8 << k: those born with it.
WANTED, MEETS, PARENTS, PARENT = 1, 2, 56, 8

#: Slots ever used, how many of them are free, the first free ones; the queue's first place and length; the
#: first vertex that may have to go.
FACES, VERTICES, FREE_FACES, FREE_VERTICES, FREE_FACE, FREE_VERTEX, FIRST, QUEUED = 0, 1, 2, 3, 4, 5, 6, 7
DOUBTFUL = 8

#: Behind them: vertices to be considered anew. Of a generation there are at most twelve.
STACK, WORDS = 9, 9 + 512


@lean
def seam(f, k):
    """What is beside a face at a seam beyond which is edge k of face f."""
    return -2 - (3 * f + k)


@lean
def seam_face(word):
    """The face beyond a seam."""
    return (-2 - word) // 3


@lean
def seam_edge(word):
    """Which of its edges is the seam."""
    return (-2 - word) % 3


@lean
def generation(state):
    """Of a face or a half."""
    return state >> 1


@lean
def is_half(state):
    """Whether it is a half, if it is anything."""
    return (state & 1) == 1


@lean
def whole(level):
    """The state of a face of a generation."""
    return 2 * level


@lean
def half(level):
    """The state of a half of a generation."""
    return 2 * level + 1


@lean
def corner_at(face, v):
    """Which corner of a face vertex v is."""
    return 0 if face.corners[0] == v else (1 if face.corners[1] == v else 2)
