"""Arrays of records that lie as the processor fetches them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["in_lines"]

#: Two cache lines, which are fetched together: a vertex's record is as long.
_PAIR = 128


def in_lines(count: int, dtype: "np.dtype[Any]", /) -> NDArray[Any]:
    """Zeros that begin where a pair of cache lines does; NumPy's begin 16 bytes after one.

    Examples
    --------
    >>> in_lines(3, np.dtype(np.float64)).ctypes.data % 128
    0
    """
    size = count * dtype.itemsize
    room = np.zeros(size + _PAIR, np.uint8)
    begin = -room.ctypes.data % _PAIR
    return room[begin : begin + size].view(dtype)
