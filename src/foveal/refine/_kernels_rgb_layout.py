# mypy: allow-untyped-defs, allow-untyped-calls
"""The packed words of an RGB triangulation, by name, and its slots.

A face has a colour and a level l. Green: a triangle of uniform subdivision's level l. Red: half of one whose
edge is split, or what is left of it beside a green corner when two are; blue: the rest then. Edge 0 of a red
or blue face is red, and so is that of the face beyond it. A red face has a long green edge, of level l, and a
short one, of level l + 1; its two codes say which of them follows the red edge. A blue face has two green
edges of level l + 1.

Based on: E. Puppo. Selectively refinable subdivision meshes. SGP 2006, sections 4 and 7.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_drift import EXPIRED, NEVER

NONE = -1

#: Colours, and the code and birth of free slots.
GREEN, RED_LONG, RED_SHORT, BLUE = 0, 1, 2, 3
FREE_CODE, FREE = 255, -1

#: Flags of vertices: the edge it splits is split for itself; it meets the criteria; where it
#: was born is known; its limit is known; it is in the mesh; its normal and spread are known.
WANTED, MEETS, BORN, LIMIT, PRESENT, NORMAL = 1, 2, 4, 8, 16, 32

#: Places in `counts`: slots ever used, the first free ones, the queue, what there is, the clock of use, the
#: first vertex that may have to go, for `forget` where its hand is and when its last two rounds
#: began, and whether the queue is a stack.
FACES, VERTICES, FREE_FACE, FREE_VERTEX, FIRST, WAITING = 0, 1, 2, 3, 4, 5
FACES_IN_USE, PRESENT_COUNT, SPLITS, MERGES, CLOCK, SCHEME, IN_USE = 6, 7, 8, 9, 10, 11, 12
LAST, BASE_COUNT, DOUBTFUL, HAND, ROUND, SINCE = 13, 14, 15, 16, 17, 18
LAST_IN_FIRST = 19

#: Behind them: what is being computed for something else, and pairs of ends of edges being split for others.
STACK, CHAIN, WORDS = 20, 20 + 4096, 20 + 4096 + 512

LOOP, BUTTERFLY = 0, 1


@lean
def colour(code):
    """Of a face."""
    return code & 3


@lean
def level_of(code):
    """Of a face."""
    return np.int64(code >> 2)


@lean
def painted(colour, level):
    """The code of a face."""
    return np.uint8(colour | (level << 2))


@lean
def edge_level(code, k):
    """The level of a face's green edge k, or NONE of a red edge."""
    shade = code & 3
    if shade == GREEN:
        return np.int64(code >> 2)
    if k == 0:
        return np.int64(NONE)
    return np.int64(code >> 2) + (
        0 if k == shade else 1
    )  # the long edge is edge 1 or 2, as is its red's code


@lean
def corner_at(face, v):
    """Which corner of a face vertex v is."""
    return 0 if face.corners[0] == v else (1 if face.corners[1] == v else 2)


@lean
def take_face(net):
    """A free face slot."""
    counts = net.counts
    counts[FACES_IN_USE] += 1
    f = counts[FREE_FACE]
    if f != NONE:
        counts[FREE_FACE] = net.faces[f].beside[0]
        return f
    counts[FACES] += 1
    return counts[FACES] - 1


@lean
def give_face(net, f):
    """Free a face slot."""
    face = net.faces[f]
    face.code = FREE_CODE
    face.corners[0] = face.corners[1] = face.corners[2] = 0
    face.beside[0] = net.counts[FREE_FACE]
    net.counts[FREE_FACE] = f
    net.counts[FACES_IN_USE] -= 1


@lean
def enqueue(net, f):
    """Put a face into the queue, unless it waits there already.

    At its end the surface gets finer everywhere at once, which is for work that is shown half done. Else at
    its head: what was just made is still at hand, and 100,000 triangles take a fifth less time.
    """
    face, counts = net.faces[f], net.counts
    if not face.is_queued:
        face.is_queued = True
        if counts[WAITING] == 0:
            counts[FIRST] = f
        elif counts[LAST_IN_FIRST] != 0:
            face.next = counts[FIRST]
            counts[FIRST] = f
            counts[WAITING] += 1
            return
        else:
            net.faces[counts[LAST]].next = f
        counts[LAST] = f
        counts[WAITING] += 1


@lean
def dequeue(net):
    """The first face of the queue."""
    counts = net.counts
    f = counts[FIRST]
    counts[FIRST] = net.faces[f].next
    counts[WAITING] -= 1
    net.faces[f].is_queued = False
    return f


@lean
def put(net, f, a, b, c, x, y, z, code):
    """Write a face: corners, faces beyond, code. Its edges will be asked."""
    face = net.faces[f]
    face.corners[0], face.corners[1], face.corners[2] = a, b, c
    face.beside[0], face.beside[1], face.beside[2] = x, y, z
    face.code = code
    face.until[0] = face.until[1] = face.until[2] = EXPIRED
    net.vertices[a].around = net.vertices[b].around = net.vertices[c].around = f
    enqueue(net, f)


@lean
def know(net, f, k, one, j, other):
    """What was known of two edges before they came to be edges k and j of face f."""
    face = net.faces[f]
    face.until[k], face.until[j] = one, other


@lean
def relink(net, n, u, f):
    """Tell face n that f is beyond its edge that begins at u."""
    if n != NONE:
        net.faces[n].beside[corner_at(net.faces[n], u)] = f


@lean
def find_edge(net, a, b):
    """3 f + k for the edge from a to b, which is edge k of face f; NONE if there is none."""
    first = np.int64(net.vertices[a].around)
    f = first
    while f != NONE:
        face = net.faces[f]
        k = corner_at(face, a)
        if face.corners[(k + 1) % 3] == b:
            return 3 * f + k
        f = np.int64(face.beside[(k + 2) % 3])
        if f == first:
            return np.int64(NONE)
    f = first
    while f != NONE:  # a border: the other way
        face = net.faces[f]
        k = corner_at(face, a)
        if face.corners[(k + 1) % 3] == b:
            return 3 * f + k
        f = np.int64(face.beside[k])
    return np.int64(NONE)


@lean
def ask_around(net, v):
    """Have the edges of all faces at a vertex asked that were not, since that could not matter."""
    first = np.int64(net.vertices[v].around)
    f = first
    while f != NONE:
        ask_face(net, f)
        face = net.faces[f]
        f = np.int64(face.beside[(corner_at(face, v) + 2) % 3])
        if f == first:
            return
    f = first
    while f != NONE:
        ask_face(net, f)
        face = net.faces[f]
        f = np.int64(face.beside[corner_at(face, v)])


@lean
def ask_face(net, f):
    """The same of a face's."""
    until = net.faces[f].until
    for k in range(3):
        if until[k] == NEVER:
            until[k] = EXPIRED
            enqueue(net, f)
