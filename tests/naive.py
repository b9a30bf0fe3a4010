"""Slow, obvious twins of the compiled code. Read these first when a kernel looks wrong."""

import numpy as np

# ---------------------------------------------------------------- mesh


def weld(positions):
    """The new index of each vertex, places being numbered in order of first appearance."""
    seen = {}
    return [seen.setdefault(tuple(p + 0.0), len(seen)) for p in positions]


def edge_uses(faces):
    """How many triangles each edge has, by its two vertices; triangles with a repeated corner have none."""
    uses = {}
    for a, b, c in faces.tolist():
        if len({a, b, c}) == 3:
            for edge in ((a, b), (b, c), (c, a)):
                key = tuple(sorted(edge))
                uses[key] = uses.get(key, 0) + 1
    return uses


def component_count(faces):
    """Sets of triangles that hang together by vertices."""
    parent = {}

    def root(v):
        while parent.setdefault(v, v) != v:
            v = parent[v]
        return v

    for a, b, c in faces.tolist():
        parent[root(a)] = root(b)
        parent[root(b)] = root(c)
    return len({root(v) for v in list(parent)})


def vertex_normals(positions, faces):
    """Area-weighted sums of the triangles' normals, at unit length or zero."""
    sums = np.zeros_like(positions)
    for a, b, c in faces:
        for v in (a, b, c):
            sums[v] += np.cross(positions[b] - positions[a], positions[c] - positions[a])
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(lengths > 0, sums / np.where(lengths > 0, lengths, 1), 0)


def point_triangle_distance(p, a, b, c):
    """By the seven regions around a triangle (Ericson, Real-Time Collision Detection, section 5.1.5)."""

    def to_segment(q, r):
        length = np.dot(r - q, r - q)
        t = np.clip(np.dot(p - q, r - q) / length, 0, 1) if length > 0 else 0
        return np.linalg.norm(p - q - t * (r - q))

    sides = min(to_segment(a, b), to_segment(b, c), to_segment(c, a))
    normal = np.cross(b - a, c - a)
    if np.linalg.norm(normal) == 0:
        return sides
    normal = normal / np.linalg.norm(normal)
    foot = p - np.dot(p - a, normal) * normal
    turns = [np.dot(np.cross(r - q, foot - q), normal) for q, r in ((a, b), (b, c), (c, a))]
    return min(sides, abs(np.dot(p - a, normal))) if min(turns) >= 0 else sides


def surface_distance(points, positions, faces):
    """For each point the least distance to any triangle."""
    return [min(point_triangle_distance(p, *positions[f]) for f in faces) for p in points]


def all_distances(points, corners):
    """(n, m): distance of each point to each triangle (m, 3, 3), the least of those to its parts."""
    p = points[:, None]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]

    def to_segment(q, r):
        length = ((r - q) ** 2).sum(axis=1)
        t = np.clip(((p - q) * (r - q)).sum(axis=2) / np.where(length > 0, length, 1), 0, 1)
        return np.linalg.norm(p - q - t[..., None] * (r - q), axis=2)

    sides = np.minimum(np.minimum(to_segment(a, b), to_segment(b, c)), to_segment(c, a))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / np.where(length > 0, length, 1)
    height = ((p - a) * normal).sum(axis=2)
    foot = p - height[..., None] * normal
    turns = [(np.cross(r - q, foot - q) * normal).sum(axis=2) for q, r in ((a, b), (b, c), (c, a))]
    is_above = (np.min(turns, axis=0) >= 0) & (length[:, 0] > 0)
    return np.where(is_above, np.abs(height), sides)
