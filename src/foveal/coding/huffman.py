"""Canonical Huffman code of limited length, decoded by look-up in one table.

Kept to measure Tunstall's code against, as the paper does. With codes of at most 12 bits the table has
4,096 entries; the price of the limit is far below a percent for the alphabets here.

Based on: Pajarola and Rossignac, Squeeze: fast and progressive decompression of triangle meshes, 2000
(decoding by table); Larmore and Hirschberg, A fast algorithm for optimal length-limited Huffman codes,
1990 (package-merge).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from . import _kernels_huffman as _kernels
from .bits import pack_bits

__all__ = ["MAX_BITS", "Huffman"]

MAX_BITS = 15
"""Two codes and the bits that a window of two words may waste fit 64 bits."""


@dataclass(frozen=True)
class Huffman:
    """A code for symbols 0 to 255; make one with `from_frequencies` or `from_lengths`.

    Attributes
    ----------
    lengths : (n,) uint8
        Bits of each symbol's code, 0 for one that cannot occur. They determine the code: shorter codes
        first, equal ones by symbol, counting up.
    max_bits : int
        The longest code may have so many bits; the table has 2^max_bits entries.
    """

    lengths: NDArray[np.uint8]
    max_bits: int

    @classmethod
    def from_frequencies(cls, frequencies: ArrayLike, max_bits: int = 12, /) -> "Huffman":
        """The best code for these frequencies with no code longer than `max_bits` (1 to 15).

        Raises
        ------
        ValueError
            If there are more symbols than codes, or an argument is out of range.

        Examples
        --------
        >>> Huffman.from_frequencies([50, 30, 10, 10]).lengths.tolist()
        [1, 2, 3, 3]
        >>> Huffman.from_frequencies([50, 30, 10, 10], 2).lengths.tolist()
        [2, 2, 2, 2]
        """
        counts = np.asarray(frequencies)
        if counts.ndim != 1 or len(counts) > 256 or (counts.size and counts.dtype.kind not in "iu"):
            raise ValueError(f"frequencies must be at most 256 integers, got {counts.dtype} {counts.shape}")
        if counts.size and int(counts.min()) < 0:
            raise ValueError("a frequency must not be negative")
        if not 1 <= max_bits <= MAX_BITS:
            raise ValueError(f"max_bits must be 1 to {MAX_BITS}, got {max_bits}")
        used = int((counts > 0).sum())
        if used > 1 << max_bits:
            raise ValueError(f"{used} symbols do not fit codes of {max_bits} bits")
        return cls(_package_merge([int(c) for c in counts], max_bits), max_bits)

    @classmethod
    def from_lengths(cls, lengths: ArrayLike, max_bits: int = 12, /) -> "Huffman":
        """The code that `lengths` determine; `FovealError` if they are those of no complete code."""
        bits = np.asarray(lengths, dtype=np.uint8)
        present = bits[bits > 0].astype(np.int64)
        if len(bits) > 256 or not 1 <= max_bits <= MAX_BITS or (present > max_bits).any():
            raise FovealError("a Huffman table is damaged. Copy or build the file again.")
        space = int((1 << (max_bits - present)).sum())
        if space != 1 << max_bits and not (len(present) == 1 and present[0] == 1) and len(present):
            raise FovealError("a Huffman table is damaged. Copy or build the file again.")
        return cls(bits, max_bits)

    @cached_property
    def codes(self) -> NDArray[np.uint32]:
        """(n,) the code of each symbol as it stands in the stream: first bit lowest."""
        codes = np.zeros(len(self.lengths), dtype=np.uint32)
        code = 0
        before = 0
        for symbol in np.argsort(self.lengths, kind="stable"):
            length = int(self.lengths[symbol])
            if length:
                code <<= length - before
                codes[symbol] = int(f"{code:0{length}b}"[::-1], 2)
                code, before = code + 1, length
        return codes

    @cached_property
    def _table(self) -> NDArray[np.uint16]:
        table = np.zeros(1 << self.max_bits, dtype=np.uint16)
        _kernels.fill_table(self.codes, self.lengths, self.max_bits, table)
        return table

    def encode(self, symbols: ArrayLike, /) -> bytes:
        """The codes of a stream; its number of symbols must be kept beside.

        Raises
        ------
        ValueError
            If a symbol's frequency was 0.
        """
        data = np.ascontiguousarray(symbols, dtype=np.uint8)
        if data.size and (int(data.max()) >= len(self.lengths) or (self.lengths[data] == 0).any()):
            raise ValueError("a symbol has frequency 0 and no code")
        if (self.lengths > 0).sum() <= 1:
            return b""
        return pack_bits(self.codes[data], self.lengths[data])

    def decode(self, data: bytes, count: int, /) -> NDArray[np.uint8]:
        """The first `count` symbols in `data`, which may be any bytes.

        A code of one symbol takes `count` at its word: bound it first where it comes from outside.

        Raises
        ------
        FovealError
            If `data` holds fewer bits than that, before much is allocated.
        """
        if count < 0:
            raise ValueError(f"count must not be negative, got {count}")
        present = np.flatnonzero(self.lengths)
        if len(present) == 0 and count:
            raise FovealError("a stream has symbols but no alphabet. Copy or build the file again.")
        if len(present) <= 1:
            return np.full(count, present[0] if count else 0, dtype=np.uint8)
        if count > 8 * len(data):
            raise FovealError("a stream of symbols ends too early. Copy or build the file again.")
        padded = np.zeros((len(data) + 3) // 4 + 4, dtype="<u4")
        padded.view(np.uint8)[: len(data)] = np.frombuffer(data, np.uint8)
        out = np.empty(count, dtype=np.uint8)
        words = padded.astype(np.uint32, copy=False)
        if not _kernels.decode(words, self.max_bits, 8 * len(data), self._table, out):
            raise FovealError("a stream of symbols ends too early. Copy or build the file again.")
        return out


def _package_merge(counts: list[int], max_bits: int) -> NDArray[np.uint8]:
    """Bits of each symbol's code, at most `max_bits`: merge pairs, add the symbols again, so often."""
    lengths = np.zeros(len(counts), dtype=np.uint8)
    coins = sorted((count, symbol) for symbol, count in enumerate(counts) if count > 0)
    if len(coins) == 1:
        lengths[coins[0][1]] = 1
    if len(coins) <= 1:
        return lengths
    leaves = [(count, [symbol]) for count, symbol in coins]
    row: list[tuple[int, list[int]]] = []
    for _ in range(max_bits):
        pairs = [(a[0] + b[0], a[1] + b[1]) for a, b in zip(row[::2], row[1::2], strict=False)]
        row = sorted(leaves + pairs, key=lambda coin: coin[0])
    for _, inside in row[: 2 * len(coins) - 2]:
        for symbol in inside:
            lengths[symbol] += 1
    return lengths
