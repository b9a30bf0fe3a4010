"""Normals as pairs of small integers on an octahedron, and their prediction from geometry.

Based on: Cigolle et al. A survey of efficient representations for independent unit vectors. JCGT, 2014.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _kernels_geometry

__all__ = ["dequantise_normals", "predicted_normals", "quantise_normals"]


def quantise_normals(normals: ArrayLike, /, *, bits: int = 10) -> NDArray[np.int16]:
    """Octahedral coordinates of unit vectors.

    Parameters
    ----------
    normals : (n, 3) float
        Of any length; zero or not finite means that there is none.
    bits : int
        Of each coordinate, 4 to 14.

    Returns
    -------
    (n, 2) int16
        In [-k, k] with k = 2^(bits - 1) - 1, or (-k - 1, -k - 1) where there is no normal.

    Examples
    --------
    >>> quantise_normals([[0, 0, 1], [1, 0, 0], [0, 0, -1], [0, 0, 0]], bits=10)
    array([[   0,    0],
           [ 511,    0],
           [ 511,  511],
           [-512, -512]], dtype=int16)
    """
    if not 4 <= bits <= 14:
        raise ValueError(f"bits must be 4 to 14, got {bits}")
    vectors = np.asarray(normals, dtype=np.float64).reshape(-1, 3)
    most = (1 << (bits - 1)) - 1
    with np.errstate(invalid="ignore", over="ignore", divide="ignore"):
        flat = vectors / np.abs(vectors).sum(axis=1, keepdims=True)
        xy = flat[:, :2]
        folded = (1.0 - np.abs(xy[:, ::-1])) * np.where(xy < 0, -1.0, 1.0)
        xy = np.where(flat[:, 2:] < 0, folded, xy)
        whole: NDArray[np.int16] = np.rint(np.nan_to_num(xy * most)).clip(-most, most).astype(np.int16)
    whole[~np.isfinite(flat).all(axis=1)] = -most - 1
    return whole


def dequantise_normals(octahedral: ArrayLike, /, *, bits: int = 10) -> NDArray[np.float32]:
    """Unit vectors, (n, 3) float32, of octahedral pairs; zero where there is no normal.

    Examples
    --------
    >>> dequantise_normals([[0, 0], [511, 0], [-512, -512]], bits=10)
    array([[0., 0., 1.],
           [1., 0., 0.],
           [0., 0., 0.]], dtype=float32)
    """
    if not 4 <= bits <= 14:
        raise ValueError(f"bits must be 4 to 14, got {bits}")
    most = (1 << (bits - 1)) - 1
    whole = np.asarray(octahedral).reshape(-1, 2)
    xy = whole.astype(np.float64) / most
    z = 1.0 - np.abs(xy).sum(axis=1)
    folded = (1.0 - np.abs(xy[:, ::-1])) * np.where(xy < 0, -1.0, 1.0)
    xy = np.where(z[:, None] < 0, folded, xy)
    vectors = np.column_stack([xy, z])
    vectors /= np.linalg.norm(vectors, axis=1, keepdims=True)
    vectors[(whole < -most).all(axis=1)] = 0.0
    return vectors.astype(np.float32)


def predicted_normals(
    positions: NDArray[np.int32], faces: NDArray[np.int32], /, *, bits: int = 10
) -> NDArray[np.int16]:
    """The normals which the decoder expects of this geometry: area-weighted, octahedral.

    Parameters
    ----------
    positions : (n, 3) int32
        On the grid.
    faces : (m, 3) int32
        Indices in [0, n).

    Returns
    -------
    (n, 2) int16
        As from `quantise_normals`, in integer arithmetic: the same in every language. A builder that has no
        better ones stores these; where a patch holds all of a vertex's triangles they cost next to nothing.
    """
    if not 4 <= bits <= 14:
        raise ValueError(f"bits must be 4 to 14, got {bits}")
    points = np.ascontiguousarray(positions, np.int32)
    sums = np.empty((len(points), 3), np.int64)
    _kernels_geometry.vertex_normals(points, np.ascontiguousarray(faces, np.int32), sums)
    out = np.empty((len(points), 2), np.int16)
    _kernels_geometry.predicted_octahedral(sums, (1 << (bits - 1)) - 1, out)
    return out
