"""Arrays that grow, and whose rows are lent in runs that stay where they are."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _kernels_slates_arena as kernels

__all__ = ["Arena"]

Ints = NDArray[np.int64]


class Arena:
    """Columns of one length, each (rows, width) of a type.

    Attributes
    ----------
    columns : list of (capacity, width) arrays
        What is not lent is zero, but for columns that `clear` is not called for.
    rows : int
        So many were ever lent.
    """

    def __init__(self, *columns: tuple[int, DTypeLike]) -> None:
        self.columns: list[NDArray[Any]] = [np.zeros((0, width), dtype) for width, dtype in columns]
        self.rows = 0
        self._heads = np.full(kernels.CLASSES, -1, np.int64)
        self._links = np.zeros(0, np.int64)

    def allocate(self, sizes: Ints, /) -> Ints:
        """(k,): the first rows of runs of these sizes."""
        places = np.empty(len(sizes), np.int64)
        self.rows = int(kernels.allocate(sizes, places, self._heads, self._links, self.rows))
        if self.rows > len(self._links):
            # By a half more: twice the room would be twice the memory of a mesh that never grows again.
            more = max(self.rows, len(self._links) * 3 // 2)
            self._links = _longer(self._links, more)
            self.columns = [_longer(column, more) for column in self.columns]
        return places

    def release(self, places: Ints, sizes: Ints, /) -> None:
        """Runs that are needed no more."""
        kernels.release(sizes, places, self._heads, self._links)

    def clear(self, column: int, places: Ints, sizes: Ints, used: Ints | None = None, /) -> None:
        """Make rows of runs zero, from `used` of each on."""
        used = np.zeros_like(sizes) if used is None else used
        kernels.clear(sizes, used, places, self.columns[column])

    @property
    def bytes_used(self) -> int:
        """Of all columns, and of what is kept about them."""
        return sum(column.nbytes for column in self.columns) + self._links.nbytes


def _longer(column: NDArray[Any], rows: int) -> NDArray[Any]:
    longer = np.zeros((rows, *column.shape[1:]), column.dtype)
    longer[: len(column)] = column
    return longer
