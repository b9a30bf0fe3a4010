"""One cell's triangles, halved: quadric edge collapse with locked vertices."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _kernels_collapse as kernels
from . import _kernels_quadrics as quadric_kernels
from . import _kernels_surface as surface_kernels

__all__ = ["Simplified", "incidence", "simplify", "twins"]

#: Weight of the wall that holds an open border in place, relative to a face, both by length.
BORDER_WEIGHT = 4.0

#: Strict passes over all edges: what one refused may be fine after its neighbours have moved. All cells of
#: the dragon come to a half in the first.
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
    twins : (m, 3) int32
        Of the input, see `twins`.
    """

    positions: NDArray[np.float64]
    attributes: NDArray[np.float32]
    faces: NDArray[np.int32]
    kept: NDArray[np.int32]
    origin: NDArray[np.int32]
    is_relaxed: bool
    typical_error: float
    twins: NDArray[np.int32]


def incidence(
    faces: NDArray[np.int32], count: int, /
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Faces around each of `count` vertices: (starts, counts, refs)."""
    starts, counts = np.empty(count, np.int32), np.empty(count, np.int32)
    refs = np.empty(3 * len(faces), np.int32)
    surface_kernels.incidence(faces, starts, counts, refs)
    return starts, counts, refs


def twins(faces: NDArray[np.int32], count: int, /) -> NDArray[np.int32]:
    """(m, 3): for the half-edge from corner k to k + 1 of each face the one beside it, 3 face + corner.

    Twins are pairs, also where more than two faces meet. -1 where no other face is, -2 where all others
    have twins already.
    """
    out = np.empty((len(faces), 3), np.int32)
    surface_kernels.twins_of(faces, *incidence(faces, count), out)
    return out


def simplify(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    locked: NDArray[np.bool_],
    /,
    *,
    target: int,
    relaxed_above: int,
    attributes: NDArray[np.float32] | None = None,
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
    beside, is_border = np.empty((size, 3), np.int32), np.empty(count, np.bool_)
    surface_kernels.twins_of(faces, starts, counts, first, beside)
    quadric_kernels.mark_border(faces, beside, is_border)
    quadrics = np.empty((count, 11))
    quadric_kernels.face_quadrics(positions, faces, beside, BORDER_WEIGHT, quadrics)
    alive, valence = np.ones(size, np.bool_), counts.copy()
    versions, into = np.zeros(count, np.int32), np.arange(count, dtype=np.int32)
    marks, worst = np.zeros(count, np.int64), np.zeros(1)
    slots, heap = np.empty((3 * size, 3), np.int32), np.empty(3 * size, np.int64)
    live, end, stamp = size, len(first), 2
    is_relaxed, is_strict, passes = False, True, 0
    while live > target:
        queued = kernels.offer_all(
            positions, faces, alive, beside, quadrics, locked, versions, slots, heap, is_strict
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
            versions,
            into,
            slots,
            heap,
            queued,
            marks,
            worst,
            stamp,
            live,
            target,
            is_strict,
        )
        passes += 1
        if is_strict and (passes >= PASSES or before - live < size // 100):
            if live <= relaxed_above:
                break
            is_strict, is_relaxed = False, True
        elif not is_strict and before == live:
            break
    return _gather(positions, attributes, faces, alive, is_relaxed, float(worst[0]) ** 0.5, beside)


def _gather(
    positions: NDArray[np.float64],
    attributes: NDArray[np.float32],
    faces: NDArray[np.int32],
    alive: NDArray[np.bool_],
    is_relaxed: bool,
    typical_error: float,
    beside: NDArray[np.int32],
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
        beside,
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
