"""Normals of vertices, from the triangles around them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _kernels
from .trimesh import TriMesh

__all__ = ["unit_normals", "vertex_normals"]


def vertex_normals(mesh: TriMesh, /) -> NDArray[np.float32]:
    """(n, 3) float32: the area-weighted mean of the triangles' normals, unit length.

    Zero where there is none: at unused vertices, and where the triangles have no area or cancel.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch
    >>> vertex_normals(grid_patch(1))[0]
    array([0., 0., 1.], dtype=float32)
    """
    # Scaled to about 1 first, so that squares of tiny and of huge coordinates stay within float64.
    positions = mesh.positions - (mesh.positions[0] if len(mesh.positions) else 0)
    positions /= max(float(np.abs(positions).max(initial=0)), 1e-300)
    sums = np.zeros(mesh.positions.shape)
    _kernels.add_face_normals(positions, mesh.faces, sums)
    return unit_normals(sums)


def unit_normals(normals: NDArray[np.floating[Any]], /) -> NDArray[np.float32]:
    """(k, 3) float32 of unit length; what has no direction, or is not finite, becomes zero.

    Examples
    --------
    >>> unit_normals(np.array([[0, 0, 2.0], [0, 0, 0], [np.nan, 0, 1]]))
    array([[0., 0., 1.],
           [0., 0., 0.],
           [0., 0., 0.]], dtype=float32)
    """
    wide = np.where(np.isfinite(normals).all(axis=1, keepdims=True), normals, 0).astype(np.float64)
    largest = np.abs(wide).max(axis=1, keepdims=True, initial=0)
    wide /= np.where(largest > 0, largest, 1)  # so that no square under- or overflows
    length = np.linalg.norm(wide, axis=1, keepdims=True)
    return (wide / np.where(length > 0, length, 1)).astype(np.float32)
