"""Samples of a picture in the light of a scene, by `spec/shading.md`."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from . import _kernels_lit as kernels
from .rasterise import BAND_ROWS, Screen

__all__ = ["SceneLight", "lit_band"]

Floats = NDArray[np.float64]


class SceneLight(Protocol):
    """A light of the world; `raster` knows nothing of shadows."""

    def __call__(
        self, points: Floats, normals: Floats, spans: Floats, /
    ) -> tuple[Floats, NDArray[np.float32]]:
        """(n, 3) unit vectors to the light, and (n,) shares of it that arrive, of points of surfaces.

        Parameters
        ----------
        points : (n, 3) float64
        normals : (n, 3) float64
            The triangles' own, unit, on the eye's side.
        spans : (n, 2, 3) float64
            Along the surface to where the next samples to the right and above look.
        """
        ...


def lit_band(
    screen: Screen, band: int, face_ids: NDArray[np.int32], light: SceneLight, lift_px: float, /
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Directions to the light in the camera's frame, and how much of it arrives, for `shade_band`.

    Parameters
    ----------
    face_ids : (rows, width) int32
        As `screen.draw` gives them.
    lift_px : float
        How many samples' widths before the surface the light is asked for.

    Returns
    -------
    (rows, width, 3) float32, (rows, width) float32
        0 where there is no face.
    """
    is_seen = face_ids >= 0
    count = int(is_seen.sum())
    points, normals, spans = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 2, 3))
    camera = screen.camera
    basis = camera.basis()
    kernels.surface(
        *(face_ids, band * BAND_ROWS, screen.faces, screen.seen, screen.lens, camera.position, basis),
        *(lift_px, points, normals, spans),
    )
    keys = np.zeros((*face_ids.shape, 3), np.float32)
    shares = np.zeros(face_ids.shape, np.float32)
    if count:
        towards, arrives = light(points, normals, spans)
        keys[is_seen] = towards @ basis.T
        shares[is_seen] = arrives
    return keys, shares
