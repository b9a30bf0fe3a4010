"""The finest threshold with which an RGB triangulation keeps to its budget.

Thresholds are steps of `pace.factor`. The number of triangles falls from step to step, as all
criteria are monotonous in it; so the least step that keeps to the budget is unique, wherever one begins.
"""

from collections.abc import Callable

from .pace import COARSEST

__all__ = ["step_within"]


def step_within(is_within: Callable[[int], bool], start: int, /) -> int:
    """The least step for which `is_within`, which was the last one asked; begins at `start`."""
    low, high, reach = -1, start, 1  # outside at low, within at high
    if is_within(start):
        while high > 0 and is_within(max(high - reach, 0)):
            high, reach = max(high - reach, 0), 2 * reach
        low = max(high - reach, -1) if high > 0 else -1
    else:
        low, high = start, min(start + 1, COARSEST)
        while high < COARSEST and not is_within(high):
            low, high, reach = high, min(high + 2 * reach, COARSEST), 2 * reach
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
