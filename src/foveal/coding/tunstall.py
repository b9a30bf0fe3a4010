"""Tunstall's variable-to-fixed code: each word of N bits stands for a run of symbols.

The words' sequences are complete (any input can be parsed) and proper (none begins another). Decoding
is one look-up and a copy a word, and may begin at any word.

Nothing here is a float: probabilities are whole numbers of 2^-16, those of sequences are rounded down
to whole numbers of 2^-32, symbols of equal weight go in their own order, and of equal sequences the
one whose last symbol comes first is expanded first. So every machine and language builds one table.

Based on: Tunstall, Synthesis of noiseless compression codes, 1967; Baer, Efficient implementation of the
generalized Tunstall code generation algorithm, ISIT 2009 (sorted queues in place of a heap).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from . import _kernels_tunstall as _kernels
from .bits import pack_bits

__all__ = ["MAX_WORD_BITS", "Tunstall"]

MAX_WORD_BITS = 14
"""Longer words gain under one percent a bit, and the table doubles with each."""

MAX_TABLE = 1 << 24
"""Symbols in all sequences of a code together. Every code of at most 12 bits stays below."""

_PAST_TABLE = 8  # the decoder copies short sequences as eight symbols


@dataclass(frozen=True)
class Tunstall:
    """A code for symbols 0 to 255; make one with `Tunstall.from_frequencies`.

    Attributes
    ----------
    word_bits : int
        N, the bits of a word.
    symbols : (m,) uint8
        Those that can occur, by falling probability.
    parents, children, codes, lengths, chances : int arrays
        The sequences as `_kernels_tunstall` numbers them.
    words : int
        How many words are used, at most 2^N.
    """

    word_bits: int
    symbols: NDArray[np.uint8]
    parents: NDArray[np.int32]
    children: NDArray[np.int32]
    codes: NDArray[np.int32]
    lengths: NDArray[np.int32]
    chances: NDArray[np.int64]
    words: int

    @classmethod
    def from_frequencies(cls, frequencies: ArrayLike, word_bits: int, /) -> "Tunstall":
        """The best code of at most 2^word_bits words for these frequencies.

        Parameters
        ----------
        frequencies : (at most 256,) int, each in [0, 2^32)
            How often each symbol occurs. Those of frequency 0 get no sequence and cannot be encoded. A
            single symbol needs no bits at all.
        word_bits : int
            1 to 14.

        Raises
        ------
        ValueError
            If there are more symbols than words, the sequences would hold over 2^24 symbols (only
            possible above 12 bits), or an argument is out of range.

        Examples
        --------
        Figure 4 of the paper: with four symbols A, B, C, D, the sequences A, B, AA and BA are expanded.

        >>> code = Tunstall.from_frequencies([50, 30, 10, 10], 4)
        >>> code.words
        16
        >>> ["".join("ABCD"[s] for s in code.sequence(word)) for word in range(8)]
        ['C', 'D', 'AB', 'AC', 'AD', 'BB', 'BC', 'BD']
        >>> code.decode(code.encode([0, 0, 0, 2, 1, 3, 0]), 7).tolist()
        [0, 0, 0, 2, 1, 3, 0]
        """
        counts = np.asarray(frequencies)
        _check(counts, word_bits)
        order = np.argsort(-counts.astype(np.int64), kind="stable")
        order = order[: int((counts > 0).sum())]
        m = len(order)
        if m > 1 << word_bits:
            raise ValueError(f"{m} symbols do not fit {1 << word_bits} words of {word_bits} bits")
        weights = _weights(counts[order].astype(np.int64))
        columns = 1 + ((1 << word_bits) - m) // (m - 1) if m > 1 else min(m, 1)
        parents = np.zeros(columns, dtype=np.int32)
        lengths = np.zeros(columns * m, dtype=np.int32)
        chances = np.zeros(columns * m, dtype=np.int64)
        heads = np.zeros(m, dtype=np.int32)
        if m:
            _kernels.build(weights, parents, chances, lengths, heads)
        children = np.empty(columns * m, dtype=np.int32)
        codes = np.empty(columns * m, dtype=np.int32)
        words = int(_kernels.number_words(m, parents, heads, children, codes))
        if lengths[codes >= 0].sum() > MAX_TABLE:
            raise ValueError(f"sequences of {word_bits}-bit words grow too long here; use at most 12 bits")
        return cls(word_bits, order.astype(np.uint8), parents, children, codes, lengths, chances, words)

    @cached_property
    def _table(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8]]:
        """Start and size of each word's sequence, and all sequences one after the other."""
        starts = np.empty(self.words, dtype=np.int32)
        sizes = np.empty(self.words, dtype=np.int32)
        table = np.zeros(int(self.lengths[self.codes >= 0].sum()) + _PAST_TABLE, dtype=np.uint8)
        m = len(self.symbols)
        if m:
            _kernels.fill_table(m, self.symbols, self.parents, self.codes, self.lengths, starts, sizes, table)
        return starts, sizes, table

    @cached_property
    def longest(self) -> int:
        """Symbols of the longest sequence; 0 for a code of no symbols."""
        return int(self.lengths[self.codes >= 0].max(initial=0))

    def sequence(self, word: int, /) -> NDArray[np.uint8]:
        """The symbols that `word`, in [0, words), stands for."""
        starts, sizes, table = self._table
        return table[starts[word] : starts[word] + sizes[word]].copy()

    def encode(self, symbols: ArrayLike, /) -> bytes:
        """The words of a stream; its number of symbols is not in them and must be kept beside.

        The last word may stand for more symbols than are left.

        Raises
        ------
        ValueError
            If a symbol's frequency was 0.
        """
        data = np.ascontiguousarray(symbols, dtype=np.uint8)
        ranks = np.full(256, -1, dtype=np.int32)
        ranks[self.symbols] = np.arange(len(self.symbols))
        out = np.empty(len(data), dtype=np.uint16)
        used = int(_kernels.encode(data, ranks, len(self.symbols), self.children, self.codes, out))
        if used < 0:
            raise ValueError(f"symbol {data[-1 - used]} has frequency 0 and no sequence in this code")
        if len(self.symbols) <= 1:
            return b""
        return pack_bits(out[:used], np.full(used, self.word_bits, dtype=np.uint8))

    def decode(self, data: bytes, count: int, /) -> NDArray[np.uint8]:
        """The first `count` symbols in `data`, which may be any bytes.

        A code of one symbol takes `count` at its word: bound it first where it comes from outside.

        Raises
        ------
        FovealError
            If `data` has too few words or one that the code lacks, before much is allocated.
        """
        if count < 0:
            raise ValueError(f"count must not be negative, got {count}")
        if len(self.symbols) == 0 and count:
            raise FovealError("a stream has symbols but no alphabet. Copy or build the file again.")
        if len(self.symbols) <= 1:
            return np.full(count, self.symbols[0] if count else 0, dtype=np.uint8)
        available = 8 * len(data) // self.word_bits
        if count > available * self.longest:
            raise FovealError("a stream of symbols ends too early. Copy or build the file again.")
        padded = np.zeros((len(data) + 3) // 4 + 2, dtype="<u4")
        padded.view(np.uint8)[: len(data)] = np.frombuffer(data, np.uint8)
        out = np.empty(count, dtype=np.uint8)
        words = padded.astype(np.uint32, copy=False)
        if _kernels.decode(words, self.word_bits, available, *self._table, out) < 0:
            raise FovealError("a stream of symbols is damaged. Copy or build the file again.")
        return out


def _check(counts: NDArray[np.generic], word_bits: int) -> None:
    if counts.ndim != 1 or len(counts) > 256 or (counts.size and counts.dtype.kind not in "iu"):
        raise ValueError(f"frequencies must be at most 256 integers, got {counts.dtype} {counts.shape}")
    if counts.size and (int(counts.min()) < 0 or int(counts.max()) >= 1 << 32):
        raise ValueError("a frequency must be in [0, 2^32)")
    if not 1 <= word_bits <= MAX_WORD_BITS:
        raise ValueError(f"word_bits must be 1 to {MAX_WORD_BITS}, got {word_bits}")


def _weights(counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Frequencies as whole numbers of 2^-16, at least one each."""
    if len(counts) == 0:
        return counts
    weights: NDArray[np.int64] = np.maximum((counts << _kernels.SCALE_BITS) // counts.sum(), 1)
    return weights
