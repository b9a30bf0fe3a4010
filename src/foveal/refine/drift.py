"""How far a view moved since answers about it were given, which says whether they still hold."""

import math

import numpy as np
from numpy.typing import NDArray

from . import _kernels_drift as kernels

__all__ = ["Drift"]

#: In the mesh's size. A count has 2^30 of them, so it begins anew after a thousand times that size.
_STEPS = 1 << 20


class Drift:
    """The way of the eye and of the frustum, summed up; `_kernels_drift.py` has what it is for.

    Parameters
    ----------
    size : float
        Of the mesh: its box's diagonal.

    Attributes
    ----------
    view, limits : NDArray
        The last ones.
    """

    def __init__(self, size: float, /) -> None:
        self._steps = _STEPS / size if size > 0.0 else 1.0
        self._near = self._far = 0
        self.view: NDArray[np.float64] = np.zeros(24)
        self.limits: NDArray[np.float64] = np.zeros(0)

    @property
    def now(self) -> tuple[int, float]:
        """(word, steps in a unit of length), as kernels take it."""
        return (self._near << 32) + self._far, self._steps

    def is_still(self, view: NDArray[np.float64], limits: NDArray[np.float64], /) -> bool:
        """Whether view and limits are the last ones."""
        return np.array_equal(view, self.view) and np.array_equal(limits, self.limits)

    def forget(self) -> None:
        """Let no answer hold for the next view."""
        self.limits = np.zeros(0)

    def move(
        self, view: NDArray[np.float64], limits: NDArray[np.float64], corners: NDArray[np.float64], /
    ) -> bool:
        """Go on to a view; whether kept answers may still hold. For other limits, pixels or depths none does.

        Parameters
        ----------
        view, limits : (24 or more,), (n, 3) float64
            As `_kernels_criteria.py` reads them.
        corners : (8, 3) float64
            Of a box around the points that answers are about.
        """
        # What rounding may have lost is added.
        near, far = (1.001 * self._steps * way for way in kernels.moved(self.view, view, corners))
        is_other = not (
            np.array_equal(limits, self.limits)
            and view[3] == self.view[3]
            and np.array_equal(view[24:], self.view[24:])
        )
        self.view, self.limits = view, limits
        if is_other or not max(self._near + near, self._far + far) < kernels.MOST:
            self._near = self._far = 0
            return False
        self._near, self._far = self._near + math.ceil(near), self._far + math.ceil(far)
        return True
