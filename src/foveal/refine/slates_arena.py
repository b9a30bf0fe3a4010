"""Arrays that grow, and whose rows are lent in runs that stay where they are."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _kernels_slates_arena as kernels

__all__ = ["Arena", "ranges"]

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
        self._heads[-2] = 0
        self._nodes = np.zeros((0, 2), np.int64)

    def allocate(self, sizes: Ints, /) -> Ints:
        """(k,): the first rows of runs of these sizes."""
        places = np.empty(len(sizes), np.int64)
        self.rows = int(kernels.allocate(sizes, places, self._heads, self._nodes, self.rows))
        room = len(self.columns[0])
        if self.rows > room:
            # By a half more: twice the room would be twice the memory of a mesh that never grows again.
            # A multiple of 4 rows, so that columns of bytes can be read as words.
            more = -(-max(self.rows, room * 3 // 2) // 4) * 4
            self.columns = [_longer(column, more) for column in self.columns]
        return places

    def release(self, places: Ints, sizes: Ints, /) -> None:
        """Runs that are needed no more."""
        self._add_nodes(len(places))
        kernels.release(sizes, places, self._heads, self._nodes)

    def _add_nodes(self, count: int) -> None:
        """Have at least so many that are not in use."""
        before = len(self._nodes)
        missing = int(self._heads[-2]) + count - before
        if missing <= 0:
            return
        more = max(missing, before // 2)
        self._nodes = _longer(self._nodes, before + more)
        fresh = np.arange(before, before + more)
        self._nodes[before:, 1] = np.append(fresh[1:], self._heads[-1])
        self._heads[-1] = before

    def clear(self, column: int, places: Ints, sizes: Ints, /) -> None:
        """Make rows of runs zero."""
        kernels.clear(sizes, places, self.columns[column])

    @property
    def bytes_used(self) -> int:
        """Of all columns, and of what is kept about them."""
        return sum(column.nbytes for column in self.columns) + self._nodes.nbytes


def ranges(places: Ints, sizes: Ints, /) -> Ints:
    """(r, 2): runs as first row and the one after the last, ascending, joined where they touch.

    Examples
    --------
    >>> ranges(np.array([9, 0, 4]), np.array([1, 4, 2]))
    array([[ 0,  6],
           [ 9, 10]])
    """
    order = np.argsort(places, kind="stable")
    order = order[sizes[order] > 0]
    begins, ends = places[order], np.maximum.accumulate(places[order] + sizes[order])
    is_first = np.ones(len(order), np.bool_)
    is_first[1:] = begins[1:] > ends[:-1]
    last = np.append(np.flatnonzero(is_first)[1:] - 1, len(order) - 1)[: is_first.sum()]
    return np.stack([begins[is_first], ends[last]], axis=1)


def _longer(column: NDArray[Any], rows: int) -> NDArray[Any]:
    longer = np.zeros((rows, *column.shape[1:]), column.dtype)
    longer[: len(column)] = column
    return longer
