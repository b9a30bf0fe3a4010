"""Red-green triangulation, the peer that RGB triangulations compare themselves with.

A triangle is quadrisected, or at the border of what is, cut in two or three. What an edge is to be split for
is asked once, of the edge; the classic scheme quadrisects both triangles beside it. `is_sparing` quadrisects
none before something finer needs it, which favours red-green as much as its rules allow.

Based on: R. Bank, A. Sherman, A. Weiser. Refinement algorithms and data structures for regular local mesh
refinement. 1983; D. Zorin, P. Schröder, W. Sweldens. Interactive multiresolution mesh editing. SIGGRAPH 1997
(positions are those of uniform subdivision, all levels of which are kept).
"""

from dataclasses import dataclass, field

import numpy as np
from _refine_levels import Hierarchy, Mask, Predicate
from numpy.typing import NDArray

from foveal.mesh import TriMesh
from foveal.refine.uniform import Level


def wanted_edges(hierarchy: Hierarchy, is_wanted: Predicate) -> list[Mask]:
    """Of each level down to the last with any, which edges meet the predicate and have a parent that does.

    The parent of half an edge is that edge; an edge inside a triangle has the two whose middles it joins.
    """
    wanted: list[Mask] = []
    for number in range(hierarchy.deepest):
        if number == 0:
            mask = np.ones(len(hierarchy.levels[0].halves), bool)
        else:
            before, edges = wanted[-1], hierarchy.levels[number - 1].edges
            inner = before[edges] | before[np.roll(edges, 1, axis=1)]
            mask = np.concatenate([np.repeat(before, 2), inner.reshape(-1)])
        asked = np.flatnonzero(mask)
        mask[asked] = is_wanted(number, asked)
        if not mask.any():
            break
        wanted.append(mask)
        if len(hierarchy.levels) == number + 1:
            hierarchy.grow()
    return wanted


@dataclass
class RedGreen:
    """Which edges of each level are split, and which triangles are quadrisected."""

    hierarchy: Hierarchy
    cut: list[Mask] = field(default_factory=list)
    whole: list[Mask] = field(default_factory=list)

    def count(self) -> int:
        """Triangles: each edge that is split adds one on each of its sides."""
        added = sum(int(self.hierarchy.sides(i)[mask].sum()) for i, mask in enumerate(self.cut))
        return len(self.hierarchy.levels[0].faces) + added

    def mesh(self, *, is_limit: bool = False) -> TriMesh:
        """The triangles; a vertex stands where it is on the finest level that any of them is of."""
        faces, depths = [], []
        is_there = np.ones(len(self.hierarchy.levels[0].faces), bool)
        for number, level in enumerate(self.hierarchy.levels):
            if number == len(self.whole):
                faces.append(level.faces[is_there])
                depths.append(np.full(len(faces[-1]), number))
                break
            green = is_there & ~self.whole[number]
            made, extra = _closed(level, self.cut[number], green, len(self.hierarchy.positions[number]))
            faces.append(made)
            depths.append(number + extra)
            is_there = np.repeat(is_there & self.whole[number], 4)
        corners, depth = np.concatenate(faces), np.concatenate(depths)
        used, index = np.unique(corners, return_inverse=True)
        return TriMesh(self._places(corners, depth, used, is_limit), index.reshape(-1, 3).astype(np.int32))

    def _places(
        self, corners: NDArray[np.int32], depth: NDArray[np.int64], used: NDArray[np.int32], is_limit: bool
    ) -> NDArray[np.float64]:
        if is_limit:
            return self.hierarchy.limits()[used]
        depths = np.zeros(int(used[-1]) + 1, np.int64)
        np.maximum.at(depths, corners.reshape(-1), np.repeat(depth, 3))
        places = np.empty((len(used), 3))
        for number, points in enumerate(self.hierarchy.positions):
            here = depths[used] == number
            places[here] = points[used[here]]
        return places


def _closed(
    level: Level, cut: Mask, green: Mask, vertices: int
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """The triangles of a level that are not quadrisected, cut as their edges are; 1 where they were cut."""
    corners, edges = level.faces[green], level.edges[green]
    marks = cut[edges]
    count = marks.sum(axis=1)
    # Turned so that the edge that differs from the others is the first.
    odd = np.where(count == 1, marks.argmax(axis=1), (~marks).argmax(axis=1))
    turn = (odd[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(corners, turn, axis=1).T
    ab, bc, ca = np.take_along_axis(edges, turn, axis=1).T + vertices
    one, two = count == 1, count == 2
    low = two & (a < b)  # of the two diagonals, the one from the lowest vertex
    high = two & ~low
    parts = [
        np.stack([a, b, c], axis=1)[count == 0],
        np.stack([a, ab, c], axis=1)[one],
        np.stack([ab, b, c], axis=1)[one],
        np.stack([bc, c, ca], axis=1)[two],
        np.stack([a, bc, ca], axis=1)[low],
        np.stack([a, b, bc], axis=1)[low],
        np.stack([a, b, ca], axis=1)[high],
        np.stack([b, bc, ca], axis=1)[high],
    ]
    made = np.concatenate(parts).astype(np.int32)
    return made, (np.arange(len(made)) >= len(parts[0])).astype(np.int64)


def red_green(hierarchy: Hierarchy, is_wanted: Predicate, *, is_sparing: bool = False) -> RedGreen:
    """The coarsest red-green triangulation in which every wanted edge is split."""
    wanted = wanted_edges(hierarchy, is_wanted)
    made = RedGreen(hierarchy, list(wanted), list(wanted))
    finer: Mask | None = None
    for number in reversed(range(len(wanted))):
        level, cut = hierarchy.levels[number], wanted[number].copy()
        whole = np.zeros(len(level.faces), bool) if is_sparing else cut[level.edges].any(axis=1)
        if finer is not None:  # both faces of a finer edge that is split must be there
            halves = finer[: 2 * len(cut)].reshape(-1, 2).any(axis=1)
            inner = finer[2 * len(cut) :].reshape(-1, 3).any(axis=1)
            whole |= halves[level.edges].any(axis=1) | inner
        cut[level.edges[whole]] = True
        made.cut[number] = finer = cut
        made.whole[number] = whole | cut[level.edges].all(axis=1)
    return made


def least_count(hierarchy: Hierarchy, is_wanted: Predicate) -> int:
    """Triangles if an edge's split needs no more than the triangles of its level beside it: RGB's law."""
    wanted = wanted_edges(hierarchy, is_wanted)
    total, finer = len(hierarchy.levels[0].faces), None
    for number in reversed(range(len(wanted))):
        level, cut = hierarchy.levels[number], wanted[number].copy()
        if finer is not None:
            halves = finer[: 2 * len(cut)].reshape(-1, 2)
            inner = finer[2 * len(cut) :].reshape(-1, 3)
            corner = np.zeros((len(level.faces), 3), bool)  # whether the child at a corner is needed
            for side in range(2):
                half_edges = level.halves[:, side]
                edge = np.flatnonzero(half_edges >= 0)
                face, k = np.divmod(half_edges[edge], 3)
                corner[face, k] |= halves[edge, side]
                corner[face, (k + 1) % 3] |= halves[edge, 1 - side]
            corner |= inner
            needed = corner | np.roll(corner, -1, axis=1) | inner.any(axis=1, keepdims=True)
            cut[level.edges[needed]] = True
        total += int(hierarchy.sides(number)[cut].sum())
        finer = cut
    return total
