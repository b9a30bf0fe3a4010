"""How far a view moved since answers about it were given, which says whether they still hold."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["Drift"]

#: Of the mesh's size: where the count begins anew. Slacks kept in 32 bits would be nothing beside more.
_FAR = 1000.0


class Drift:
    """The way of the eye and of the frustum, summed up.

    An answer that holds as long as neither the eye moves by more than its slack, nor a plane of the frustum
    as seen from any point of the mesh, is kept with `total + slack` and holds while that is above `total`.

    Parameters
    ----------
    size : float
        Of the mesh: its box's diagonal.

    Attributes
    ----------
    total : float
        The way until now, from `size` on.
    view, limits : NDArray
        The last ones.
    """

    def __init__(self, size: float, /) -> None:
        self._size = size
        self.total = size
        self.view: NDArray[np.float64] = np.zeros(24)
        self.limits: NDArray[np.float64] = np.zeros(0)

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
        planes = (view[4:24] - self.view[4:24]).reshape(5, 4)
        moved = float(np.abs(corners @ planes[:, :3].T + planes[:, 3]).max())
        self.total += 1.001 * max(float(np.linalg.norm(view[:3] - self.view[:3])), moved)
        is_other = not (
            np.array_equal(limits, self.limits)
            and view[3] == self.view[3]
            and np.array_equal(view[24:], self.view[24:])
        )
        self.view, self.limits = view, limits
        if is_other or not self.total < _FAR * self._size:
            self.total = self._size
            return False
        return True
