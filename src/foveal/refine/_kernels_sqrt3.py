# mypy: allow-untyped-defs, allow-untyped-calls
"""Local operators of √3 refinement: split a face, flip an edge, in a `net.Net`.

Based on: L. Kobbelt. √3-subdivision. SIGGRAPH 2000.
"""

import math

from foveal.base.jit import lean

from ._kernels_sqrt3_layout import BORDER, NONE, PARENT, UNMEASURED, generation, half, whole
from ._kernels_sqrt3_measure import measure_corners
from ._kernels_sqrt3_points import middle, near_point, position
from ._kernels_sqrt3_slots import put, relink, set_state, take_face, take_vertex


@lean
def flip(net, h, n):
    """Two halves of one old edge (w, x) become two faces of the next generation.

    Half h = (w, x, b) becomes (w, c, b), its mate n = (x, w, c) becomes (x, b, c).
    """
    one, two, vertices = net.faces[h], net.faces[n], net.vertices
    w, x, b, c = one.corners[0], one.corners[1], one.corners[2], two.corners[2]
    h1, h2, n1, n2 = one.beside[1], one.beside[2], two.beside[1], two.beside[2]
    state = one.state + 1
    put(net, h, w, c, b, n1, n, h2, state)
    put(net, n, x, b, c, h1, h, n2, state)
    relink(net, n1, c, h)
    relink(net, h1, b, n)
    vertices[w].around, vertices[x].around, vertices[b].around, vertices[c].around = h, n, h, h


@lean
def settle(net, h):
    """A new half becomes a face of the next generation, if nothing is beyond its old edge or a half is."""
    face = net.faces[h]
    n = face.beside[0]
    if n == NONE:
        set_state(net, h, face.state + 1)
    elif net.faces[n].state == face.state and net.faces[n].beside[0] == h:
        flip(net, h, n)


@lean
def parents(net, u, v, w, level):
    """Flags that say which corners of a face are of its own generation."""
    if level == 0:
        return 0
    return (
        (PARENT if net.births[u] == level else 0)
        | (2 * PARENT if net.births[v] == level else 0)
        | (4 * PARENT if net.births[w] == level else 0)
    )


@lean
def born(net, a, b, c, pair, level, kind):
    """A new vertex, of the face a, b, c of a level; its flags say but its parents."""
    v = take_vertex(net)
    vertex = net.vertices[v]
    vertex.triple[0], vertex.triple[1], vertex.triple[2], vertex.pair = a, b, c, pair
    vertex.kind = kind
    net.births[v] = level + 1
    net.flags[v] = parents(net, a, b, c, level)
    return v


@lean
def split(net, f):
    """Split a face of generation k; returns the new vertex, or the first of two on a border."""
    face = net.faces[f]
    level = generation(face.state)
    if level % 2 == 1 and face.beside[0] == NONE:
        return cut(net, f)
    u, v, w = face.corners[0], face.corners[1], face.corners[2]
    if level > 0:
        measure_corners(net, f)
    n0, n1, n2 = face.beside[0], face.beside[1], face.beside[2]
    b = born(net, u, v, w, NONE, level, UNMEASURED)
    vertex = net.vertices[b]
    vertex.born[0], vertex.born[1], vertex.born[2] = middle(net, f, level)
    vertex.limit[0] = math.nan  # unmeasured: whoever reads it would show
    g, h = take_face(net), take_face(net)
    put(net, f, u, v, b, n0, g, h, half(level))
    put(net, g, v, w, b, n1, h, f, half(level))
    put(net, h, w, u, b, n2, f, g, half(level))
    relink(net, n1, w, g)
    relink(net, n2, u, h)
    net.vertices[u].around, net.vertices[v].around, net.vertices[w].around, vertex.around = f, g, h, f
    settle(net, f)
    settle(net, g)
    settle(net, h)
    return b


@lean
def cut(net, f):
    """Split a face of odd generation, in three from its border edge; returns the first new vertex."""
    face = net.faces[f]
    level = generation(face.state)
    a, b, c = face.corners[0], face.corners[1], face.corners[2]
    measure_corners(net, f)
    n1, n2 = face.beside[1], face.beside[2]
    ax, ay, az = position(net, a, level + 1)
    bx, by, bz = position(net, b, level + 1)
    px, py, pz = near_point(net, a, b, level, True)
    qx, qy, qz = near_point(net, a, b, level, False)
    p = born(net, a, b, c, NONE, level, BORDER)
    q = born(net, a, b, c, p, level, BORDER)
    net.vertices[p].pair = q
    put_border_point(net, p, ax, ay, az, px, py, pz, qx, qy, qz)
    put_border_point(net, q, px, py, pz, qx, qy, qz, bx, by, bz)
    for axis in range(3):
        net.normals[p, axis] = net.normals[q, axis] = net.normals[c, axis]
    g, h = take_face(net), take_face(net)
    put(net, f, c, p, q, g, NONE, h, whole(level + 1))
    put(net, g, c, a, p, n2, NONE, f, half(level))
    put(net, h, b, c, q, n1, f, NONE, half(level))
    relink(net, n1, c, h)
    relink(net, n2, a, g)
    vertices = net.vertices
    vertices[a].around, vertices[b].around, vertices[c].around = g, h, f
    vertices[p].around, vertices[q].around = f, f
    settle(net, g)
    settle(net, h)
    return p


@lean
def put_border_point(net, v, px, py, pz, x, y, z, qx, qy, qz):
    """The three vectors of a border vertex between p and q."""
    vertex = net.vertices[v]
    vertex.born[0], vertex.born[1], vertex.born[2] = x, y, z
    vertex.limit[0], vertex.limit[1], vertex.limit[2] = qx - px, qy - py, qz - pz
    vertex.third[0] = px - 2.0 * x + qx
    vertex.third[1] = py - 2.0 * y + qy
    vertex.third[2] = pz - 2.0 * z + qz
