"""Volume partitions: leaves of kD-trees no two of which, on levels that follow, share a boundary.

Based on: Ponchio, Dellepiane. Fast decompression for web-based view-dependent 3D rendering. Web3D 2015,
section 3.2.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _kernels_partition as kernels

__all__ = ["Partition", "partition"]


@dataclass(frozen=True, slots=True)
class Partition:
    """A kD-tree whose leaves are the cells 0 to `cells` - 1.

    Attributes
    ----------
    nodes : (n, 3) int32
        (axis, below, above): a node, or, where negative, the cell -1 - value.
    planes : (n,) float64
        In three times the unit of positions: centroids are sums of three corners here.
    cells : int
    """

    nodes: NDArray[np.int32]
    planes: NDArray[np.float64]
    cells: int

    def assign(self, positions: NDArray[np.int32], faces: NDArray[np.int32], /) -> NDArray[np.int32]:
        """The cell of each face, (m,)."""
        out = np.empty(len(faces), np.int32)
        kernels.assign(positions, faces, self.nodes, self.planes, out)
        return out


def partition(points: NDArray[np.float64], /, *, limit: float, level: int) -> Partition:
    """Split space such that no cell holds more than `limit` of the points.

    Parameters
    ----------
    points : (n, 3) float64
        Sums of the three corners of each triangle, or of a sample of the triangles (then `limit` is the
        share of the sample). Points that coincide cannot be parted, so a cell may hold more of them.
    level : int
        The split ratio begins with 0.4 on even and 0.6 on odd levels, so that no plane of one level is a
        plane of the next.

    Examples
    --------
    >>> line = np.zeros((10, 3)); line[:, 0] = range(10)
    >>> partition(line, limit=6, level=0).planes, partition(line, limit=6, level=1).planes
    (array([4.]), array([6.]))
    """
    points = np.ascontiguousarray(points, np.float64)
    most = max(1, 8 * int(len(points) / max(limit, 1.0)) + 8)
    nodes, planes = np.empty((most, 3), np.int32), np.empty(most)
    depth = 256
    used, cells = kernels.grow(
        points,
        np.arange(len(points), dtype=np.int64),
        limit,
        level % 2,
        points.min(axis=0),
        points.max(axis=0),
        nodes,
        planes,
        np.empty((depth, 4), np.int64),
        np.empty((depth, 2, 3)),
    )
    return Partition(nodes[:used].copy(), planes[:used].copy(), cells)
