# mypy: allow-untyped-defs, allow-untyped-calls
"""The inverses of RGB splits: take a vertex out, one green triangle of its level's parent on each side.

The faces at a vertex between its two edge halves, on one side, are (R, R), (G, B) or (B, G); R4-, R2GB-,
GBGB- and G2B2-merge are the ways in which two sides meet. (G, B, R) and (R, B, G) become one of those when
the diagonal is exchanged, (G, G, G) by a GG-swap that is merged at once.

Based on: E. Puppo. Selectively refinable subdivision meshes. SGP 2006, section 4.3.
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
    find_edge,
    give_face,
    know,
    level_of,
    painted,
    put,
    relink,
)
from ._kernels_rgb_split import exchange, link


@lean
def next_around(net, f, v):
    """The face after f around v, counter-clockwise."""
    face = net.faces[f]
    return np.int64(face.beside[(corner_at(face, v) + 2) % 3])


@lean
def last_corner(net, f, v):
    """The corner of f before v."""
    face = net.faces[f]
    return np.int64(face.corners[(corner_at(face, v) + 2) % 3])


@lean
def is_mergeable_side(net, v, b, a):
    """Whether the faces at v from b to a are children of one triangle with its edge (a, b) split at v."""
    level = np.int64(net.vertices[v].birth) - 1
    h = find_edge(net, v, b)
    if h == NONE:
        return False
    f = h // 3
    for _ in range(3):
        code = net.faces[f].code
        if level_of(code) != (level + 1 if colour(code) == GREEN else level):
            return False
        if last_corner(net, f, v) == a:
            return True
        f = next_around(net, f, v)
        if f == NONE:
            return False
    return False


@lean
def is_mergeable(net, v):
    """Whether vertex v, born after level 0, can be taken out: nothing finer depends on it."""
    diamond = net.vertices[v].diamond
    a, b = np.int64(diamond[0]), np.int64(diamond[1])
    return is_mergeable_side(net, v, b, a) and (diamond[3] == NONE or is_mergeable_side(net, v, a, b))


@lean
def ready_side(net, v, a, b):
    """The face at v and b, on the side where the faces from b to a are two now, or three green ones."""
    f = find_edge(net, v, b) // 3
    g = next_around(net, f, v)
    if last_corner(net, g, v) == a:
        return f
    h = next_around(net, g, v)
    if colour(net.faces[f].code) != GREEN:  # R, B, G
        exchange(net, g, f)
        return g
    if colour(net.faces[h].code) != GREEN:  # G, B, R
        exchange(net, g, h)
    return f


@lean
def merge_side(net, v, a, b, f):
    """Make one face of those at v from b, in face f, to a; returns it, its edge (a, b) to be linked."""
    g = next_around(net, f, v)
    if last_corner(net, g, v) != a:
        return merge_three(net, v, a, b, f, g, next_around(net, g, v))
    one, two = net.faces[f], net.faces[g]
    i, j = corner_at(one, v), corner_at(two, v)
    c = one.corners[(i + 2) % 3]
    bc, ca = one.beside[(i + 1) % 3], two.beside[(j + 1) % 3]
    of_bc, of_ca = one.until[(i + 1) % 3], two.until[(j + 1) % 3]
    level = level_of(two.code if colour(one.code) == GREEN else one.code)
    if colour(one.code) == GREEN:  # G, B: the short edge follows b
        put(net, f, c, a, b, ca, NONE, bc, painted(RED_LONG, level))
        net.faces[f].until[2] = of_bc
    elif colour(one.code) == BLUE:  # B, G
        put(net, f, b, c, a, bc, ca, NONE, painted(RED_SHORT, level))
        net.faces[f].until[1] = of_ca
    else:
        put(net, f, a, b, c, NONE, bc, ca, painted(GREEN, level))
        know(net, f, 1, of_bc, 2, of_ca)
    relink(net, ca, a, f)
    give_face(net, g)
    return f


@lean
def merge_three(net, v, a, b, f, g, h):
    """The same of three green faces: the triangle's other two edges stay split, its diagonal is canonical."""
    one, two, three = net.faces[f], net.faces[g], net.faces[h]
    i, j, k = corner_at(one, v), corner_at(two, v), corner_at(three, v)
    x, y = one.corners[(i + 2) % 3], two.corners[(j + 2) % 3]
    bx, xy, ya = one.beside[(i + 1) % 3], two.beside[(j + 1) % 3], three.beside[(k + 1) % 3]
    of_bx, of_xy, of_ya = one.until[(i + 1) % 3], two.until[(j + 1) % 3], three.until[(k + 1) % 3]
    level = level_of(one.code) - 1
    if net.vertices[a].key < net.vertices[b].key:
        put(net, f, x, a, b, g, NONE, bx, painted(RED_LONG, level))
        put(net, g, a, x, y, f, xy, ya, painted(BLUE, level))
        net.faces[f].until[2] = of_bx
        know(net, g, 1, of_xy, 2, of_ya)
        relink(net, ya, a, g)
    else:
        put(net, f, b, y, a, g, ya, NONE, painted(RED_SHORT, level))
        put(net, g, y, b, x, f, bx, xy, painted(BLUE, level))
        net.faces[f].until[1] = of_ya
        know(net, g, 1, of_bx, 2, of_xy)
        relink(net, bx, x, g)
        relink(net, ya, a, f)
    give_face(net, h)
    return f


@lean
def merge_topology(net, v, known):
    """Take vertex v, which is mergeable, out of the mesh; up to which word its edge need not be asked."""
    diamond = net.vertices[v].diamond
    a, b = np.int64(diamond[0]), np.int64(diamond[1])
    f = ready_side(net, v, a, b)
    if diamond[3] == NONE:
        f = merge_side(net, v, a, b, f)
    else:
        n = ready_side(net, v, b, a)
        n, f = merge_side(net, v, b, a, n), merge_side(net, v, a, b, f)
        link(net, f, a, n, b)
        net.faces[n].until[corner_at(net.faces[n], b)] = known
    net.faces[f].until[corner_at(net.faces[f], a)] = known
