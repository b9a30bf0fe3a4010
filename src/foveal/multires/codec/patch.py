"""What the codec takes and gives: triangles over vertices on the global integer grid."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Patch"]


@dataclass(frozen=True, slots=True)
class Patch:
    """A piece of a surface, quantised.

    Any triangles: open, non-manifold, degenerate and duplicate ones, and vertices that share a position.

    Attributes
    ----------
    positions : (n, 3) int32
        On the grid of the whole file, each coordinate in [-2^30, 2^30).
    faces : (m, 3) int32
        Vertex indices in [0, n), counter-clockwise seen from outside.
    normals : (n, 2) int16 or None
        Octahedral, see `quantise_normals`.
    colours : (n, 3) uint8 or None
        sRGB.
    """

    positions: NDArray[np.int32]
    faces: NDArray[np.int32]
    normals: NDArray[np.int16] | None = None
    colours: NDArray[np.uint8] | None = None
