"""Numbers, symbols and raw bits in a row of bytes; reading stops at the first thing that cannot be.

- number: 7 bits a byte, low ones first, the top bit set on all bytes but the last; below 2^32
- raw bits: their length in bytes as a number, then they
- symbols: the size of the alphabet (one byte), each symbol's frequency in 255ths of the greatest (one
  byte, 0 for a symbol that does not occur), then Tunstall's words as raw bits. How many symbols there
  are is known otherwise.
"""

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.coding.tunstall import Tunstall

__all__ = ["Reader", "Writer"]


class Writer:
    """Collects bytes and how many went to which stream."""

    def __init__(self, word_bits: int) -> None:
        self.data = bytearray()
        self.sizes: dict[str, int] = {}
        self._word_bits = word_bits

    def number(self, value: int) -> None:
        """Append a number in [0, 2^32)."""
        while value > 127:
            self.data.append(value & 127 | 128)
            value >>= 7
        self.data.append(value)

    def signed(self, value: int) -> None:
        """Append a number in [-2^31, 2^31), with its sign as the lowest bit."""
        self.number(2 * value if value >= 0 else -2 * value - 1)

    def raw(self, name: str, raw: bytes) -> None:
        """Append raw bits."""
        begin = len(self.data)
        self.number(len(raw))
        self.data += raw
        self.sizes[name] = self.sizes.get(name, 0) + len(self.data) - begin

    def symbols(self, name: str, symbols: NDArray[np.uint8]) -> None:
        """Append symbols, with the table they need."""
        begin = len(self.data)
        counts = np.bincount(symbols).astype(np.int64)
        if counts.size:
            # A symbol that occurs must keep a frequency, however rare it is.
            scaled = np.where(counts > 0, np.maximum(counts * 255 // counts.max(), 1), 0)
        else:
            scaled = counts
        self.data.append(len(scaled))
        self.data += scaled.astype(np.uint8).tobytes()
        words = Tunstall.from_frequencies(scaled, self._word_bits).encode(symbols)
        self.sizes[name] = self.sizes.get(name, 0) + len(self.data) - begin
        self.raw(name, words)


class Reader:
    """Reads what a `Writer` wrote; anything else ends in `FovealError`."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0
        self.word_bits = 8

    def byte(self) -> int:
        """The next byte."""
        return self._take(1)[0]

    def number(self) -> int:
        """The next number, below 2^32."""
        value = shift = 0
        while True:
            byte = self.byte()
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift > 28:
                raise self.fault()
        if value >= 1 << 32:
            raise self.fault()
        return value

    def signed(self) -> int:
        """The next number with a sign."""
        value = self.number()
        return -((value + 1) >> 1) if value & 1 else value >> 1

    def raw(self) -> bytes:
        """The next raw bits."""
        return self._take(self.number())

    def symbols(self, count: int) -> NDArray[np.uint8]:
        """The next `count` symbols."""
        frequencies = np.frombuffer(self._take(self.byte()), np.uint8)
        words = self.raw()
        if int((frequencies > 0).sum()) > 1 << self.word_bits:
            raise self.fault()
        return Tunstall.from_frequencies(frequencies, self.word_bits).decode(words, count)

    def end(self) -> None:
        """There must be nothing more."""
        if self._at != len(self._data):
            raise self.fault()

    def fault(self) -> FovealError:
        """What is wrong with bytes that are not a patch."""
        return FovealError("a patch in the paper's coding is damaged. Encode it again.")

    def _take(self, count: int) -> bytes:
        if count > len(self._data) - self._at:
            raise self.fault()
        self._at += count
        return self._data[self._at - count : self._at]
