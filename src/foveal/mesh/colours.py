"""sRGB bytes and linear light, by the formulas of IEC 61966-2-1."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["linear_of_srgb", "srgb_of_linear"]

_CODES = np.arange(256) / 255
_LINEAR = np.where(_CODES <= 0.04045, _CODES / 12.92, ((_CODES + 0.055) / 1.055) ** 2.4)


def linear_of_srgb(colours: NDArray[np.uint8], /) -> NDArray[np.float64]:
    """Linear light, 0 to 1, of sRGB bytes of any shape."""
    result: NDArray[np.float64] = _LINEAR[colours]
    return result


def srgb_of_linear(light: NDArray[np.floating[Any]], /) -> NDArray[np.uint8]:
    """sRGB bytes of linear light; what is outside 0 to 1 is clipped, what is no number becomes 0.

    Examples
    --------
    >>> srgb_of_linear(np.array([0.0, 0.5, 1.0, 7.0]))
    array([  0, 188, 255, 255], dtype=uint8)
    >>> bool((srgb_of_linear(linear_of_srgb(np.arange(256, dtype=np.uint8))) == np.arange(256)).all())
    True
    """
    x = np.clip(np.nan_to_num(light, nan=0.0), 0, 1)
    codes = np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 0.0031308) ** (1 / 2.4) - 0.055)
    result: NDArray[np.uint8] = np.rint(codes * 255).astype(np.uint8)
    return result
