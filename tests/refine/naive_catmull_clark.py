"""Catmull-Clark as its papers tell it, with all kinds of creases: dictionaries, sums, float64.

Read this first when a kernel looks wrong. `start` makes a `Surface` of a mesh, `subdivided` is one uniform
step, `limits` gives limit points and normals. Points may have any number of columns, so that attributes
go along; normals are of the first three.

Based on: Catmull, Clark 1978; Halstead, Kass, DeRose 1993 (limits); DeRose, Kass, Truong 1998 (creases).
The blend of rules while a sharpness runs out, and what "none" leaves out, are OpenSubdiv's.
"""

import functools
import math
from dataclasses import dataclass, field

import numpy as np

INFINITE = 10.0  # from here on a sharpness never decreases


@dataclass
class Surface:
    """Points (n, d), faces as tuples, sharpness by (lower, upper) edge and by vertex, numbers of holes."""

    points: np.ndarray
    faces: list
    creases: dict
    sharp: dict
    corners_stay: bool  # a vertex of one face is infinitely sharp
    holes: set = field(default_factory=set)
    areas: dict | None = None  # normals by corner, of the first settled surface or handed on from it

    def __post_init__(self):
        # side[a, b] is (face, k) where the face's corner k is a and the next is b.
        self.side = {}
        self.faces_at = [[] for _ in self.points]
        for f, face in enumerate(self.faces):
            for k, a in enumerate(face):
                self.side[a, face[(k + 1) % len(face)]] = f, k
                self.faces_at[a].append((f, k))
        self.edges = sorted({tuple(sorted(half)) for half in self.side})
        self.ends = [[] for _ in self.points]
        for a, b in self.edges:
            self.ends[a].append(b)
            self.ends[b].append(a)
        if self.areas is None and self.is_settled():
            self.areas = area_normals(self)

    def is_rim(self, a, b):
        return (a, b) not in self.side or (b, a) not in self.side

    def crease(self, a, b, steps=0):
        """How sharp the edge is, after so many steps."""
        return math.inf if self.is_rim(a, b) else less(self.creases.get((min(a, b), max(a, b)), 0), steps)

    def corner(self, v, steps=0):
        """How sharp the vertex is, after so many steps."""
        if self.corners_stay and len(self.faces_at[v]) == 1:
            return math.inf
        return less(self.sharp.get(v, 0), steps)

    def sharp_ends(self, v, steps=0):
        return [w for w in self.ends[v] if self.crease(v, w, steps) > 0]

    def kind(self, v, steps=0):
        sharp = len(self.sharp_ends(v, steps))
        if self.corner(v, steps) > 0 or sharp > 2:
            return "corner"
        return "crease" if sharp == 2 else "smooth"

    def is_settled(self):
        """Nothing will be less sharp than it is now, and all faces are quadrangles."""
        tags = [self.crease(*edge) for edge in self.creases] + [self.corner(v) for v in self.sharp]
        return all(not 0 < s < INFINITE for s in tags) and all(len(face) == 4 for face in self.faces)


def less(sharpness, steps):
    return math.inf if sharpness >= INFINITE else max(sharpness - steps, 0)


def start(mesh, columns=None):
    """The surface of a `PolyMesh`, or of other columns on it."""
    points = mesh.positions if columns is None else np.asarray(columns, float)
    rings = np.split(mesh.corners, mesh.starts[1:-1])
    creases = dict(zip(map(tuple, mesh.crease_edges.tolist()), mesh.crease_sharpness.tolist(), strict=True))
    sharp = dict(zip(mesh.corner_vertices.tolist(), mesh.corner_sharpness.tolist(), strict=True))
    faces = [tuple(ring.tolist()) for ring in rings]
    surface = Surface(points, faces, creases, sharp, mesh.boundary == "edge_and_corner")
    if mesh.boundary == "none":
        open_edges = [e for e in surface.edges if surface.is_rim(*e) and creases.get(e, 0) < INFINITE]
        surface.holes = {f for edge in open_edges for v in edge for f, _ in surface.faces_at[v]}
    return surface


def subdivided(s):
    """One uniform step: old vertices first, then a vertex an edge (in the order of `edges`), then one a face.

    The children of a face follow its corners: corner, next edge, face, previous edge.
    """
    centres = [sum(s.points[v] for v in face) / len(face) for face in s.faces]
    middles = [edge_point(s, centres, *edge) for edge in s.edges]
    moved = [vertex_point(s, centres, v) for v in range(len(s.points))]
    number = {edge: len(moved) + i for i, edge in enumerate(s.edges)}
    faces, holes = [], set()
    for f, face in enumerate(s.faces):
        middle = [number[tuple(sorted((a, b)))] for a, b in zip(face, face[1:] + face[:1], strict=True)]
        for k, v in enumerate(face):
            if f in s.holes:
                holes.add(len(faces))
            faces.append((v, middle[k], len(moved) + len(middles) + f, middle[k - 1]))
    creases = {}
    for edge, sharpness in s.creases.items():
        if less(sharpness, 1) > 0:
            creases |= {(v, number[edge]): less(sharpness, 1) for v in edge}
    sharp = {v: less(sharpness, 1) for v, sharpness in s.sharp.items() if less(sharpness, 1) > 0}
    begin = np.cumsum([0] + [len(face) for face in s.faces])
    areas = s.areas and {(begin[f] + k, 0): normal for (f, k), normal in s.areas.items()}
    points = np.array([*moved, *middles, *centres])
    return Surface(points, faces, creases, sharp, s.corners_stay, holes, areas)


def edge_point(s, centres, a, b):
    p, sharpness = s.points, min(s.crease(a, b), 1)
    middle = (p[a] + p[b]) / 2
    if sharpness == 1:
        return middle
    smooth = (p[a] + p[b] + centres[s.side[a, b][0]] + centres[s.side[b, a][0]]) / 4
    return sharpness * middle + (1 - sharpness) * smooth


def vertex_point(s, centres, v):
    """By the vertex's rule; by both, weighted, in the step in which the rule changes."""
    now, then = s.kind(v), s.kind(v, 1)
    if now == then:
        return vertex_rule(s, centres, v, now, 0)
    ending = [s.crease(v, w) for w in s.ends[v] if 0 < s.crease(v, w) <= 1]
    if s.corner(v) > 0 and s.corner(v, 1) == 0:
        ending.append(s.corner(v))
    weight = min(sum(ending) / len(ending), 1)
    return weight * vertex_rule(s, centres, v, now, 0) + (1 - weight) * vertex_rule(s, centres, v, then, 1)


def vertex_rule(s, centres, v, kind, steps):
    p, n = s.points, len(s.ends[v])
    if kind == "corner" or n == 0:
        return p[v]
    if kind == "crease":
        return 3 / 4 * p[v] + sum(p[w] for w in s.sharp_ends(v, steps)) / 8
    around = sum(p[w] for w in s.ends[v]) + sum(centres[f] for f, _ in s.faces_at[v])
    return (n - 2) / n * p[v] + around / n**2


def limits(s, level=0):
    """Of the surface after `level` steps: limit points (n, d) and unit normals, one a corner of its faces.

    Normals are in the order of the corners of the faces, since a vertex has one a sector: all corners
    between two sharp edges have the same. A corner of several faces has no tangent plane: its normals are
    those of its sectors' faces at the least level at which all is settled, whatever the level asked for.
    """
    for _ in range(level):
        s = subdivided(s)
    count = len(s.points)
    # Where a corner is in a later surface: corner 0 of a child.
    place = [(f, k) for f, face in enumerate(s.faces) for k in range(len(face))]
    while not s.is_settled():
        begin = np.cumsum([0] + [len(face) for face in s.faces])
        place = [(begin[f] + k, 0) for f, k in place]
        s = subdivided(s)
    points, normal_at = s.points[:count].copy(), {}
    for v in range(count):
        if s.ends[v]:
            points[v], normals = vertex_limit(s, v)
            normal_at.update(normals)
    return points, np.array([normal_at[corner] for corner in place])


def area_normals(s):
    """By corner of a face, the unit sum of the area vectors of the faces in its sector."""
    normals = {}
    for v in range(len(s.points)):
        for fans in sectors(s, v):
            area = sum(
                np.cross(s.points[f, :3] - s.points[v, :3], s.points[b, :3] - s.points[a, :3])
                for a, f, b, _ in fans
            )
            normals |= {corner: unit(area) for _, _, _, corner in fans}
    return normals


def sectors(s, v):
    """Lists of (next, across, previous, corner) of the faces at v, counter-clockwise between sharp edges.

    A vertex without sharp edges has one sector that begins anywhere and ends there.
    """
    sharp = s.sharp_ends(v)
    result = []
    for first in [w for w in sharp if (v, w) in s.side] or s.ends[v][:1]:
        fans, w = [], first
        while True:
            f, k = s.side[v, w]
            face = s.faces[f]
            across, previous = face[(k + 2) % 4], face[(k + 3) % 4]
            fans.append((w, across, previous, (f, k)))
            w = previous
            if w in sharp or w == first:
                break
        result.append(fans)
    return result


def vertex_limit(s, v):
    """The limit point, and a normal for each corner of a face at v. Sharpness is 0 or infinite."""
    p, kind, normals = s.points, s.kind(v), {}
    for fans in sectors(s, v):
        e = [p[w] for w, _, _, _ in fans] + [
            p[fans[-1][2]]
        ]  # one more than faces; all around, the first again
        f = [p[w] for _, w, _, _ in fans]
        one = two = np.zeros(3)
        if kind == "corner":
            point = p[v]
            if len(f) == 1:
                one, two = e[0] - p[v], e[1] - p[v]
        elif kind == "crease":
            point = (e[0] + 4 * p[v] + e[-1]) / 6
            one, two = e[0] - e[-1], weighted(across_weights(len(f)), p[v], e, f)
        else:
            masks = dart_weights(len(f)) if s.sharp_ends(v) else smooth_weights(len(f))
            point, one, two = (weighted(mask, p[v], e[:-1], f) for mask in masks)
        normal = np.cross(one[:3], two[:3])
        is_tiny = np.linalg.norm(normal) <= 1e-12 * np.linalg.norm(one[:3]) * np.linalg.norm(two[:3])
        none = np.zeros(3)  # where there is no tangent plane at a vertex younger than the settled surface
        for _, _, _, corner in fans:
            normals[corner] = s.areas.get(corner, none) if is_tiny else unit(normal)
    return point, normals


def unit(vector):
    length = np.linalg.norm(vector)
    return vector / length if length > 0 else np.zeros(3)


def weighted(mask, v, e, f):
    """mask[0] v + sum mask[1 + i] e_i + sum mask[1 + len(e) + i] f_i."""
    return np.asarray(mask) @ np.array([v, *e, *f])


@functools.cache
def smooth_weights(n):
    """Of the limit point and two tangents of an interior vertex of valence n: v, then e_i, then f_i."""
    point = np.array([n**2] + n * [4] + n * [1]) / (n * (n + 5))
    if n == 2:  # where the formula gives nothing; eigenvectors of its matrix, both for 1/4
        return point, np.array([0, 1, -1, 0, 0]), np.array([0, 0, 0, 1, -1])
    turn = 2 * math.pi / n
    a = 1 + math.cos(turn) + math.cos(turn / 2) * math.sqrt(2 * (9 + math.cos(turn)))
    one, two = (
        np.array(
            [0] + [a * g(turn * i) for i in range(n)] + [g(turn * i) + g(turn * (i + 1)) for i in range(n)]
        )
        for g in (math.cos, math.sin)
    )
    return point, one, two


@functools.cache
def across_weights(k):
    """Of the tangent across a crease into a sector of k faces: v, e_0 .. e_k, f_0 .. f_(k-1)."""
    if k == 1:
        return np.array([-2, 1, 1, 0])
    angle = math.pi / k
    size = (5 + math.cos(angle) + math.cos(angle / 2) * math.sqrt(2 * (9 + math.cos(angle)))) / 16
    a, cot = 16 * size - 4, 1 / math.tan(angle / 2)
    centre = -(8 * size * math.sin(angle) + (8 * size - 4) * (8 * size - 1) * cot) / (4 * size - 1)
    end = -(centre + (16 * size - 2) * cot) / 2
    inner = [a * math.sin(angle * i) for i in range(1, k)]
    return np.array(
        [centre, end, *inner, end] + [math.sin(angle * i) + math.sin(angle * (i + 1)) for i in range(k)]
    )


@functools.cache
def dart_weights(n):
    """As `smooth_weights`, where the edge to e_0 is infinitely sharp: left eigenvectors of the step's matrix.

    The step commutes with the reflection that keeps e_0. Of the vectors that it keeps, the first belongs to
    1 and the second is the tangent along the edge; of those it turns over, the first is the one across.
    """
    step = ring_matrix(n, is_dart=True)
    mirror = np.zeros_like(step)
    mirror[0, 0] = 1
    for i in range(n):
        mirror[1 + i, 1 + -i % n] = 1
        mirror[1 + n + i, 1 + n + (-1 - i) % n] = 1
    assert np.allclose(mirror @ step, step @ mirror)
    kept = left_eigenvectors(step @ (np.eye(2 * n + 1) + mirror) / 2)
    turned = left_eigenvectors(step @ (np.eye(2 * n + 1) - mirror) / 2)
    angles = 2 * math.pi / n * np.concatenate([np.arange(n), np.arange(n) + 0.5])
    point, one, two = kept[0] / kept[0].sum(), kept[1], turned[0]
    return point, one * np.sign(one[1:] @ np.cos(angles)), two * np.sign(two[1:] @ np.sin(angles))


def ring_matrix(n, is_dart):
    """(2 n + 1, 2 n + 1): v, e_i, f_i after a step of v, e_i, f_i."""
    size = 2 * n + 1
    v, e, f = np.eye(size)[0], np.eye(size)[1 : n + 1], np.eye(size)[n + 1 :]
    centres = [(v + e[i] + f[i] + e[(i + 1) % n]) / 4 for i in range(n)]
    middles = [(v + e[i] + centres[i - 1] + centres[i]) / 4 for i in range(n)]
    if is_dart:
        middles[0] = (v + e[0]) / 2
    return np.array([(n - 2) / n * v + (sum(e) + sum(centres)) / n**2, *middles, *centres])


def left_eigenvectors(matrix):
    """As rows, by falling eigenvalue."""
    values, vectors = np.linalg.eig(matrix.T)
    return vectors.T[np.argsort(-abs(values))].real
