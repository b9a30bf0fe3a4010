"""Loop's scheme and the modified butterfly as their papers tell them: dictionaries and sums."""

import math

import numpy as np


def loop(positions, faces, steps, *, corners_stay=False):
    """(positions, faces) after so many steps."""
    return _subdivided(positions, faces, steps, lambda star: _Loop(star, corners_stay))


def butterfly(positions, faces, steps):
    """(positions, faces) after so many steps."""
    return _subdivided(positions, faces, steps, _Butterfly)


def _subdivided(positions, faces, steps, rule_of):
    positions, faces = np.asarray(positions, float), [tuple(f) for f in np.asarray(faces).tolist()]
    for _ in range(steps):
        star = _Star(positions, faces)
        rule = rule_of(star)
        number = {edge: len(positions) + i for i, edge in enumerate(star.edges)}
        positions = np.array(
            [rule.old(v) for v in range(len(positions))] + [rule.new(*edge) for edge in star.edges]
        )
        fine = []
        for f in faces:
            m = [number[tuple(sorted((f[k], f[(k + 1) % 3])))] for k in range(3)]
            fine += [(f[k], m[k], m[k - 1]) for k in range(3)] + [tuple(m)]
        faces = fine
    return positions, np.array(faces)


class _Star:
    """Who is around whom: `third[a, b]` is the corner across the edge that runs from a to b."""

    def __init__(self, positions, faces):
        self.p = positions
        self.third = {(f[k], f[(k + 1) % 3]): f[(k + 2) % 3] for f in faces for k in range(3)}
        self.edges = sorted({tuple(sorted(edge)) for edge in self.third})
        self.following = {a: b for a, b in self.third if (b, a) not in self.third}
        self.before = {b: a for a, b in self.following.items()}
        self.neighbours = {v: set() for v in range(len(positions))}
        for a, b in self.edges:
            self.neighbours[a].add(b)
            self.neighbours[b].add(a)

    def is_rim(self, a, b):
        return (a, b) not in self.third or (b, a) not in self.third


class _Loop:
    def __init__(self, star, corners_stay):
        self.star, self.corners_stay = star, corners_stay

    def old(self, v):
        s, p = self.star, self.star.p
        n = len(s.neighbours[v])
        if v in s.following:
            if self.corners_stay and n == 2:
                return p[v]
            return p[v] * 3 / 4 + (p[s.following[v]] + p[s.before[v]]) / 8
        if n == 0:
            return p[v]
        alpha = 5 / 8 - (3 / 8 + math.cos(2 * math.pi / n) / 4) ** 2
        return (1 - alpha) * p[v] + alpha * sum(p[w] for w in s.neighbours[v]) / n

    def new(self, a, b):
        s, p = self.star, self.star.p
        if s.is_rim(a, b):
            return (p[a] + p[b]) / 2
        return (3 * p[a] + 3 * p[b] + p[s.third[a, b]] + p[s.third[b, a]]) / 8


class _Butterfly:
    def __init__(self, star):
        self.star = star

    def old(self, v):
        return self.star.p[v]

    def new(self, a, b):
        s, p = self.star, self.star.p
        if s.is_rim(a, b):
            a, b = (a, b) if (a, b) in s.third else (b, a)
            return (9 * p[a] + 9 * p[b] - p[s.before[a]] - p[s.following[b]]) / 16
        odd = [(v, w) for v, w in ((a, b), (b, a)) if v not in s.following and len(s.neighbours[v]) != 6]
        if odd:
            return sum(self.from_star(v, w) for v, w in odd) / len(odd)
        c, d = s.third[a, b], s.third[b, a]
        wings = sum(self.beyond(u, v) for u, v in ((b, c), (c, a), (a, d), (d, b)))
        return (p[a] + p[b]) / 2 + (p[c] + p[d]) / 8 - wings / 16

    def beyond(self, u, v):
        """Across the edge from u to v of a face; beyond the border, the third corner reflected."""
        s, p = self.star, self.star.p
        return p[s.third[v, u]] if (v, u) in s.third else p[u] + p[v] - p[s.third[u, v]]

    def from_star(self, v, w):
        s, p = self.star, self.star.p
        ring = [w]
        while s.third[v, ring[-1]] != w:
            ring.append(s.third[v, ring[-1]])
        n = len(ring)
        if n == 2:
            weights = [1 / 4, 0]
        elif n == 3:
            weights = [5 / 12, -1 / 12, -1 / 12]
        elif n == 4:
            weights = [3 / 8, 0, -1 / 8, 0]
        else:
            turns = [2 * math.pi * j / n for j in range(n)]
            weights = [(1 / 4 + math.cos(t) + math.cos(2 * t) / 2) / n for t in turns]
        return 3 / 4 * p[v] + sum(weight * p[q] for weight, q in zip(weights, ring, strict=True))
