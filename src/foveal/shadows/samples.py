"""Places on the surface of a light, in an order in which each is beside the last."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["hilbert", "on_a_disc", "on_a_square"]


def hilbert(side: int, /) -> NDArray[np.int64]:
    """(side², 2): the cells of a square in the order of Hilbert's curve; side is a power of two.

    Examples
    --------
    >>> hilbert(2).tolist()
    [[0, 0], [0, 1], [1, 1], [1, 0]]
    """
    cells = np.zeros((1, 2), np.int64)
    half = 1
    while half < side:
        x, y = cells.T
        last = 2 * half - 1
        quarters = ((y, x), (x, y + half), (x + half, y + half), (last - y, half - 1 - x))
        cells = np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])
        half *= 2
    return cells


def on_a_square(samples: int, /, *, jitter: bool = False, seed: int = 0) -> NDArray[np.float64]:
    """(samples, 2) in [-1, 1]²: one in each cell of a grid, in its middle or, by jitter, anywhere.

    Parameters
    ----------
    samples : int
        A power of four.
    jitter, seed
        Whether each is at random within its cell, and by which numbers.
    """
    side = int(samples**0.5)
    within = np.full((samples, 2), 0.5)
    if jitter:
        np.random.default_rng(seed).random(out=within)
    return np.asarray((hilbert(side) + within) * (2 / side) - 1, np.float64)


def on_a_disc(square: NDArray[np.float64], /) -> NDArray[np.float64]:
    """(n, 2) points of [-1, 1]² on the unit disc, equal areas to equal areas, neighbours to neighbours.

    References
    ----------
    Shirley, P., Chiu, K. (1997). A low distortion map between disk and square. J. Graphics Tools 2(3), 45-52.

    Examples
    --------
    >>> on_a_disc(np.array([[1.0, 0.0], [0.5, 0.5], [0.0, 0.0]])).round(3)
    array([[1.   , 0.   ],
           [0.354, 0.354],
           [0.   , 0.   ]])
    """
    x, y = square.T
    is_wide = np.abs(x) > np.abs(y)
    radius = np.where(is_wide, x, y)
    share = np.where(is_wide, y, x) / np.where(radius == 0, 1, radius) * (np.pi / 4)
    angle = np.where(is_wide, share, np.pi / 2 - share)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
