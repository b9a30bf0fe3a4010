"""The faces that matter for a view: in the vision frustum, facing the eye, along the silhouette.

Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
√3-subdivision, section 6.1.
"""

import numpy as np
from numpy.typing import NDArray

from foveal.view.camera import Camera

from . import _kernels_extract as kernels
from .criteria import view_of

__all__ = ["front_faces", "frustum_faces", "silhouette_faces"]


def frustum_faces(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    camera: Camera,
    /,
    *,
    among: NDArray[np.int32] | None = None,
) -> NDArray[np.int32]:
    """Faces that may be seen: not all of whose corners are outside one plane of the frustum.

    The paper takes faces with a corner in the frustum, and so misses the one that fills the whole view.

    Parameters
    ----------
    positions : (n, 3) float64
    faces : (m, 3) int32
        Vertices in [0, n).
    camera : Camera
        In the space of the positions: of a placed model move the camera, inversely.
    among : (k,) int32, optional
        Search only these faces, in [0, m).

    Returns
    -------
    (j,) int32
        In the order of `among`.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch
    >>> mesh, camera = grid_patch(8), Camera.of([0.1, 0.1, 0.2], [0.1, 0.1, 0])
    >>> len(frustum_faces(mesh.positions, mesh.faces, camera)), len(mesh.faces)
    (8, 128)
    """
    found = _all_or(among, len(faces))
    flags = np.zeros(len(faces), np.uint8)
    return found[: kernels.keep_inside(positions, faces, flags, view_of(camera), found)]


def front_faces(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    camera: Camera,
    /,
    *,
    among: NDArray[np.int32] | None = None,
) -> NDArray[np.int32]:
    """Faces that have the camera on their outer side; parameters as for `frustum_faces`.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> mesh = tetrahedron()
    >>> front_faces(mesh.positions, mesh.faces, Camera.of([3, 3, 3], [0, 0, 0])).tolist()
    [0, 1, 2]
    """
    found = _all_or(among, len(faces))
    flags = np.zeros(len(faces), np.uint8)
    kernels.face_the_eye(positions, faces, flags, view_of(camera), found)
    is_front: NDArray[np.bool_] = (flags[found] & kernels.FRONT) != 0
    return found[is_front]


def silhouette_faces(
    positions: NDArray[np.float64],
    faces: NDArray[np.int32],
    beside: NDArray[np.int32],
    camera: Camera,
    /,
    *,
    among: NDArray[np.int32] | None = None,
) -> NDArray[np.int32]:
    """Strips of faces around the ends of silhouette edges, those between a front and a back face.

    Parameters
    ----------
    positions, faces, camera
        As for `frustum_faces`; the mesh is an oriented surface.
    beside : (m, 3) int32
        The face beyond the edge from corner k to k + 1, or a negative number, as in `Cage`.
    among : (k,) int32, optional
        Search only the silhouette edges of these faces. What is found may be outside them.

    Returns
    -------
    (j,) int32
        Each once, in no particular order.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> from foveal.refine.cage import Cage
    >>> cage = Cage.of(tetrahedron())
    >>> camera = Camera.of([3, 3, 3], [0, 0, 0])
    >>> sorted(silhouette_faces(cage.positions, cage.faces, cage.beside, camera).tolist())
    [0, 1, 2, 3]
    """
    seeds = _all_or(among, len(faces))
    flags = np.zeros(len(faces), np.uint8)
    marks = np.zeros(len(positions), np.uint8)
    view, found = view_of(camera), np.empty(len(faces), np.int32)
    kernels.face_the_eye(positions, faces, flags, view, seeds)
    return found[: kernels.strips(positions, faces, beside, flags, marks, view, seeds, found)].copy()


def _all_or(among: NDArray[np.int32] | None, count: int) -> NDArray[np.int32]:
    """A copy of what is to be searched."""
    return np.arange(count, dtype=np.int32) if among is None else np.array(among, np.int32)
