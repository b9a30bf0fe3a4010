"""A rate of frames held by a budget of triangles: the feedback of the paper's section 3.1."""

from collections import deque
from statistics import median

__all__ = ["FrameRate"]

_BAND = 0.06  # of the wished time: within it nothing changes, else noise would move patches in every frame
_NEAR = 0.25  # up to here a step goes most of the way, from here on as far as one depth does
_FOURFOLD = 4.0  # what one depth more or less does to the triangles
_FRAMES = 3  # whose median is looked at near the wish; far from it the last frame says enough


class FrameRate:
    """Which budget of triangles keeps to a rate; `tell` it what each frame took.

    The budget decides as the paper has it: far from the wished time by whole depths, since
    `Slates.update` lowers the maximum depth first, near it by some patches to the neighbouring depth.

    Parameters
    ----------
    rate : float
        Frames a second that are wished for.
    budget : int
        Triangles to begin with.
    least, most : int
        Bounds of the budget.

    Examples
    --------
    >>> pace = FrameRate(40, budget=500_000)
    >>> for _ in range(10):  # a frame takes 5 ms and 1 ms for 10,000 triangles
    ...     pace.tell(5 + pace.budget / 10_000, pace.budget)
    >>> 190_000 < pace.budget < 215_000
    True
    """

    def __init__(self, rate: float, /, *, budget: int = 100_000, least: int = 100, most: int = 50_000_000):
        if not rate > 0:
            raise ValueError(f"rate must be frames a second, above 0, got {rate}")
        self._wish_ms = 1000.0 / rate
        self._range = least, max(least, most)
        self._recent: deque[float] = deque(maxlen=_FRAMES)
        self.budget = min(max(budget, least), self._range[1])

    def tell(self, frame_ms: float, triangles: int, /) -> None:
        """What the last frame took with so many triangles, from which the next budget follows."""
        self._recent.append(max(frame_ms, 1e-6))
        off = self._recent[-1] / self._wish_ms - 1
        if abs(off) < _NEAR:
            if len(self._recent) < _FRAMES:
                return
            off = median(self._recent) / self._wish_ms - 1
        if abs(off) <= _BAND or (off < 0 and triangles < self.budget / _FOURFOLD):
            return  # as wished, or as deep as the rules want it
        share = 1 / (1 + off)
        if abs(off) < _NEAR:
            share = 1 + 0.7 * (share - 1)
        share = min(max(share, 1 / _FOURFOLD), _FOURFOLD)
        least, most = self._range
        self.budget = int(min(max(min(triangles, self.budget) * share, least), most))
        self._recent.clear()
