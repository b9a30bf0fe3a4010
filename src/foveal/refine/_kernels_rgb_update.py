# mypy: allow-untyped-defs, allow-untyped-calls
"""Which edges of an RGB triangulation are split for a view, and bringing the mesh there from wherever it is.

An edge is wanted split if it meets the criteria and a split that makes it is wanted. It is needed split if
it is wanted, or if a needed one's triangles take it: then an end or apex of that one was born on its level,
and this is the edge which that vertex splits. Both read positions of uniform subdivision only, so the mesh
depends on the view and not on the way to it.

An edge inside a triangle is asked before it is there, too: a red face asks the one from its apex to the
middle of its long edge, a blue face the one to the same middle. Their red edge's place keeps the answer.

Answers are kept with their slack: `drift` is how far the eye and the frustum moved in all since the
beginning, and `until` says up to which drift an answer holds.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_rgb_address import middle_key, slot_of
from ._kernels_rgb_criteria import finest, has_wanted_maker, wants_edge
from ._kernels_rgb_known import ASK_BORN
from ._kernels_rgb_layout import (
    BASE_COUNT,
    BLUE,
    BORN,
    CHAIN,
    DOUBTFUL,
    FACES,
    FACES_IN_USE,
    FREE_CODE,
    GREEN,
    MEETS,
    MERGES,
    NONE,
    NORMAL,
    PRESENT,
    PRESENT_COUNT,
    SPLITS,
    VERTICES,
    WAITING,
    WANTED,
    ask_around,
    colour,
    corner_at,
    dequeue,
    edge_level,
    enqueue,
    find_edge,
)
from ._kernels_rgb_merge import merge_topology
from ._kernels_rgb_points import ensure, set_normal
from ._kernels_rgb_split import opposite, split_topology

#: Slots that examining a face may use: forced splits and stencils go down through the levels.
ROOM = 1024


@lean
def split_edge(net, f, k):
    """Split edge k of face f, both of whose faces allow it; returns the new vertex."""
    face = net.faces[f]
    a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
    n = np.int64(face.beside[k])
    c = opposite(net, f, k)
    d = np.int64(NONE) if n == NONE else opposite(net, n, corner_at(net.faces[n], b))
    v = slot_of(net, middle_key(net, np.int64(face.base), a, b))
    vertex = net.vertices[v]
    vertex.diamond[0], vertex.diamond[1], vertex.diamond[2], vertex.diamond[3] = a, b, c, d
    net.flags[v] |= PRESENT
    if net.flags[v] & BORN == 0:
        ensure(net, v, ASK_BORN)
    if net.flags[v] & NORMAL == 0:
        set_normal(net, v)
    vertex.until = 0.0
    split_topology(net, f, k, v)
    need(net, v, 1)
    net.counts[SPLITS] += 1
    net.counts[PRESENT_COUNT] += 1
    return v


@lean
def need(net, v, change):
    """Count for the splits that v's triangles take that v takes them, or no longer."""
    diamond, level = net.vertices[v].diamond, net.births[v] - 1
    if level == 0:
        return
    for k in range(4):
        u = np.int64(diamond[k])
        if u != NONE and net.births[u] == level:
            net.vertices[u].needed += change
            if net.vertices[u].needed == 0:
                doubt(net, u)


@lean
def doubt(net, v):
    """Have it seen to whether v is to be in the mesh."""
    vertex = net.vertices[v]
    if not vertex.is_doubtful:
        vertex.is_doubtful = True
        vertex.next = net.counts[DOUBTFUL]
        net.counts[DOUBTFUL] = v


@lean
def merge_vertex(net, v):
    """Take a mergeable vertex out of the mesh; what is known of it is kept."""
    merge_topology(net, v)
    need(net, v, -1)
    net.flags[v] &= ~(PRESENT | WANTED | MEETS)
    net.vertices[v].around = NONE
    net.counts[MERGES] += 1
    net.counts[PRESENT_COUNT] -= 1


@lean
def obstacle(net, f, k):
    """3 g + h for the edge that is to be split before edge k of face f can be, or NONE."""
    face = net.faces[f]
    shade = colour(face.code)
    if shade == GREEN:
        return np.int64(NONE)
    if shade == BLUE:
        g = np.int64(face.beside[0])
        return 3 * g + colour(net.faces[g].code)
    return np.int64(NONE) if shade == k else 3 * f + shade


@lean
def force(net, f, k, until, view, limits, drift):
    """Split edge k of face f, and before it whatever has to be; False if there are too few slots left.

    That edge itself is known to be wanted up to a drift of `until`, or not known to be if that is 0.
    """
    chain = net.counts
    chain[CHAIN], chain[CHAIN + 1] = net.faces[f].corners[k], net.faces[f].corners[(k + 1) % 3]
    depth = 1
    while depth > 0:
        if not has_room(net):
            return False
        h = find_edge(net, chain[CHAIN + 2 * depth - 2], chain[CHAIN + 2 * depth - 1])
        if h == NONE:
            depth -= 1
            continue
        g, i = h // 3, h % 3
        o = obstacle(net, g, i)
        n = np.int64(net.faces[g].beside[i])
        if o == NONE and n != NONE:
            o = obstacle(net, n, corner_at(net.faces[n], net.faces[g].corners[(i + 1) % 3]))
        if o != NONE:
            face, j = net.faces[o // 3], o % 3
            chain[CHAIN + 2 * depth] = face.corners[j]
            chain[CHAIN + 2 * depth + 1] = face.corners[(j + 1) % 3]
            depth += 1
            continue
        v = split_edge(net, g, i)
        depth -= 1
        if depth == 0 and until > 0.0:
            net.flags[v] |= WANTED | MEETS
            net.vertices[v].until = until
            continue
        if net.vertices[v].until <= drift:
            answer(net, v, view, limits, drift)
        judge(net, v)
        if net.flags[v] & WANTED == 0:
            doubt(net, v)
    return True


@lean
def judge(net, v):
    """Set whether a vertex is wanted, by its edge's makers and by what is known of the criteria."""
    vertex = net.vertices[v]
    a, b = np.int64(vertex.diamond[0]), np.int64(vertex.diamond[1])
    if net.flags[v] & MEETS and has_wanted_maker(net, a, b, np.int64(net.births[v]) - 1):
        net.flags[v] |= WANTED
    else:
        net.flags[v] &= ~WANTED


@lean
def has_room(net):
    """Whether slots will do for what one step may take."""
    return net.counts[FACES] + ROOM <= len(net.faces) and net.counts[VERTICES] + ROOM <= len(net.vertices)


@lean
def review(net, begin, view, limits, drift):
    """Ask anew where answers no longer hold, from a slot on, and see what follows of what is wanted.

    Returns where it stopped for want of slots, or the end.
    """
    for i in range(max(begin, net.counts[BASE_COUNT]), net.counts[VERTICES]):
        v = np.int64(i)
        if net.flags[v] & PRESENT == 0 or net.vertices[v].until > drift:
            continue
        if not has_room(net):
            return i
        if answer(net, v, view, limits, drift):
            reconsider(net, v)
    return net.counts[VERTICES]


@lean
def answer(net, v, view, limits, drift):
    """Ask whether the edge that v splits meets the criteria; whether that is news."""
    vertex = net.vertices[v]
    a, b, met = np.int64(vertex.diamond[0]), np.int64(vertex.diamond[1]), net.flags[v] & MEETS
    meets, slack = wants_edge(net, a, b, np.int64(net.births[v]) - 1, view, limits)
    net.flags[v] = (net.flags[v] | MEETS) if meets else (net.flags[v] & ~MEETS)
    vertex.until = drift + slack
    return (net.flags[v] & MEETS) != met


@lean
def reconsider(net, v):
    """Set anew whether v is wanted, and what it makes if that is news.

    Of what becomes wanted the edges are to be asked; what no longer is may go.
    """
    chain = net.counts
    chain[CHAIN], top = v, 1
    while top > 0:
        top -= 1
        w = chain[CHAIN + top]
        was_wanted = net.flags[w] & WANTED
        judge(net, w)
        if net.flags[w] & WANTED == was_wanted:
            continue
        if was_wanted:
            doubt(net, w)
        else:
            ask_around(net, w)
        top = push_made(net, top, w)


@lean
def push_made(net, top, v):
    """Put the vertices that split the edges which v makes onto the chain: all of those end at v."""
    first = np.int64(net.vertices[v].around)
    f = first
    while f != NONE:
        face = net.faces[f]
        k = corner_at(face, v)
        top = push_made_to(net, top, v, np.int64(face.corners[(k + 1) % 3]))
        last = np.int64(face.corners[(k + 2) % 3])
        f = np.int64(face.beside[(k + 2) % 3])
        if f == first:
            return top
        if f == NONE:
            top = push_made_to(net, top, v, last)
    f = np.int64(net.faces[first].beside[corner_at(net.faces[first], v)])
    while f != NONE:  # a border: the other way
        face = net.faces[f]
        k = corner_at(face, v)
        top = push_made_to(net, top, v, np.int64(face.corners[(k + 1) % 3]))
        f = np.int64(face.beside[k])
    return top


@lean
def push_made_to(net, top, v, w):
    """The same of the one edge that goes from v towards its neighbour w, which may split a piece of it."""
    level = net.births[v] + 1
    while net.births[w] >= level:
        a, b = np.int64(net.vertices[w].diamond[0]), np.int64(net.vertices[w].diamond[1])
        if v != a and v != b:
            return top
        if net.births[w] == level:
            net.counts[CHAIN + top] = w
            return top + 1
        w = b if v == a else a
    return top


@lean
def coarsen(net):
    """Take out what is neither wanted nor needed, and what was needed by that alone."""
    while net.counts[DOUBTFUL] != NONE:
        v = net.counts[DOUBTFUL]
        vertex = net.vertices[v]
        net.counts[DOUBTFUL] = vertex.next
        vertex.is_doubtful = False
        if net.flags[v] & (PRESENT | WANTED) == PRESENT and vertex.needed == 0:
            merge_vertex(net, v)


@lean
def enqueue_expired(net, drift):
    """Put the faces into the queue of which an edge's answer no longer holds."""
    for f in range(net.counts[FACES]):
        face = net.faces[f]
        if min(face.until[0], min(face.until[1], face.until[2])) <= drift and face.code != FREE_CODE:
            enqueue(net, f)


@lean
def is_asked_at(face, k):
    """Whether it is this face that asks its green edge k: each edge is asked from one side only."""
    return face.beside[k] == NONE or face.corners[k] < face.corners[(k + 1) % 3]


#: How `refine` ended.
DONE, NO_ROOM, ENOUGH = 0, 1, 2


@lean
def ask_edge(net, f, k, level, view, limits, drift):
    """Split the green edge k of a face if it is wanted: ENOUGH then, NO_ROOM for want of slots, else DONE."""
    face = net.faces[f]
    a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
    if not has_wanted_maker(net, a, b, level):
        return DONE
    meets, slack = wants_edge(net, a, b, level, view, limits)
    face.until[k] = drift + slack
    if not meets:
        return DONE
    return ENOUGH if force(net, f, k, drift + slack, view, limits, drift) else NO_ROOM


@lean
def ask_inner(net, f, view, limits, drift):
    """The same of the edge inside a red or blue face's triangle that is not there yet.

    Only what makes it is split: then it is there, and asked.
    """
    g, j, v = across(net, f)
    level = np.int64(net.births[v])
    if level >= finest(limits) or net.flags[v] & WANTED == 0:
        return DONE
    u = middle_of(net, g, j)
    meets, slack = wants_edge(net, v, u, level, view, limits)
    net.faces[f].until[0] = drift + slack
    if not meets:
        return DONE
    return ENOUGH if force(net, g, j, 0.0, view, limits, drift) else NO_ROOM


@lean
def across(net, f):
    """(face, edge, vertex): the long edge of a red or blue face's triangle, and the middle facing it at f."""
    g = np.int64(f)
    if colour(net.faces[f].code) == BLUE:
        g = np.int64(net.faces[f].beside[0])
    j = np.int64(colour(net.faces[g].code))
    return g, j, np.int64(net.faces[f].corners[2 if g != f else (j + 2) % 3])


@lean
def middle_of(net, f, k):
    """The vertex that would split edge k of face f, with all that a criterion reads of it."""
    face = net.faces[f]
    a, b = np.int64(face.corners[k]), np.int64(face.corners[(k + 1) % 3])
    v = slot_of(net, middle_key(net, np.int64(face.base), a, b))
    if net.flags[v] & BORN == 0:
        ensure(net, v, ASK_BORN)
    if net.flags[v] & NORMAL == 0:
        set_normal(net, v)
    return v


@lean
def refine(net, view, limits, drift, most_splits, most_faces):
    """Split what is wanted, beginning with the faces in the queue, up to so many splits ever and faces."""
    while net.counts[WAITING] > 0:
        if not has_room(net):
            return NO_ROOM
        if net.counts[SPLITS] >= most_splits or net.counts[FACES_IN_USE] > most_faces:
            return ENOUGH
        f = dequeue(net)
        face = net.faces[f]
        if face.code == FREE_CODE:
            continue
        for k in range(3):
            if face.until[k] > drift:
                continue
            # So it stays for those asked from the other side, and for those whose makers are not wanted:
            # should that change, it becomes 0.
            face.until[k] = math.inf
            level = edge_level(face.code, k)
            if level == NONE:
                answer = ask_inner(net, f, view, limits, drift)
            elif is_asked_at(face, k):
                answer = ask_edge(net, f, k, level, view, limits, drift)
            else:
                continue
            if answer == NO_ROOM:
                face.until[k] = 0.0
                enqueue(net, f)
                return NO_ROOM
            if answer == ENOUGH:
                break  # the face is another now, and in the queue
    return DONE
