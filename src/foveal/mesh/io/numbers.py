"""ASCII numbers by the block: the kernel reads nearly all, Python's `float` the few it leaves."""

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from . import _kernels
from .stream import ByteStream

__all__ = ["NumberReader", "settle"]

_CHUNK_BYTES = 1 << 20
_LONGEST_TOKEN = 4096
_SLOW_ROWS = 1 << 16


def settle(
    buffer: NDArray[np.uint8], slow: NDArray[np.int64], values: NDArray[np.float64], name: str
) -> None:
    """Put the numbers of the tokens in `slow` (begin, end, index) into `values`.

    Raises
    ------
    FovealError
        If one is not a number.
    """
    for begin, end, index in slow.tolist():
        token = buffer[begin:end].tobytes()
        try:
            if b"_" in token:  # Python's own separator, which no file format has
                raise ValueError
            values[index] = float(token)
        except ValueError:
            shown = token[:20].decode("ascii", "backslashreplace")
            raise FovealError(
                f'{name}: "{shown}" stands where a number is due. The file is damaged; copy it again.'
            ) from None


class NumberReader:
    """The numbers, parted by white space, that follow in a stream."""

    def __init__(self, stream: ByteStream, name: str, start: bytes = b"") -> None:
        self._stream = stream
        self._name = name
        self._rest = start
        self._is_ended = False
        self._values = np.empty((_CHUNK_BYTES + _LONGEST_TOKEN) // 2 + 1)
        self._slow = np.empty((_SLOW_ROWS, _kernels.SLOW_COLUMNS), dtype=np.int64)

    def read(self) -> NDArray[np.float64]:
        """The next numbers, some hundred thousand; none at the end. Overwritten by the next call."""
        while True:
            if not self._is_ended and len(self._rest) < _LONGEST_TOKEN:
                data = self._stream.read(_CHUNK_BYTES - _LONGEST_TOKEN)
                self._is_ended = not data
                self._rest += data
            if not self._rest:
                return self._values[:0]
            buffer = np.frombuffer(self._rest, dtype=np.uint8)
            end = min(len(buffer), _CHUNK_BYTES)
            used, count, doubts = _kernels.parse_tokens(
                buffer, end, self._is_ended and end == len(buffer), self._values, self._slow
            )
            settle(buffer, self._slow[:doubts], self._values, self._name)
            self._rest = self._rest[used:]
            if count:
                return self._values[:count]
            if used == 0 and len(self._rest) >= _LONGEST_TOKEN:
                raise FovealError(
                    f"{self._name}: there is no number in {len(self._rest)} bytes where numbers are due."
                    " The file is damaged; copy it again."
                )
            if self._is_ended:
                return self._values[:0]
