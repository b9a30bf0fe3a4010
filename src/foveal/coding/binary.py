"""Adaptive binary range coding: bits whose chances are learnt as they come, one chance a context.

A chance is the mean of a quick and a slow estimate, whole numbers throughout, so that every machine and
language reads the same. A loop over a room's own data calls `_kernels_binary.code` for each bit, which
writes or reads: encoder and decoder are then one loop that cannot disagree.

Based on: Martin. Range encoding: an algorithm for removing redundancy from a digitised message. 1979. Carries
as in Pavlov's LZMA.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _kernels_binary as kernels

__all__ = [
    "BYTES_A_BIT",
    "MOST_BITS_A_BYTE",
    "Chances",
    "Coder",
    "drain",
    "finish",
    "is_at_end",
    "reader",
    "writer",
]

BYTES_A_BIT = 1.5
"""More than a bit ever takes: chances are at least 2^-10, so 10 bits and what rounding adds."""

MOST_BITS_A_BYTE = 8192
"""More than a byte ever stands for: a chance is at most 4092 / 4096, so a bit takes at least 0.0014 bits."""


class Chances(NamedTuple):
    """What is known of the bits so far: (contexts,) uint16 estimates of the chance of a 0, in 2^-16."""

    quick: NDArray[np.uint16]
    slow: NDArray[np.uint16]

    @classmethod
    def even(cls, contexts: int, /) -> "Chances":
        """Nothing is known."""
        return cls(*(np.full(contexts, kernels.EVEN, np.uint16) for _ in range(2)))


class Coder(NamedTuple):
    """A stream of bytes that is being written or read.

    Attributes
    ----------
    state : (STATES,) int64
        See `_kernels_binary`.
    quick, slow : (contexts,) uint16
        As of `Chances`: shared, and learnt further.
    data : uint8
        What is read; or where it is written, with room for `BYTES_A_BIT` times the bits to come.
    """

    state: NDArray[np.int64]
    quick: NDArray[np.uint16]
    slow: NDArray[np.uint16]
    data: NDArray[np.uint8]

    @property
    def is_reading(self) -> bool:
        """Whether it reads."""
        return bool(self.state[kernels.IS_READING])


def writer(chances: Chances, room: int, /) -> Coder:
    """A coder that writes a stream; with `room` bytes until the first `drain`.

    Examples
    --------
    >>> bits = np.array([1, 1, 0, 1] * 100)
    >>> coder = writer(Chances.even(1), 600)
    >>> kernels.code_all(coder, np.zeros(400, np.int32), bits)
    >>> data = finish(coder)
    >>> len(data)
    46
    >>> again = np.zeros(400, int)
    >>> kernels.code_all(reader(Chances.even(1), data), np.zeros(400, np.int32), again)
    >>> bool((again == bits).all())
    True
    """
    state = np.zeros(kernels.STATES, np.int64)
    state[kernels.WIDTH] = kernels.WHOLE
    state[kernels.HELD] = 0xFF  # before the first byte: no carry comes so far
    return Coder(state, *chances, np.empty(room + kernels.CODE_BYTES, np.uint8))


def drain(coder: Coder, room: int, /) -> tuple[bytes, Coder]:
    """What a writer has put down so far, and the coder with `room` bytes for what comes next."""
    waiting = int(coder.state[kernels.WAITING])  # a run of 255 may wait for its carry
    at = int(coder.state[kernels.AT])
    coder.state[kernels.AT] = 0
    return coder.data[:at].tobytes(), coder._replace(
        data=np.empty(room + waiting + kernels.CODE_BYTES, np.uint8)
    )


def finish(coder: Coder, /) -> bytes:
    """End a writer's stream, and give what was not drained."""
    for _ in range(kernels.CODE_BYTES + 1):
        kernels.shift(coder)
    return coder.data[: coder.state[kernels.AT]].tobytes()


def reader(chances: Chances, data: bytes, /) -> Coder:
    """A coder that reads `data`, which may be any bytes; past their end it reads zeros.

    Once it has read all that was written, `is_at_end` holds; where much more is read than was written,
    `state[AT]` runs past the data.
    """
    state = np.zeros(kernels.STATES, np.int64)
    state[kernels.IS_READING] = 1
    state[kernels.WIDTH] = kernels.WHOLE
    coder = Coder(state, *chances, np.frombuffer(bytearray(data), np.uint8))
    for _ in range(kernels.CODE_BYTES):
        kernels.shift(coder)
    return coder


def is_at_end(coder: Coder, /) -> bool:
    """Whether a reader has read as many bytes as there are, not one less or more."""
    return int(coder.state[kernels.AT]) == len(coder.data)
