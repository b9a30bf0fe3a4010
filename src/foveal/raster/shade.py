"""The colour of what is seen, by the one page that the viewer obeys too: `spec/shading.md`.

The light hangs on the camera; sRGB bytes are decoded to linear values and encoded at the end, with
tables, so that the loops need no powers; there is no tone mapping.
"""

from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _kernels_shade as kernels
from .rasterise import BAND_ROWS, Screen

__all__ = ["PLASTER", "decode_srgb", "encode_srgb", "shade_band", "tables"]

PLASTER = (214, 208, 198)
"""sRGB of a surface without colours."""


def decode_srgb(values: ArrayLike, /) -> NDArray[np.float64]:
    """Linear value of an sRGB value, both from 0 to 1 (IEC 61966-2-1).

    Examples
    --------
    >>> decode_srgb([0.0, 0.5, 1.0]).round(3)
    array([0.   , 0.214, 1.   ])
    """
    c = np.asarray(values, dtype=np.float64)
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def encode_srgb(values: ArrayLike, /) -> NDArray[np.float64]:
    """sRGB value of a linear value, both from 0 to 1: the inverse of `decode_srgb`."""
    x = np.asarray(values, dtype=np.float64)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


@cache
def tables() -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
    """(256,) linear values of bytes, and (4096,) bytes of squares of even steps of a linear value's root.

    Over the root sRGB is so nearly even that 4096 entries never miss by more than one byte, and by
    none but beside a rounding edge; over the value itself the dark end would need 13 times as many.
    """
    roots = np.arange(kernels.ENCODE_STEPS + 1) / kernels.ENCODE_STEPS
    encode = np.floor(255 * encode_srgb(roots * roots) + 0.5).astype(np.uint8)
    return decode_srgb(np.arange(256) / 255), encode


def shade_band(
    screen: Screen,
    band: int,
    face_ids: NDArray[np.int32],
    /,
    *,
    normals: NDArray[np.float32] | None,
    colours: NDArray[np.uint8] | None,
    plain: tuple[int, int, int] = PLASTER,
    keys: NDArray[np.float32] | None = None,
    shadows: NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """Linear colours of a band of a screen.

    Parameters
    ----------
    face_ids : (rows, width) int32
        As `screen.draw` gives them.
    normals, colours : (n, 3), optional
        Of the vertices. Without normals faces are flat, without colours all is `plain`.
    keys : (rows, width, 3) float32, optional
        Unit vectors from samples to the light, in the camera's frame; by default it hangs on the camera.
    shadows : (rows, width) float32, optional
        How much of the key light arrives at each sample, 0 to 1.

    Returns
    -------
    (rows, width, 3) float32
        From 0 to 1; 0 where there is no face.
    """
    linear = np.empty((*face_ids.shape, 3), dtype=np.float32)
    kernels.shade(
        *(face_ids, screen.weigh(band, face_ids), band * BAND_ROWS, screen.faces, screen.seen),
        np.empty((0, 3), dtype=np.float32) if normals is None else normals,
        np.empty((0, 3), dtype=np.uint8) if colours is None else colours,
        np.array(plain, dtype=np.float64),
        *(screen.camera.basis(), screen.lens),
        np.empty((0, 0, 3), dtype=np.float32) if keys is None else keys,
        np.empty((0, 0), dtype=np.float32) if shadows is None else shadows,
        *(tables()[0], linear),
    )
    return linear
