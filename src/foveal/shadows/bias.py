"""How a receiver is moved towards the light, so that nothing shades itself and nothing floats.

The rule and why it is right are in `spec/shadows.md`, "Bias".
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _kernels_lookup_points as kernels
from .projection import Projection

__all__ = ["Window", "receivers", "window_of"]


class Window(NamedTuple):
    """What a lookup knows of a projection.

    Attributes
    ----------
    matrix : (4, 4) float64
        The projection's.
    rays : (2, 3) float64
        How a point moves where u or v grows by one: of parallel light at one depth, else at distance 1
        along the light's axis.
    levels : int
        Its map has 2^levels pixels a side.
    """

    matrix: NDArray[np.float64]
    rays: NDArray[np.float64]
    levels: int


def window_of(projection: Projection, levels: int, /) -> Window:
    """The window of a projection onto a map of 2^levels pixels a side."""
    matrix = np.ascontiguousarray(projection.matrix, np.float64)
    rows = matrix[[0, 1, 2 if projection.is_parallel else 3], :3]
    return Window(matrix, np.ascontiguousarray(np.linalg.inv(rows)[:, :2].T), levels)


def receivers(
    window: Window,
    points: ArrayLike,
    /,
    *,
    normals: ArrayLike | None = None,
    radius: int = 0,
    level: int | None = None,
) -> NDArray[np.int64]:
    """Where points are looked up: pixel and step of each, moved by the bias if they have normals.

    Parameters
    ----------
    points, normals : (n, 3)
        Unit normals of the surface's sides that are seen.
    radius : int
        Of the kernel in pixels: 0 is a single one, 2 is 5 x 5.
    level : int, optional
        Of the map that is looked in, by default the finest.

    Returns
    -------
    (n, 3) int64
        x, y, step; -2^30, -2^30, 0 behind the light.

    Examples
    --------
    >>> down = Projection(np.array([[0.125, 0, 0, 0], [0, 0.125, 0, 0], [0, 0, -0.125, 0.5], [0, 0, 0, 1]]))
    >>> receivers(window_of(down, 3), [[2.5, 3.5, 0]]).tolist()
    [[2, 3, 2147483648]]
    >>> receivers(window_of(down, 3), [[2.5, 3.5, 0]], normals=[[0, 0, 1]]).tolist()  # faces the light
    [[2, 3, 2147481600]]
    """
    points = np.ascontiguousarray(points, np.float64).reshape(-1, 3)
    out = np.empty((len(points), 3), np.int64)
    level = window.levels if level is None else level
    kernels.places(window, level, radius, points, as_normals(normals, len(points)), out)
    return out


def as_normals(normals: ArrayLike | None, count: int, /) -> NDArray[np.float64]:
    """(n, 3) float64, or (0, 3) for none."""
    if normals is None:
        return np.empty((0, 3))
    array = np.ascontiguousarray(normals, np.float64).reshape(-1, 3)
    if len(array) != count:
        raise ValueError(f"there must be a normal for each of the {count} points, got {len(array)}")
    return array
