"""The finest threshold with which an RGB triangulation keeps to its budget.

Thresholds are steps of an eighth of an octave. The number of triangles falls from step to step, as all
criteria are monotonous in it; so the least step that keeps to the budget is unique, wherever one begins.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = ["scaled", "step_within"]

#: Steps at most: 2^24 times coarser is the control mesh, which may be larger than the budget.
_STEPS = 8 * 24


def scaled(limits: NDArray[np.float64], step: int, /) -> NDArray[np.float64]:
    """Criteria's limits with edges in pixels so many steps longer; no such limit is one of a pixel then."""
    if step == 0:
        return limits
    limits = limits.copy()
    limits[:, 1] = np.where(limits[:, 1] > 0, limits[:, 1], 1.0) * 2.0 ** (step / 8)
    return limits


def step_within(is_within: Callable[[int], bool], start: int, /) -> int:
    """The least step for which `is_within`, which was the last one asked; begins at `start`."""
    low, high, reach = -1, start, 1  # outside at low, within at high
    if is_within(start):
        while high > 0 and is_within(max(high - reach, 0)):
            high, reach = max(high - reach, 0), 2 * reach
        low = max(high - reach, -1) if high > 0 else -1
    else:
        low, high = start, min(start + 1, _STEPS)
        while high < _STEPS and not is_within(high):
            low, high, reach = high, min(high + 2 * reach, _STEPS), 2 * reach
    last = high
    while high - low > 1:
        last = (low + high) // 2
        if is_within(last):
            high = last
        else:
            low = last
    if last != high or low >= 0:
        is_within(high)
    return high
