"""Which threshold keeps to a budget of triangles and to a rate of frames.

The one thing that is turned is a factor on `edge_px`, in steps of an eighth of an octave. For one view the
number of triangles never rises with it, since what is wanted by a coarser threshold is wanted by a finer one.
So the least step within the budget is a function of the view alone, which `Pace` finds wherever it begins; a
rate is held by the budget that it takes, from what a triangle cost in the last frames.
"""

import math
import sys
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from statistics import median

from .criteria import Criteria, Region

__all__ = ["COARSEST", "Pace", "coarser", "factor", "update_within"]

# 2^(i / 8), written out: powers differ between machines in the last bit.
_EIGHTHS = (
    *(1.0, 1.0905077326652577, 1.1892071150027211, 1.2968395546510096),
    *(1.4142135623730951, 1.5422108254079407, 1.681792830507429, 1.8340080864093424),
)
_OCTAVE = len(_EIGHTHS)
COARSEST = 40 * _OCTAVE
"""A factor of 10^12: only what the eye is in has an edge so large."""

_NO_EDGE_PX = 1 / 256
_AFAR_PX = 8.0
_SPARE = 1.5  # a step changes the triangles by about 1.19, and where many pass a level at once by more
_FRAMES = 7
_CHANGE = 1.1  # fewer triangles or a larger budget by this have a step tried anew that was too much
_SHIFT = 1.2  # less than this the budget of a rate does not follow what was measured


def factor(step: int, /) -> float:
    """By how much `edge_px` is multiplied at a step.

    Examples
    --------
    >>> factor(0), factor(8), factor(20)
    (1.0, 2.0, 5.656854249492381)
    """
    return math.ldexp(_EIGHTHS[step % _OCTAVE], step // _OCTAVE)


def coarser(criteria: Criteria, step: int, /) -> Criteria:
    """Criteria with `edge_px` multiplied by the factor of a step; 0 counts as 1/256 above step 0."""
    if step == 0:
        return criteria

    def stretched(region: Region) -> Region:
        return replace(region, edge_px=(region.edge_px or _NO_EDGE_PX) * factor(step))

    return Criteria(stretched(criteria.front), stretched(criteria.silhouette), stretched(criteria.back))


class Pace:
    """The search for the least step within a budget, from frame to frame.

    `begin` a view, `tell` the triangles of the step, again and again until `is_fit`; then the mesh may be
    shown. It is the final one when `is_settled`; else `finer` goes on.

    Attributes
    ----------
    step : int
        To be tried next; the mesh that may be shown has this one.
    """

    def __init__(self, *, least: int, budget: int) -> None:
        self._range = least, max(least, budget)
        self._budget = self._range[1]
        self._costs: deque[float] = deque(maxlen=_FRAMES)
        self._of_rate = math.inf
        self.step = 0
        self._over, self._fits = -1, COARSEST + 1
        self._stride = 1
        self._triangles, self._told = 0, -1
        self._tried = (-1, 0, 0)

    def begin(self, criteria: Criteria, /, *, budget: int, rate: float, is_leap: bool) -> None:
        """A new view. After a leap the last step says nothing, so what fits is come to from afar."""
        if self._over >= 0 and self.is_fit:
            self._tried = (self._over, self._triangles, self._budget)
        least, most = self._range
        self._budget = max(least, min(budget or most, most, self._allowed(rate)))
        if is_leap:
            self.step, self._tried = max(self.step, _afar(criteria)), (-1, 0, 0)
        self._over, self._fits, self._stride = -1, COARSEST + 1, 1
        if not is_leap and self.is_ample:
            self.finer(is_moving=True)

    def _allowed(self, rate: float) -> int:
        """The triangles that a rate allows, by what they cost."""
        if not rate:
            self._of_rate = math.inf
        elif self._costs:
            allowed = 1000 / rate / median(self._costs)
            if not self._of_rate / _SHIFT < allowed < self._of_rate * _SHIFT:
                self._of_rate = allowed
        return int(min(self._of_rate, sys.maxsize))

    def tell(self, triangles: int, /) -> None:
        """How many triangles `step` gave; where they are too many, the next step is a coarser one."""
        self._triangles, self._told = triangles, self.step
        if triangles <= self._budget or self.step == COARSEST:
            self._fits = min(self._fits, self.step)
            return
        self._over = max(self._over, self.step)
        if self._fits > COARSEST:
            # Each time twice as far, for views in which the triangles do not change as they should.
            self.step = min(COARSEST, self.step + max(self._stride, self._steps(triangles, self._budget)))
            self._stride *= 2
        else:
            self.step = (self._over + self._fits + 1) // 2

    @property
    def budget(self) -> int:
        """Triangles at most, for this view."""
        return self._budget

    @property
    def is_fit(self) -> bool:
        """Whether the step last told of is the finest known to be within the budget."""
        return self.step == self._fits == self._told

    @property
    def is_settled(self) -> bool:
        """Whether that step is the least there is within the budget."""
        return self.is_fit and (self.step == 0 or self._over == self.step - 1)

    @property
    def is_ample(self) -> bool:
        """Whether a finer step would most likely be within the budget too, as far as the last views tell."""
        return self.step > self._least and self._triangles * _SPARE <= self._budget

    def finer(self, *, is_moving: bool = False) -> None:
        """Try a finer step, by about what the budget leaves; in motion none that was too much just before."""
        down = min(_OCTAVE, max(1, self._steps(self._budget, self._triangles)))
        self.step = max(self._least if is_moving else self._over + 1, self.step - down, 0)

    @property
    def _least(self) -> int:
        """The step to try at most in motion: where many triangles pass a level at once, not the same anew."""
        over, triangles, budget = self._tried
        has_changed = self._triangles < triangles / _CHANGE or self._budget > budget * _CHANGE
        return max(self._over, -1 if has_changed else over) + 1

    def spent(self, per_triangle_ms: float, /) -> None:
        """What a frame of a moving view cost for each of its triangles."""
        self._costs.append(per_triangle_ms)

    @staticmethod
    def _steps(many: int, few: int) -> int:
        """Steps by which the triangles change so, as their edges do that fill the picture."""
        return int(_OCTAVE / 2 * math.log2(max(1, many) / max(1, few)))


def update_within(
    update: Callable[[Criteria], int], criteria: Criteria, /, *, least: int, budget: int
) -> float:
    """Refine for a view as finely as a budget of triangles allows; returns the factor that took.

    Parameters
    ----------
    update : function
        Refines for criteria and gives the triangles that came of it.
    criteria : Criteria
        Are not exceeded.
    least : int
        Triangles of the control mesh, which are there in any case.
    budget : int
        Triangles at most; 0 for no limit.
    """
    pace = Pace(least=least, budget=budget or sys.maxsize)
    pace.begin(criteria, budget=budget, rate=0, is_leap=budget > 0)
    while True:
        pace.tell(update(coarser(criteria, pace.step)))
        if pace.is_settled:
            return factor(pace.step)
        if pace.is_fit:
            pace.finer()


def _afar(criteria: Criteria) -> int:
    """A step at which no triangle is split for an edge much shorter than 8 pixels."""
    regions = (criteria.front, criteria.silhouette, criteria.back)
    least = min((region.edge_px or _NO_EDGE_PX for region in regions if region.iterations), default=_AFAR_PX)
    return max(_OCTAVE, math.ceil(_OCTAVE * math.log2(_AFAR_PX / least)))
