"""Static range coding (rANS): integer frequencies in, integer tables out, the same on every machine.

Two states share one stream of 16-bit words, so that a decoder can work on two symbols at once. The loops
are in `_kernels_rans.py`.

Based on: Duda. Asymmetric numeral systems: entropy coding combining speed of Huffman coding with
compression rate of arithmetic coding. 2013.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _kernels_rans

__all__ = ["normalise", "slot_table", "starts"]


def normalise(counts: ArrayLike, /, *, bits: int) -> NDArray[np.int32]:
    """Frequencies that sum to 2^bits, at least 1 where a count is above 0, and 0 where it is 0.

    Parameters
    ----------
    counts : (symbols,) int
        At least one above 0, and not more of them than 2^bits.

    Examples
    --------
    >>> normalise([6, 0, 1, 1], bits=4)
    array([12,  0,  2,  2], dtype=int32)
    >>> normalise([1000, 1], bits=4)
    array([15,  1], dtype=int32)
    """
    amounts = np.asarray(counts, dtype=np.int64)
    total = int(amounts.sum())
    if amounts.ndim != 1 or total <= 0 or amounts.min() < 0 or np.count_nonzero(amounts) > 1 << bits:
        raise ValueError("counts must be (symbols,), at least 0, some above 0, at most 2^bits of those")
    shared = amounts << bits
    frequencies: NDArray[np.int64] = np.maximum(shared // total, shared > 0)
    # What rounding left over goes where it helps most; what the floors took too much comes from the largest.
    while (missing := (1 << bits) - int(frequencies.sum())) != 0:
        if missing > 0:
            frequencies[np.argmax(shared / (frequencies + 0.5))] += 1
        else:
            frequencies[np.argmin(np.where(frequencies > 1, shared / (frequencies - 0.5), np.inf))] -= 1
    return frequencies.astype(np.int32)


def starts(frequencies: NDArray[np.int32], /) -> NDArray[np.int32]:
    """The first slot of each symbol, for tables of frequencies (tables, symbols)."""
    return np.ascontiguousarray(np.cumsum(frequencies, axis=1, dtype=np.int32) - frequencies)


def slot_table(frequencies: NDArray[np.int32], /, *, bits: int) -> NDArray[np.uint32]:
    """(tables, 2^bits) what a decoder looks up: symbol, frequency and place within the symbol's slots.

    Each row of `frequencies` sums to 2^bits, with bits at most 11.
    """
    out = np.empty((len(frequencies), 1 << bits), np.uint32)
    _kernels_rans.slot_table(frequencies, bits, out)
    return out
