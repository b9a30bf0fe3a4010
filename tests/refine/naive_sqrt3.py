"""Uniform √3 subdivision as Kobbelt's paper tells it: dictionaries, one step after the other."""

import math

import numpy as np


def subdivided(positions, faces, steps):
    """(positions, faces) after so many steps; on every second one the border edges are cut in three."""
    positions, faces = (
        [np.asarray(p, float) for p in positions],
        [tuple(f) for f in np.asarray(faces).tolist()],
    )
    for step in range(steps):
        positions, faces = _step(positions, faces, is_odd=step % 2 == 1)
    return np.array(positions), np.array(faces)


def _step(positions, faces, *, is_odd):
    owner = {(f[k], f[(k + 1) % 3]): (i, f[(k + 2) % 3]) for i, f in enumerate(faces) for k in range(3)}
    rings = {}
    for a, b in owner:
        rings.setdefault(a, set()).add(b)
        rings.setdefault(b, set()).add(a)
    following = {a: b for a, b in owner if (b, a) not in owner}
    before = {b: a for a, b in following.items()}
    moved = []
    for v, p in enumerate(positions):
        if v in following:
            q, r = positions[before[v]], positions[following[v]]
            moved.append((4 * q + 19 * p + 4 * r) / 27 if is_odd else p)
        elif v not in rings:
            moved.append(p)
        else:
            n = len(rings[v])
            share = (4 - 2 * math.cos(2 * math.pi / n)) / 9
            moved.append((1 - share) * p + share * sum(positions[w] for w in rings[v]) / n)
    # What faces each old edge: the middle of its face, or on a cut border the point near the edge's end.
    facing, new_faces = {}, []
    for f in faces:
        edge = next(
            (
                (f[k], f[(k + 1) % 3])
                for k in range(3)
                if f[k] in following and following[f[k]] == f[(k + 1) % 3]
            ),
            None,
        )
        if is_odd and edge:
            a, b = edge
            c = next(v for v in f if v not in edge)
            pa, pb = positions[a], positions[b]
            p, q = len(moved), len(moved) + 1
            moved.append((positions[before[a]] + 16 * pa + 10 * pb) / 27)
            moved.append((10 * pa + 16 * pb + positions[following[b]]) / 27)
            facing[c, a], facing[b, c] = p, q
            new_faces.append((p, q, c))
            facing[a, b] = None
        else:
            middle = len(moved)
            moved.append(sum(positions[v] for v in f) / 3)
            for k in range(3):
                facing[f[k], f[(k + 1) % 3]] = middle
    for (a, b), c in facing.items():
        if (b, a) in facing:
            if a < b:
                d = facing[b, a]
                new_faces += [(a, d, c), (b, c, d)]
        elif c is not None:
            new_faces.append((a, b, c))
    # On a cut border: the thirds beside the edge's ends, already flipped by the loop above, keep a, p and q.
    return moved, new_faces
