"""A true bound of how far a simplified cell is from the original surface, both ways, for each of its faces.

The chain is e(coarse) = e(fine) + d(fine, coarse) (Cignoni et al. 2005), taken piece by piece rather than
as the sum of two maxima, which may stand at opposite ends of the cell.
"""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_bounds as kernels
from .pieces import box
from .simplify import Simplified, neighbours

__all__ = ["deviation"]

_STACK = 64  # pieces of one triangle that may wait; beyond it cutting stops and the bound is looser

#: Room for the corners of a piece. Cutting ends at nine, and rounding may make a cut add one for each.
_CORNERS = 20

#: Pieces that may be measured closely. On the dragon 1 % are suspicious; soups have many more, for which
#: time matters more than the last factor of two.
_LATER = 4096

#: A piece farther than this many times the typical distance (root mean square over the corners) may be
#: so because the walk led to a wrong sheet, so it is measured closely.
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
    fine_mesh, coarse_mesh = _Target(positions, faces, coarse.across), _Target(coarse.positions, coarse.faces)
    start = np.full(len(faces), -1, np.int32)
    start[coarse.origin] = np.arange(len(coarse.faces), dtype=np.int32)
    if kernels.spread(start, fine_mesh.across, np.empty(len(faces), np.int32)) < len(faces):
        _start_of_vanished(positions, faces, coarse, start)
    out = np.zeros(len(coarse.faces))
    carried = errors.astype(np.float64)
    suspicious = max(_SUSPICIOUS * coarse.typical_error, 1.5)  # below a step or so nothing is worth a look
    coarse_mesh.receive(fine_mesh, start, carried, False, suspicious, out)
    fine_mesh.receive(coarse_mesh, coarse.origin, carried, True, suspicious, out)
    # Rounding: positions are below 2^30 steps from the cell's middle, in doubles: a millionth is ample.
    rounded = (out * (1 + 1e-6) + 1e-6).astype(np.float32)
    return np.nextafter(rounded, np.float32(np.inf))


class _Target:
    """A mesh with what is needed to measure distances to it."""

    def __init__(
        self,
        positions: NDArray[np.float64],
        faces: NDArray[np.int32],
        across: NDArray[np.int32] | None = None,
    ) -> None:
        self.positions = positions
        self.faces = faces
        self.across = neighbours(faces, len(positions)) if across is None else across
        normals = np.empty((len(faces), 3))
        kernels.normals_of(positions, faces, self.across, normals)
        self.frames = np.empty((len(faces), 7, 4))
        kernels.frames_of(positions, faces, self.across, normals, self.frames)

    def receive(
        self,
        other: "_Target",
        start: NDArray[np.int32],
        carried: NDArray[np.float64],
        is_coarse_to_fine: bool,
        suspicious: float,
        out: NDArray[np.float64],
    ) -> None:
        """Raise `out` to bound the way from `other` to this mesh."""
        later, later_face = np.empty((_LATER, 3, 3)), np.empty(_LATER, np.int32)
        waiting = kernels.measure(
            other.positions,
            other.faces,
            self.positions,
            self.faces,
            self.across,
            self.frames,
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
        low, scale, size, starts, refs = self._boxes()
        kernels.measure_closely(
            later[:waiting],
            later_face[:waiting],
            self.positions,
            self.faces,
            self.frames,
            low,
            scale,
            size,
            starts,
            refs,
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
        self,
    ) -> tuple[NDArray[np.float64], float, NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]:
        """A grid of boxes over the mesh, about two for a face, with the faces that meet each."""
        low, high = box(self.positions)
        extent = np.maximum(high - low, 1e-6 * max(1.0, float((high - low).max())))
        a, b = self.positions[self.faces[::16, 0]], self.positions[self.faces[::16, 1]]
        edge = float(np.sqrt(((a - b) ** 2).sum(axis=1)).mean()) or 1.0
        width = max(edge, float(extent.max()) / 256)
        size = np.minimum(256, np.ceil(extent / width)).astype(np.int64)
        boxes = int(size.prod())
        if boxes > 8 * len(self.faces) + 64:  # mostly empty: wider ones
            width *= (boxes / (8 * len(self.faces) + 64)) ** 0.5
            size = np.maximum(1, np.ceil(extent / width)).astype(np.int64)
            boxes = int(size.prod())
        counts, nothing = np.zeros(boxes + 1, np.int64), np.empty(0, np.int32)
        total = kernels.file_faces(self.positions, self.faces, low, 1 / width, size, counts, nothing, True)
        starts = np.zeros(boxes + 1, np.int64)
        np.cumsum(counts[:-1], out=starts[1:])
        refs = np.empty(total, np.int32)
        kernels.file_faces(self.positions, self.faces, low, 1 / width, size, starts[:-1].copy(), refs, False)
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
