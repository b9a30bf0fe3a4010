"""RGB triangulations as sets: uniform subdivision in dictionaries, and what a set of splits shows of it.

A vertex is an int of the control mesh, or the frozenset of the two ends of the edge in whose middle it was
born; so an edge and the vertex that splits it have one name.
"""

import math
from fractions import Fraction


class Hierarchy:
    """Uniform Loop (or modified butterfly) subdivision of a mesh down to a level."""

    def __init__(self, positions, faces, depth, scheme="loop"):
        self.faces = [[tuple(f) for f in faces.tolist()]]
        self.positions = [dict(enumerate(positions))]
        self.born = dict.fromkeys(range(len(positions)), 0)
        self.key = {v: (-1, v, 0) for v in range(len(positions))}
        self._places = {
            v: {i: tuple(Fraction(w == v) for w in f) for i, f in enumerate(self.faces[0]) if v in f}
            for v in range(len(positions))
        }
        for level in range(depth):
            self._subdivide(level, scheme)
        self.apexes = [
            {(f[k], f[(k + 1) % 3]): f[(k + 2) % 3] for f in faces for k in range(3)} for faces in self.faces
        ]

    def _subdivide(self, level, scheme):
        old, faces = self.positions[level], self.faces[level]
        apex = {(f[k], f[(k + 1) % 3]): f[(k + 2) % 3] for f in faces for k in range(3)}
        new = {v: even(v, old, apex) if scheme == "loop" else p for v, p in old.items()}
        for a, b in apex:
            v = frozenset((a, b))
            if v not in self.born:
                new[v] = (odd if scheme == "loop" else butterfly)(a, b, old, apex)
                self.born[v] = level + 1
                self._address(v, a, b)
        finer = []
        for a, b, c in faces:
            ab, bc, ca = frozenset((a, b)), frozenset((b, c)), frozenset((c, a))
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        self.positions.append(new)
        self.faces.append(finer)

    def _address(self, v, a, b):
        one, two = self._places[a], self._places[b]
        self._places[v] = {
            f: tuple((x + y) / 2 for x, y in zip(one[f], two[f], strict=True)) for f in one if f in two
        }
        face, w = min(self._places[v].items())
        self.key[v] = (face, int(w[0] * 2**20), int(w[1] * 2**20))

    def wanted(self, is_long):
        """The edges that are split for themselves: what `is_long(level, a, b)` of those that are asked."""
        found = set()
        for level, apexes in enumerate(self.apexes[:-1]):
            halves, inner = {}, {}
            for edge in map(frozenset, apexes):
                makers = {v for v in edge if level > 0 and self.born[v] == level}
                (inner if len(makers) == 2 else halves)[edge] = makers
            new = {e for e, makers in halves.items() if makers <= found and is_long(level, *e)}
            taken = {v for e in new for v in self.required(e)} | found
            new |= {e for e, m in inner.items() if m & found and m <= taken and is_long(level, *e)}
            found |= new
        return found

    def required(self, edge):
        """The splits without which this one cannot be: those that make its triangles."""
        a, b = edge
        level = self.born[edge] - 1
        corners = {a, b, self.apexes[level].get((a, b)), self.apexes[level].get((b, a))} - {None}
        return {v for v in corners if level > 0 and self.born[v] == level}

    def closed(self, edges):
        """The least set of splits with these."""
        found, waiting = set(), list(edges)
        while waiting:
            edge = waiting.pop()
            if edge not in found:
                found.add(edge)
                waiting += self.required(edge)
        return found

    def removable(self, split):
        """The splits that no other one requires."""
        return split - {v for edge in split for v in self.required(edge)}

    def triangles(self, split):
        """The mesh of a closed set: (corner, corner, corner, colour, level) each."""
        return [t for f in self.faces[0] for t in self._divided(*f, split, 0)]

    def _divided(self, a, b, c, split, level):
        middles = [frozenset(e) if frozenset(e) in split else None for e in ((a, b), (b, c), (c, a))]
        count = sum(m is not None for m in middles)
        if count == 0:
            return [(a, b, c, "green", level)]
        if count == 3:
            ab, bc, ca = middles
            children = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
            return [t for child in children for t in self._divided(*child, split, level + 1)]
        while middles[0] is None or (count == 2 and middles[2] is not None):
            a, b, c, middles = b, c, a, [*middles[1:], middles[0]]
        ab, bc, _ = middles
        if count == 1:
            return [(a, ab, c, "red", level), (ab, b, c, "red", level)]
        corner = self._divided(ab, b, bc, split, level + 1)
        if self.key[c] < self.key[a]:
            return [*corner, (a, ab, c, "red", level), (ab, bc, c, "blue", level)]
        return [*corner, (a, bc, c, "red", level), (a, ab, bc, "blue", level)]

    def shown(self, triangles):
        """Where the vertices of a mesh stand: on the highest level among them and their neighbours."""
        levels = {}
        for *corners, _, _ in triangles:
            level = max(self.born[v] for v in corners)
            for v in corners:
                levels[v] = max(levels.get(v, 0), level)
        return {v: self.positions[level][v] for v, level in levels.items()}


def ring(v, apex):
    """The neighbours of v counter-clockwise; of a border vertex from its next to its previous one."""
    following = {b: c for (a, b), c in apex.items() if a == v}
    first = next((b for b in following if (b, v) not in apex), None)
    start = first if first is not None else next(iter(following))
    found = [start]
    while found[-1] in following and following[found[-1]] != start:
        found.append(following[found[-1]])
    return found, first is not None


def even(v, old, apex):
    if not any(a == v for a, b in apex):
        return old[v]
    around, is_border = ring(v, apex)
    if is_border:
        return 0.75 * old[v] + 0.125 * (old[around[0]] + old[around[-1]])
    n = len(around)
    alpha = 5 / 8 - (3 / 8 + math.cos(2 * math.pi / n) / 4) ** 2
    return (1 - alpha) * old[v] + alpha * sum(old[w] for w in around) / n


def odd(a, b, old, apex):
    if (b, a) not in apex:
        return (old[a] + old[b]) / 2
    return 3 / 8 * (old[a] + old[b]) + 1 / 8 * (old[apex[a, b]] + old[apex[b, a]])


def butterfly(a, b, old, apex):
    """The modified butterfly; ends on the border count as regular, missing wings end a parallelogram."""
    if (b, a) not in apex:
        before = next(x for x, y in apex if y == a and (y, x) not in apex)
        after = next(y for x, y in apex if x == b and (y, x) not in apex)
        return 9 / 16 * (old[a] + old[b]) - 1 / 16 * (old[before] + old[after])
    parts = []
    for v, w in ((a, b), (b, a)):
        around, is_border = ring(v, apex)
        n = len(around)
        if is_border or n == 6:
            continue
        i = around.index(w)
        shares = {3: [5 / 12, -1 / 12, -1 / 12], 4: [3 / 8, 0, -1 / 8, 0]}.get(n) or [
            (1 / 4 + math.cos(2 * math.pi * j / n) + math.cos(4 * math.pi * j / n) / 2) / n for j in range(n)
        ]
        parts.append(3 / 4 * old[v] + sum(s * old[around[(i + j) % n]] for j, s in enumerate(shares)))
    if parts:
        return sum(parts) / len(parts)
    c, d = apex[a, b], apex[b, a]
    wings = 0
    for x, y, z in ((c, a, b), (b, c, a), (a, d, b), (d, b, a)):  # the edge (x, y) seen from z's triangle
        wings = wings + (old[apex[y, x]] if (y, x) in apex else old[x] + old[y] - old[z])
    return (old[a] + old[b]) / 2 + (old[c] + old[d]) / 8 - wings / 16
