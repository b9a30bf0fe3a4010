"""How large an error looks, and what the camera can see at all: the two questions of view dependence.

Both answer for bounding spheres and err on the safe side: an error is measured at the point of the
sphere nearest to the eye, and a sphere counts as seen unless one plane has all of it outside.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .camera import Camera

__all__ = ["screen_error", "sphere_in_frustum"]


def screen_error(
    error: ArrayLike, centre: ArrayLike, radius: ArrayLike, camera: Camera, /
) -> NDArray[np.float64]:
    """Size in pixels of a geometric error somewhere in a sphere, at its nearest to the eye.

    Parameters
    ----------
    error, radius : (n,) float or one number
        In the unit of the scene, at least 0. An error may be infinite.
    centre : (n, 3) or (3,) float
        Centres of the spheres.
    camera : Camera
        Nothing nearer than its near plane is drawn, so no distance counts as less than that.

    Returns
    -------
    (n,) float64
        Infinite where the eye is inside the sphere, but 0 for an error of 0. To first order, and at
        the middle of the view: near the corners of a wide view perspective stretches lengths further.

    References
    ----------
    Cignoni, P. et al. (2005). Batched multi triangulation. IEEE Visualization, section 4.

    Examples
    --------
    >>> from foveal.view.camera import Camera
    >>> camera = Camera.of([0, 0, 10], [0, 0, 0], field_of_view=np.pi / 2, height=200)
    >>> screen_error(0.5, [0, 0, 0], 5, camera)  # 100 pixels a radian, 5 from the sphere
    array(10.)
    """
    error, radius = np.asarray(error, dtype=np.float64), np.asarray(radius, dtype=np.float64)
    to_eye = np.asarray(centre, dtype=np.float64) - camera.position
    x, y, z = to_eye[..., 0], to_eye[..., 1], to_eye[..., 2]
    distance = np.sqrt(x * x + y * y + z * z) - radius
    pixels = camera.pixels_per_radian() * error / np.maximum(distance, camera.near)
    return np.where((distance <= 0) & (error > 0), np.inf, pixels)


def sphere_in_frustum(
    centre: ArrayLike, radius: ArrayLike, planes: NDArray[np.float64], /
) -> NDArray[np.bool_]:
    """Whether spheres may be seen: False only where one plane has a whole sphere outside.

    Parameters
    ----------
    centre, radius : (n, 3) float, (n,) float, or one sphere
    planes : (k, 4) float64
        As `Camera.frustum` gives them: unit normals that point inwards, and offsets.

    Returns
    -------
    (n,) bool
        A sphere beside an edge of the frustum may count as seen although it is not.

    Examples
    --------
    >>> from foveal.view.camera import Camera
    >>> camera = Camera.of([0, 0, 10], [0, 0, 0])
    >>> sphere_in_frustum([[0, 0, 0], [0, 0, 12]], [1, 1], camera.frustum())
    array([ True, False])
    """
    centre, radius = np.asarray(centre, dtype=np.float64), np.asarray(radius, dtype=np.float64)
    x, y, z = centre[..., 0], centre[..., 1], centre[..., 2]
    seen = np.ones(np.broadcast_shapes(x.shape, radius.shape), dtype=np.bool_)
    for nx, ny, nz, offset in planes:
        seen &= nx * x + ny * y + nz * z + offset >= -radius
    return seen
