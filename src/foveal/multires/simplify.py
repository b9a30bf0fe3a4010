"""One cell's triangles, halved: quadric edge collapse with locked vertices."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _kernels_simplify as kernels

__all__ = ["Simplified", "incidence", "neighbours", "simplify"]

#: Weight of the wall that holds an open border in place, relative to a face, both by length.
BORDER_WEIGHT = 4.0

#: Strict passes over all edges. What a pass refused may be fine after its neighbours have moved; on the
#: dragon the second pass gives 2 % more, a third nothing.
PASSES = 3


@dataclass(frozen=True, slots=True)
class Simplified:
    """What is left of a cell, in indices of what it was.

    Attributes
    ----------
    positions : (n', 3) float64
    attributes : (n', k) float32
    faces : (m', 3) int32
    kept : (n',) int32
        Which vertex of the input each vertex was.
    origin : (m',) int32
        Which face of the input each face was.
    is_relaxed : bool
        Whether topology had to be given up to come down to the size asked for.
    typical_error : float
        Root of the largest mean squared distance that a collapse was let in for: a scale, not a bound.
    across : (m, 3) int32
        Of the input, see `neighbours`.
    """

    positions: NDArray[np.float64]
    attributes: NDArray[np.float32]
    faces: NDArray[np.int32]
    kept: NDArray[np.int32]
    origin: NDArray[np.int32]
    is_relaxed: bool
    typical_error: float
    across: NDArray[np.int32]


def incidence(
    faces: NDArray[np.int32], count: int, /
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Faces around each of `count` vertices: (starts, counts, refs)."""
    starts, counts = np.empty(count, np.int32), np.empty(count, np.int32)
    refs = np.empty(3 * len(faces), np.int32)
    kernels.incidence(faces, starts, counts, refs)
    return starts, counts, refs


def neighbours(faces: NDArray[np.int32], count: int, /) -> NDArray[np.int32]:
    """(m, 3): the face across each edge (k, k + 1) of each face, -1 where there is none."""
    across, is_border = np.empty((len(faces), 3), np.int32), np.empty(count, np.bool_)
    kernels.neighbours(faces, *incidence(faces, count), across, is_border)
    return across


def simplify(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    locked: NDArray[np.bool_],
    /,
    *,
    target: int,
    relaxed_above: int,
    attributes: NDArray[np.float32] | None = None,
    snap: float = 1.0,
) -> Simplified:
    """Collapse edges until `target` faces are left, or none can be without harm.

    Parameters
    ----------
    positions : (n, 3) float64
        In steps of the grid, near the origin.
    faces : (m, 3) int32
        Any triangles; a vertex may be in none.
    locked : (n,) bool
        Vertices that neither move nor vanish.
    target : int
        Faces wanted. Closed stays closed, topology stays, no face turns over.
    relaxed_above : int
        Should more faces than this be left then, topology is given up to reach `target`: handles close,
        small pieces vanish. Locked vertices stay all the same, so even this may not be reached.
    attributes : (n, k) float32, optional
        Blended along the edges that vanish.
    snap : float
        New vertices lie on multiples of it.

    Based on: Garland, Heckbert. Surface simplification using quadric error metrics. SIGGRAPH 1997.

    Examples
    --------
    >>> grid = np.array([[x, y, 0] for y in range(3) for x in range(3)], float)
    >>> quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
    >>> faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]).astype(np.int32)
    >>> len(simplify(grid, faces, np.zeros(9, bool), target=4, relaxed_above=8).faces) <= 4
    True
    """
    count, size = len(positions), len(faces)
    positions, faces = positions.copy(), faces.copy()
    attributes = np.empty((count, 0), np.float32) if attributes is None else attributes.copy()
    starts, counts, first = incidence(faces, count)
    # Twice the lists' length, since each collapse writes a new list at the end.
    refs, fresh = np.empty(2 * len(first) + 256, np.int32), np.empty(len(first) + 16, np.int32)
    refs[: len(first)] = first
    across, is_border = np.empty((size, 3), np.int32), np.empty(count, np.bool_)
    kernels.neighbours(faces, starts, counts, first, across, is_border)
    quadrics = np.empty((count, 11))
    kernels.face_quadrics(positions, faces, across, BORDER_WEIGHT, quadrics)
    alive, valence = np.ones(size, np.bool_), counts.copy()
    versions, marks = np.zeros(count, np.int32), np.zeros(count, np.int64)
    slots, heap = np.empty((8 * size + 1024, 3), np.int32), np.empty(8 * size + 1024, np.int64)
    sizes, worst = np.zeros(2, np.int64), np.zeros(1)
    live, end, stamp = size, len(first), 2
    is_relaxed, is_strict, passes = False, True, 0
    while live > target:
        kernels.offer_all(
            positions, faces, alive, across, quadrics, locked, snap, versions, slots, heap, sizes, is_strict
        )
        before = live
        live, end, stamp = kernels.collapse(
            positions,
            faces,
            alive,
            starts,
            counts,
            refs,
            fresh,
            end,
            valence,
            is_border,
            quadrics,
            attributes,
            locked,
            snap,
            versions,
            slots,
            heap,
            sizes,
            marks,
            worst,
            stamp,
            live,
            target,
            is_strict,
        )
        passes += 1
        # The queue was thrown away because its slots ran out: no reason to give up.
        is_cut_short = sizes[0] > 0
        if is_strict and not is_cut_short and (passes >= PASSES or before - live < size // 100):
            if live <= relaxed_above:
                break
            is_strict, is_relaxed = False, True
        elif not is_strict and before == live:
            break
    return _gather(positions, attributes, faces, alive, is_relaxed, float(worst[0]) ** 0.5, across)


def _gather(
    positions: NDArray[np.float64],
    attributes: NDArray[np.float32],
    faces: NDArray[np.int32],
    alive: NDArray[np.bool_],
    is_relaxed: bool,
    typical_error: float,
    across: NDArray[np.int32],
) -> Simplified:
    origin = np.flatnonzero(alive).astype(np.int32)
    if is_relaxed and len(origin):
        origin = origin[_without_copies(faces[origin])]
    left = faces[origin]
    used = np.zeros(len(positions), np.bool_)
    used[left] = True
    kept = np.flatnonzero(used).astype(np.int32)
    index = np.cumsum(used, dtype=np.int32) - 1
    return Simplified(
        positions[kept],
        attributes[kept],
        index[left].astype(np.int32),
        kept,
        origin,
        is_relaxed,
        typical_error,
        across,
    )


def _without_copies(faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Which faces to keep of those with the same three corners.

    Two in opposite order cancel out. Of those left one is kept if they are odd in number, two if even, so
    that the number of faces on an edge stays odd or even. If nothing were left the first two are kept: a
    cell never becomes empty.
    """
    a, b, c = faces.T
    sign = np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1, -1)
    _, group = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True)
    group = group.reshape(-1)
    excess = np.zeros(group.max() + 1, np.int64)
    np.add.at(excess, group, sign)
    wanted = np.where(excess == 0, 0, 2 - excess % 2)
    # The place of each face among those of its group that have the majority's sign.
    is_major = sign == np.sign(excess)[group]
    order = np.lexsort((np.arange(len(faces)), ~is_major, group))
    begin = np.searchsorted(group[order], np.arange(len(excess)))
    place = np.empty(len(faces), np.int64)
    place[order] = np.arange(len(faces)) - begin[group[order]]
    keep: NDArray[np.bool_] = is_major & (place < wanted[group])
    if not keep.any():
        keep[:2] = True
    return keep
