"""A true bound of how far a simplified cell is from the original surface, both ways, for each of its faces.

The chain is e(coarse) = e(fine) + d(fine, coarse) (Cignoni et al. 2005), taken piece by piece rather than as
two maxima, which on the dragon halves the sum.
"""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_bounds as kernels
from . import _kernels_simplify as topology
from .simplify import Simplified, incidence

__all__ = ["deviation"]

_STACK = 64  # pieces of one triangle that may wait; beyond it cutting stops and the bound is looser


def deviation(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    errors: NDArray[np.float32],
    coarse: Simplified,
    /,
) -> NDArray[np.float32]:
    """Bounds of the faces of `coarse` against the original surface.

    Parameters
    ----------
    positions, faces
        What `coarse` was made from.
    errors : (m,) float32
        For each of `faces` an upper bound of how far its points are from the original surface, and of
        how far the points of the original are that have their image on it.
    coarse : Simplified

    Returns
    -------
    (m',) float32
        The same of the faces of `coarse`, rounded up.
    """
    across = _across(positions, faces)
    coarse_across = _across(coarse.positions, coarse.faces)
    start = np.full(len(faces), -1, np.int32)
    start[coarse.origin] = np.arange(len(coarse.faces), dtype=np.int32)
    if kernels.spread(start, across, np.empty(len(faces), np.int32)) < len(faces):
        _start_of_vanished(positions, faces, coarse, start)
    out = np.zeros(len(coarse.faces))
    carried = errors.astype(np.float64)
    scratch = (
        np.empty((_STACK, 12, 3)),
        np.empty((_STACK, 4), np.int32),
        np.empty((2, 12, 3)),
        np.empty(12),
        out,
    )
    kernels.measure(
        positions,
        faces,
        coarse.positions,
        coarse.faces,
        coarse_across,
        _walls(coarse.positions, coarse.faces, coarse_across),
        start,
        carried,
        False,
        *scratch,
    )
    kernels.measure(
        coarse.positions,
        coarse.faces,
        positions,
        faces,
        across,
        _walls(positions, faces, across),
        coarse.origin,
        carried,
        True,
        *scratch,
    )
    # Rounding: positions below 2^21 steps from the cell's middle, double arithmetic: 1e-9 is ample.
    rounded = (out * (1 + 1e-6) + 1e-6).astype(np.float32)
    return np.nextafter(rounded, np.float32(np.inf))


def _across(positions: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.int32]:
    starts, counts, refs = incidence(faces, len(positions))
    out = np.empty((len(faces), 3), np.int32)
    topology.neighbours(faces, starts, counts, refs, out, np.empty(len(positions), np.bool_))
    return out


def _walls(
    positions: NDArray[np.float64], faces: NDArray[np.int32], across: NDArray[np.int32]
) -> NDArray[np.float64]:
    normals = np.empty((len(faces), 3))
    kernels.normals_of(positions, faces, across, normals)
    walls = np.empty((len(faces), 3, 4))
    kernels.walls_of(positions, faces, across, normals, walls)
    return walls


def _start_of_vanished(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    coarse: Simplified,
    start: NDArray[np.int32],
) -> None:
    """For pieces that vanished altogether: the coarse face whose middle is nearest to theirs."""
    from scipy.spatial import KDTree

    lost = np.flatnonzero(start < 0)
    middles = coarse.positions[coarse.faces].mean(axis=1)
    start[lost] = KDTree(middles).query(positions[faces[lost]].mean(axis=1))[1]
