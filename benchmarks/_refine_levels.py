"""Levels of uniform Loop subdivision as arrays, and which of their edges a view wants split.

All schemes that cut triangles in four are asked the same question, edge by edge; it is the one that RGB
triangulations in `foveal.refine` are asked, here in NumPy.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from foveal.mesh import TriMesh
from foveal.refine import Criteria
from foveal.refine.cage import Cage
from foveal.refine.criteria import view_of
from foveal.refine.uniform import Level, LoopRule
from foveal.view.camera import Camera

Edges = NDArray[np.int64]
Mask = NDArray[np.bool_]
Predicate = Callable[[int, Edges], Mask]
"""(level, edges of it) -> which of them are to be split."""


class Hierarchy:
    """Levels of uniform Loop subdivision, as many as were asked for, up to the `deepest`.

    A vertex has the same number on each level it is on. `normals` and `spreads` are of the triangles between
    which it was born (of the control mesh: of those around it), and how far theirs and its ends' are from it.
    """

    def __init__(self, mesh: TriMesh, deepest: int = 6) -> None:
        cage = Cage.of(mesh)
        self.deepest, self._rule = deepest, LoopRule(cage)
        self.levels, self.positions = [Level.of(cage)], [cage.positions]
        corners = cage.positions[cage.faces]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        sums = np.zeros_like(cage.positions)
        np.add.at(sums, cage.faces, areas[:, None, :])
        self.normals = unit(sums)
        self.spreads = np.zeros(len(sums))
        far = np.linalg.norm(unit(areas)[:, None, :] - self.normals[cage.faces], axis=2)
        np.maximum.at(self.spreads, cage.faces, far)

    def grow(self) -> None:
        """One level more."""
        level, points = self.levels[-1], self.positions[-1]
        self._add_normals(level, points)
        self.positions.append(self._rule.next(level, points))
        self.levels.append(level.split(len(points)))

    def _add_normals(self, level: Level, points: NDArray[np.float64]) -> None:
        """Of the vertices that are born in the edges of a level."""
        face, corner = np.divmod(level.halves, 3)
        a, b, c = (points[level.faces[face[:, 0], (corner[:, 0] + k) % 3]] for k in range(3))
        middle, along = (a + b) / 2, b - a
        left = unit(np.cross(along, c - middle))
        has_right = level.halves[:, 1:] >= 0
        d = points[level.faces[face[:, 1], (corner[:, 1] + 2) % 3]]
        right = np.where(has_right, unit(np.cross(along, middle - d)), left)
        born = unit(left + right)
        ends = self.ends(len(self.levels) - 1, np.arange(len(level.halves)))
        about = (left, right, self.normals[ends[:, 0]], self.normals[ends[:, 1]])
        far = np.max([np.linalg.norm(normal - born, axis=1) for normal in about], axis=0)
        self.normals = np.concatenate([self.normals, born])
        self.spreads = np.concatenate([self.spreads, far])

    def limits(self) -> NDArray[np.float64]:
        """(v, 3): where the last level's vertices end up."""
        return self._rule.limit(self.levels[-1], self.positions[-1])

    def bytes_used(self) -> int:
        """What its arrays take."""
        arrays = [a for level in self.levels for a in level] + self.positions
        return sum(a.nbytes for a in arrays) + self.normals.nbytes + self.spreads.nbytes

    def ends(self, level: int, edges: Edges) -> NDArray[np.int64]:
        """(k, 2): the vertices of some edges of a level."""
        connectivity = self.levels[level]
        face, corner = np.divmod(connectivity.halves[edges, 0], 3)
        ends = connectivity.faces[face[:, None], np.stack([corner, (corner + 1) % 3], axis=1)]
        return ends.astype(np.int64)

    def sides(self, level: int) -> NDArray[np.int64]:
        """(e,): how many triangles each edge of a level has."""
        return 1 + (self.levels[level].halves[:, 1] >= 0)


def unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of unit length, or zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1)


def by_view(hierarchy: Hierarchy, camera: Camera, criteria: Criteria) -> Predicate:
    """Edges in the frustum that are longer in pixels than their region allows.

    An edge is on the silhouette if the normals of its ends face different ways, or would if the surface bent
    as much again as it does about those of its ends that are new on its level.
    """
    view, limits = view_of(camera), criteria.limits()
    eye, pixels, planes = view[:3], view[3], view[4:].reshape(5, 4)

    def is_wanted(level: int, edges: Edges) -> Mask:
        ends = hierarchy.ends(level, edges)
        a, b = (hierarchy.positions[level][ends[:, k]] for k in range(2))
        middle, length = (a + b) / 2, np.linalg.norm(b - a, axis=1)
        towards = eye - middle
        away = np.linalg.norm(towards, axis=1)
        inside = middle @ planes[:, :3].T + planes[:, 3] + 1.16 * length[:, None]
        old = 0 if level == 0 else len(hierarchy.positions[level - 1])
        spread = np.where(ends >= old, hierarchy.spreads[ends], 0).max(axis=1) * away
        facing = [(hierarchy.normals[ends[:, k]] * towards).sum(axis=1) for k in range(2)]
        is_front, is_back = np.minimum(*facing) > spread, -np.maximum(*facing) > spread
        region = np.where(is_front, 0, np.where(is_back, 2, 1))
        is_long = pixels * length > limits[region, 1] * away
        return (inside >= 0).all(axis=1) & is_long & (level < limits[region, 0])

    return is_wanted
