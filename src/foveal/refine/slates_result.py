"""What a tessellation gives: a report of each update, and the arrays."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["SlateArrays", "Tessellated"]


@dataclass(frozen=True, slots=True)
class Tessellated:
    """What an update did.

    Attributes
    ----------
    triangles : int
        Shown now, of all placements.
    patches : int
        Whose points were computed.
    renewed : int
        Patches of placements whose triangles were written anew.
    deepest : int
        The largest depth shown.
    is_capped : bool
        Whether the budget left patches coarser than the rules have them.
    """

    triangles: int
    patches: int
    renewed: int
    deepest: int
    is_capped: bool = False


class SlateArrays(NamedTuple):
    """What is shown, where it lies; views of the arrays themselves, good until the next update.

    Attributes
    ----------
    positions, normals : (v, 3) float64 or float32
        Limit points, in the space of the control mesh. Rows stay where they are while their patch does not
        become deeper. Rows in no triangle mean nothing.
    faces : (f, 3) int32
        Triangles of rows, counter-clockwise; (0, 0, 0) where there is none.
    first, counts : (k, m) int64
        Rows of `faces` that belong to each patch of each placement.
    depths : (k, m) int8
        -1 for holes.
    patch_faces : (m,) int64
        Which face of the control mesh a patch is of.
    columns : list of (v, 3)
        Attributes by three: colours, then uvs and a column of zeros, those there are.
    levels : (l,) uint8
        The depth of the patch that a row of `faces` belongs to, 0 where there is none; l is f, rounded up to
        a multiple of 4.
    """

    positions: NDArray[Any]
    normals: NDArray[Any]
    faces: NDArray[np.int32]
    first: NDArray[np.int64]
    counts: NDArray[np.int64]
    depths: NDArray[np.int8]
    patch_faces: NDArray[np.int64]
    columns: list[NDArray[Any]]
    levels: NDArray[np.uint8]
