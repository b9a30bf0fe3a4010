"""Uniform √3 subdivision as Kobbelt's paper tells it: dictionaries, one step after the other.

Border edges are sharp edges, and sharp edges what the paper makes of border edges: cut in three on every
second step, never flipped, while each side does as if there were nothing beyond.
"""

import math

import numpy as np


def subdivided(positions, faces, steps, sharp=()):
    """(positions, faces) after so many steps; `sharp` are the pairs of vertices of the edges that are."""
    positions = [np.asarray(p, float) for p in positions]
    faces = [tuple(f) for f in np.asarray(faces).tolist()]
    edges = {(f[k], f[(k + 1) % 3]) for f in faces for k in range(3)}
    sharp = {frozenset(map(int, pair)) for pair in sharp} | {
        frozenset((a, b)) for a, b in edges if (b, a) not in edges
    }
    for step in range(steps):
        positions, faces, sharp = _step(positions, faces, sharp, is_odd=step % 2 == 1)
    return np.array(positions), np.array(faces)


def _step(positions, faces, sharp, *, is_odd):
    rings, along = {}, {}  # each vertex's neighbours, and those along sharp edges
    for f in faces:
        for v in f:
            rings.setdefault(v, set()).update(set(f) - {v})
    for pair in sharp:
        a, b = pair
        along.setdefault(a, []).append(b)
        along.setdefault(b, []).append(a)
    moved = [_moved(v, positions, rings, along, is_odd) for v in range(len(positions))]
    # What faces each edge in its face: the middle of that, or if it is cut the third of its sharp edge.
    facing, new_faces, thirds = {}, [], {}
    if is_odd:
        for a, b in map(tuple, sharp):
            for v, w in ((a, b), (b, a)):
                thirds[v, w] = len(moved)
                moved.append(_third(v, w, positions, along))
    for f in faces:
        cut = [k for k in range(3) if frozenset((f[k], f[(k + 1) % 3])) in sharp] if is_odd else []
        assert len(cut) <= 1
        for k in cut:
            a, b, c = f[k], f[(k + 1) % 3], f[(k + 2) % 3]
            p, q = thirds[a, b], thirds[b, a]
            facing[c, a], facing[b, c] = p, q
            new_faces.append((p, q, c))
        if not cut:
            middle = len(moved)
            moved.append(sum(positions[v] for v in f) / 3)
            for k in range(3):
                facing[f[k], f[(k + 1) % 3]] = middle
    for (a, b), c in facing.items():
        if frozenset((a, b)) in sharp:
            new_faces.append((a, b, c))
        elif a < b:
            d = facing[b, a]
            new_faces += [(a, d, c), (b, c, d)]
    if is_odd:
        sharp = {
            frozenset(pair)
            for a, b in map(tuple, sharp)
            for pair in ((a, thirds[a, b]), (thirds[a, b], thirds[b, a]), (thirds[b, a], b))
        }
    return moved, new_faces, sharp


def _moved(v, positions, rings, along, is_odd):
    """Where vertex v goes in a step."""
    p, ends = positions[v], along.get(v, ())
    if len(ends) == 2:
        return (4 * positions[ends[0]] + 19 * p + 4 * positions[ends[1]]) / 27 if is_odd else p
    if ends or v not in rings:  # a corner, the end of a crease, a vertex of no face
        return p
    n = len(rings[v])
    share = (4 - 2 * math.cos(2 * math.pi / n)) / 9
    return (1 - share) * p + share * sum(positions[w] for w in rings[v]) / n


def _third(v, w, positions, along):
    """The new point near v of the sharp edge v, w."""
    ends = along[v]
    if len(ends) != 2:
        return (2 * positions[v] + positions[w]) / 3
    before = ends[0] if ends[1] == w else ends[1]
    return (positions[before] + 16 * positions[v] + 10 * positions[w]) / 27
