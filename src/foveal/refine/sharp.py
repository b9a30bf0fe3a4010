"""Which edges of a control mesh are sharp."""

import math

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh

__all__ = ["sharp_edges"]


def sharp_edges(mesh: TriMesh, angle: float, /) -> NDArray[np.int32]:
    """The edges at which a mesh bends by more than an angle, to be kept sharp by `Sqrt3`.

    Parameters
    ----------
    mesh : TriMesh
    angle : float
        In radians, from 0 to pi: between the normals of an edge's two faces. Folded flat they differ by pi.

    Returns
    -------
    (k, 2) int32
        Vertices in [0, n), the lesser first, in rising order. Edges of one face, or of more than two, are not
        among them, nor are those of a face without area.

    Raises
    ------
    ValueError
        If the angle is none.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch, tetrahedron
    >>> len(sharp_edges(tetrahedron(), 1.0)), len(sharp_edges(grid_patch(4), 1.0))
    (6, 0)
    """
    if not 0 <= angle <= math.pi:
        raise ValueError(f"angle must be from 0 to pi, got {angle}")
    faces = mesh.faces
    begin, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    edges = np.sort(np.stack([begin, end], axis=1), axis=1)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    is_new = np.ones(len(order) + 1, np.bool_)
    is_new[1:-1] = (edges[order][1:] != edges[order][:-1]).any(axis=1)
    first = np.flatnonzero(is_new)
    first = first[:-1][np.diff(first) == 2]  # edges of exactly two faces
    # Scaled to about 1, so that products of tiny and of huge coordinates stay within float64.
    scale = max(float(np.ptp(mesh.positions, axis=0).max(initial=0)), 1e-300) if len(faces) else 1.0
    a, b, c = (mesh.positions[faces[:, k]] / scale for k in range(3))
    normals = np.cross(b - a, c - a)
    one, two = normals[order[first] // 3], normals[order[first + 1] // 3]
    across = np.linalg.norm(np.cross(one, two), axis=1)
    bends = np.arctan2(across, (one * two).sum(axis=1))  # 0 where one is zero
    found: NDArray[np.int32] = edges[order[first]][bends > angle].astype(np.int32)
    return found
