# mypy: allow-untyped-defs, allow-untyped-calls
"""Local operators of RGB triangulations: split an edge, swap and exchange a diagonal.

An edge split is the bisection of the triangle on each side, whatever their colours: GG, RG, RR1 and RR2 are
the ways in which two bisections meet, and on a border there is one. A blue pair swaps its diagonal as soon as
it exists. Where two edges of a green triangle are split, its diagonal ends at the lower of two addresses, so
that it does not depend on which was split first.

Based on: E. Puppo. Selectively refinable subdivision meshes. SGP 2006, section 4.1.
"""

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_layout import (
    BLUE,
    GREEN,
    NONE,
    RED_LONG,
    RED_SHORT,
    colour,
    corner_at,
    know,
    level_of,
    painted,
    put,
    relink,
    take_face,
)


@lean
def opposite(net, f, k):
    """The apex over edge k of face f: of the green triangle of that edge's level, split elsewhere or not."""
    face = net.faces[f]
    if colour(face.code) == GREEN:
        return np.int64(face.corners[(k + 2) % 3])
    middle = net.vertices[face.corners[(k + 2) % 3]]  # of the triangle's other edge, at the red's corner 2
    return np.int64(middle.diamond[0]) + middle.diamond[1] - face.corners[2]


@lean
def bisect(net, f, k, v):
    """Split face f at vertex v of its edge k; f is at the edge's first half or its second then.

    Returns the faces at the first and the second half. What is beyond the halves is left to be linked.
    """
    face = net.faces[f]
    a, b, c = face.corners[k], face.corners[(k + 1) % 3], face.corners[(k + 2) % 3]
    bc, ca = face.beside[(k + 1) % 3], face.beside[(k + 2) % 3]
    of_bc, of_ca = face.until[(k + 1) % 3], face.until[(k + 2) % 3]
    shade, level = colour(face.code), level_of(face.code)
    g = take_face(net)
    net.faces[g].base = face.base
    if shade == GREEN:
        put(net, f, v, c, a, g, ca, NONE, painted(RED_LONG, level))
        put(net, g, c, v, b, f, NONE, bc, painted(RED_SHORT, level))
        net.faces[f].until[1], net.faces[g].until[2] = of_ca, of_bc
        relink(net, bc, c, g)
        return f, g
    if shade == RED_SHORT:  # the edge's first end has the green corner
        put(net, f, b, c, v, bc, g, NONE, painted(BLUE, level))
        put(net, g, c, a, v, ca, NONE, f, painted(GREEN, level + 1))
        net.faces[g].until[0] = of_ca
        relink(net, ca, a, g)
        return g, f
    put(net, f, c, a, v, ca, NONE, g, painted(BLUE, level))
    put(net, g, b, c, v, bc, f, NONE, painted(GREEN, level + 1))
    net.faces[g].until[0] = of_bc
    relink(net, bc, c, g)
    return f, g


@lean
def link(net, f, u, g, w):
    """Face f's edge that begins at u and g's that begins at w are one."""
    net.faces[f].beside[corner_at(net.faces[f], u)] = g
    net.faces[g].beside[corner_at(net.faces[g], w)] = f


@lean
def swap(net, f, n):
    """BB-swap: two blue faces of level l become two green ones of level l + 1."""
    one, two = net.faces[f], net.faces[n]
    a, b, c, d = one.corners[0], one.corners[1], one.corners[2], two.corners[2]
    bc, ca, ad, db = one.beside[1], one.beside[2], two.beside[1], two.beside[2]
    of_bc, of_ca, of_ad, of_db = one.until[1], one.until[2], two.until[1], two.until[2]
    code = painted(GREEN, level_of(one.code) + 1)
    put(net, f, b, c, d, bc, n, db, code)
    put(net, n, c, a, d, ca, ad, f, code)
    know(net, f, 0, of_bc, 2, of_db)
    know(net, n, 0, of_ca, 1, of_ad)
    relink(net, db, b, f)
    relink(net, ca, a, n)


@lean
def exchange(net, f, n):
    """The other diagonal for blue face f and red face n; f is blue and n red again."""
    one, two = net.faces[f], net.faces[n]
    a, b, c, d = one.corners[0], one.corners[1], one.corners[2], two.corners[2]
    bc, ca, ad, db = one.beside[1], one.beside[2], two.beside[1], two.beside[2]
    of_bc, of_ca, of_ad, of_db = one.until[1], one.until[2], two.until[1], two.until[2]
    level = level_of(one.code)
    if colour(two.code) == RED_LONG:  # its long edge goes from a to d
        put(net, n, d, c, a, f, ca, ad, painted(RED_SHORT, level))
        put(net, f, c, d, b, n, db, bc, one.code)
        know(net, n, 1, of_ca, 2, of_ad)
        know(net, f, 1, of_db, 2, of_bc)
        relink(net, ca, a, n)
        relink(net, db, b, f)
    else:  # from d to b
        put(net, n, c, d, b, f, db, bc, painted(RED_LONG, level))
        put(net, f, d, c, a, n, ca, ad, one.code)
        know(net, n, 1, of_db, 2, of_bc)
        know(net, f, 1, of_ca, 2, of_ad)
        relink(net, bc, c, n)
        relink(net, ad, d, f)


@lean
def settle(net, f):
    """What is automatic once face f is blue: the swap with another blue one, or the canonical diagonal."""
    face = net.faces[f]
    if colour(face.code) != BLUE:
        return
    n = np.int64(face.beside[0])
    other = net.faces[n]
    if colour(other.code) == BLUE:
        swap(net, f, n)
        return
    ends_at = face.corners[0] if colour(other.code) == RED_LONG else face.corners[1]
    if net.vertices[other.corners[2]].key < net.vertices[ends_at].key:
        exchange(net, f, n)


@lean
def split_topology(net, f, k, v):
    """Split edge k of face f at vertex v: both faces of the edge are green of its level, or red along it."""
    a, b = np.int64(net.faces[f].corners[k]), np.int64(net.faces[f].corners[(k + 1) % 3])
    n = np.int64(net.faces[f].beside[k])
    first, second = bisect(net, f, k, v)
    net.vertices[v].around = first
    if n != NONE:
        back, front = bisect(net, n, corner_at(net.faces[n], b), v)
        link(net, first, a, front, v)
        link(net, second, v, back, b)
    # The new blue face, if any, keeps its slot while the other side settles.
    settle(net, first if colour(net.faces[first].code) == BLUE else second)
    if n != NONE:
        settle(net, back if colour(net.faces[back].code) == BLUE else front)
