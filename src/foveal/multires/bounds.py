"""A true bound of how far a simplified cell is from the original surface, both ways, for each of its faces.

The chain is e(coarse) = e(fine) + d(fine, coarse) (Cignoni et al. 2005), taken piece by piece rather than
as the sum of two maxima, which may stand at opposite ends of the cell. Nearly all of it comes from one
overlay of the two surfaces; what that leaves open is measured face by face, in each direction by itself.
"""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_closely as close_kernels
from . import _kernels_surface as surface_kernels
from . import _kernels_walk as walk_kernels
from .overlay import Surface, overlay
from .pieces import box
from .simplify import Simplified, twins

__all__ = ["deviation"]

_STACK = 64  # pieces of one triangle that may wait; beyond it cutting stops and the bound is looser

#: Room for the corners of a piece. Cutting ends at nine, and rounding may make a cut add one for each.
_CORNERS = 20

#: Pieces that may be measured closely. On the dragon one face in a thousand is suspicious; soups have many
#: more, for which time matters more than the last factor of two.
_LATER = 4096

#: A pair of points farther than this many times the typical distance (root mean square over the corners)
#: may be so because a walk led to a wrong sheet, so it is measured closely.
_SUSPICIOUS = 4.0

#: A corner this far beyond a wall, by the same measure, is no reason for a cut: slivers cost as much as
#: pieces, and being beside a face adds little to being above it (0.75 typical errors to 4: 2 %).
_SLACK = 0.75


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
    fine = Surface(positions, faces, coarse.twins)
    onto = Surface(coarse.positions, coarse.faces, twins(coarse.faces, len(coarse.positions)))
    start = np.full(len(faces), -1, np.int32)
    start[coarse.origin] = np.arange(len(coarse.faces), dtype=np.int32)
    if surface_kernels.spread(start, fine.twins, np.empty(len(faces), np.int32)) < len(faces):
        _start_of_vanished(positions, faces, coarse, start)
    out = np.zeros(len(coarse.faces))
    carried = errors.astype(np.float64)
    suspicious = max(_SUSPICIOUS * coarse.typical_error, 1.5)  # below a step or so nothing is worth a look
    is_open, is_open_onto = overlay(fine, onto, coarse.kept, start, carried, suspicious, out)
    _measure(fine, np.flatnonzero(is_open), onto, start, carried, False, suspicious, out)
    _measure(onto, np.flatnonzero(is_open_onto), fine, coarse.origin, carried, True, suspicious, out)
    # Rounding: positions are below 2^30 steps from the cell's middle, in doubles: a millionth is ample.
    rounded = (out * (1 + 1e-6) + 1e-6).astype(np.float32)
    return np.nextafter(rounded, np.float32(np.inf))


def _measure(
    source: Surface,
    which: NDArray[np.int64],
    target: Surface,
    start: NDArray[np.int32],
    carried: NDArray[np.float64],
    is_coarse_to_fine: bool,
    suspicious: float,
    out: NDArray[np.float64],
) -> None:
    """Raise `out` to bound the way from some faces of one surface to the other."""
    if len(which) == 0:
        return
    later, later_face = np.empty((_LATER, 3, 3)), np.empty(_LATER, np.int32)
    waiting = walk_kernels.measure(
        source.positions,
        source.faces,
        which,
        target.positions,
        target.faces,
        target.twins,
        start,
        carried,
        is_coarse_to_fine,
        suspicious,
        _SLACK / _SUSPICIOUS * suspicious,
        np.empty((_STACK, _CORNERS, 3)),
        np.empty((_STACK, 4), np.int32),
        np.empty((2, _CORNERS, 3)),
        np.empty(_CORNERS),
        out,
        later,
        later_face,
    )
    if waiting == 0:
        return
    close_kernels.measure_closely(
        later[:waiting],
        later_face[:waiting],
        target.positions,
        target.faces,
        *_boxes(target),
        start,
        carried,
        is_coarse_to_fine,
        suspicious,
        np.empty((64, 3, 3)),
        np.empty((64, 3), np.int64),
        np.empty((64, 3)),
        out,
    )


def _boxes(
    surface: Surface,
) -> tuple[NDArray[np.float64], float, NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]:
    """A grid of boxes over the surface, two edges wide, with the faces that meet each."""
    positions, faces = surface.positions, surface.faces
    low, high = box(positions)
    extent = np.maximum(high - low, 1e-6 * max(1.0, float((high - low).max())))
    a, b = positions[faces[::16, 0]], positions[faces[::16, 1]]
    edge = float(np.sqrt(((a - b) ** 2).sum(axis=1)).mean()) or 1.0
    width = max(2.0 * edge, float(extent.max()) / 256)
    size = np.minimum(256, np.ceil(extent / width)).astype(np.int64)
    boxes = int(size.prod())
    if boxes > 8 * len(faces) + 64:  # mostly empty: wider ones
        width *= (boxes / (8 * len(faces) + 64)) ** 0.5
        size = np.maximum(1, np.ceil(extent / width)).astype(np.int64)
        boxes = int(size.prod())
    counts, nothing = np.zeros(boxes + 1, np.int64), np.empty(0, np.int32)
    total = close_kernels.file_faces(positions, faces, low, 1 / width, size, counts, nothing, True)
    starts = np.zeros(boxes + 1, np.int64)
    np.cumsum(counts[:-1], out=starts[1:])
    refs = np.empty(total, np.int32)
    close_kernels.file_faces(positions, faces, low, 1 / width, size, starts[:-1].copy(), refs, False)
    return low, 1 / width, size, starts, refs


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
