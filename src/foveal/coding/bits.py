"""Streams of bits, and signed numbers as a class to entropy-code and raw bits to copy.

**Order.** A stream is little-endian words of 32 bits; the first bit written is the lowest bit of the
first word, and a number's low bits come first. The last word is cut to the bytes that hold bits, and
the bits left over in the last byte are 0.

**Signed numbers** (`encode_signed`). The class k of v is the bit length of |v|: 0 for 0, else
2^(k-1) <= |v| < 2^k. The k raw bits are v itself where v is positive and v + 2^k - 1 where it is
negative, so the top raw bit says "positive", and -2^k belongs to class k + 1 as 2^k does.

**Vectors** (`encode_vectors`). One class a row: the least k with -2^(k-1) <= v < 2^(k-1) for every
component, and 0 for a row of zeros; then k raw bits of v + 2^(k-1) for each component.

The idea of coding the place of the highest bit and copying the rest: Ponchio and Dellepiane, Fast
decompression for web-based view-dependent 3D rendering, 2015, section 3.3.2.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from . import _kernels_bits

__all__ = [
    "MAX_CLASS",
    "decode_signed",
    "decode_vectors",
    "encode_signed",
    "encode_vectors",
    "pack_bits",
    "unpack_bits",
]

MAX_CLASS = 32
"""The greatest class of an int32; a stream that names a greater one is refused."""

_TOO_SHORT = "a stream of bits ends too early. Copy or build the file again."


def pack_bits(values: ArrayLike, widths: ArrayLike, /) -> bytes:
    """Write the low `widths[i]` bits of each `values[i]`.

    Parameters
    ----------
    values : (n,) int, in [0, 2^32)
    widths : (n,) int, in [0, 32]

    Raises
    ------
    ValueError
        If the shapes differ or a width is out of range.

    Examples
    --------
    >>> pack_bits([1, 2, 255], [1, 3, 8]).hex()
    'f50f'
    """
    numbers = np.ascontiguousarray(values, dtype=np.uint32)
    lengths = np.ascontiguousarray(widths, dtype=np.uint8)
    if numbers.shape != lengths.shape or numbers.ndim != 1:
        raise ValueError(f"values and widths must be (n,) alike, got {numbers.shape} and {lengths.shape}")
    if lengths.size and lengths.max() > 32:
        raise ValueError(f"a width must be at most 32, got {lengths.max()}")
    total = int(lengths.sum(dtype=np.int64))
    words = np.zeros(total // 32 + 1, dtype=np.uint32)
    _kernels_bits.pack(numbers, lengths, words)
    return words.astype("<u4").tobytes()[: (total + 7) // 8]


def unpack_bits(data: bytes, widths: ArrayLike, /) -> NDArray[np.uint32]:
    """Read numbers of `widths[i]` bits from what `pack_bits` wrote.

    Raises
    ------
    FovealError
        If `data` holds fewer bits than that, or a width is over 32.

    Examples
    --------
    >>> unpack_bits(bytes.fromhex("f50f"), [1, 3, 8]).tolist()
    [1, 2, 255]
    """
    lengths = np.ascontiguousarray(widths, dtype=np.uint8)
    words = _words(data, lengths, 1)
    out = np.empty(len(lengths), dtype=np.uint32)
    _kernels_bits.unpack(words, lengths, out)
    return out


def encode_signed(values: ArrayLike, /) -> tuple[NDArray[np.uint8], bytes]:
    """Class of each number, and the raw bits of all of them.

    Parameters
    ----------
    values : (n,) int32

    Returns
    -------
    classes : (n,) uint8, in [0, 32]
    raw : bytes

    Examples
    --------
    >>> classes, raw = encode_signed([0, 1, -1, -4, 3])
    >>> classes.tolist(), raw.hex()
    ([0, 1, 1, 3, 2], '6d')
    >>> decode_signed(classes, raw).tolist()
    [0, 1, -1, -4, 3]
    """
    numbers = np.ascontiguousarray(values, dtype=np.int32)
    classes = np.empty(len(numbers), dtype=np.uint8)
    raw = np.empty(len(numbers), dtype=np.uint32)
    _kernels_bits.signed_classes(numbers, classes, raw)
    return classes, pack_bits(raw, classes)


def decode_signed(classes: ArrayLike, raw: bytes, /) -> NDArray[np.int32]:
    """The (n,) numbers of `encode_signed`; `FovealError` if the raw bits do not suffice."""
    lengths = np.ascontiguousarray(classes, dtype=np.uint8)
    words = _words(raw, lengths, 1)
    out = np.empty(len(lengths), dtype=np.int32)
    _kernels_bits.signed_values(lengths, words, out)
    return out


def encode_vectors(values: ArrayLike, /) -> tuple[NDArray[np.uint8], bytes]:
    """Class of each row, and the raw bits of all components, row by row.

    Parameters
    ----------
    values : (n, d) int32

    Examples
    --------
    >>> classes, raw = encode_vectors([[0, 0], [-1, 0], [2, -3]])
    >>> classes.tolist(), raw.hex()
    ([0, 1, 3], '3a')
    >>> decode_vectors(classes, raw, 2).tolist()
    [[0, 0], [-1, 0], [2, -3]]
    """
    rows = np.ascontiguousarray(values, dtype=np.int32)
    classes = np.empty(len(rows), dtype=np.uint8)
    raw = np.empty(rows.size, dtype=np.uint32)
    widths = np.empty(rows.size, dtype=np.uint8)
    _kernels_bits.vector_classes(rows, classes, raw, widths)
    return classes, pack_bits(raw, widths)


def decode_vectors(classes: ArrayLike, raw: bytes, across: int, /) -> NDArray[np.int32]:
    """The (n, `across`) rows of `encode_vectors`; `FovealError` if the raw bits do not suffice."""
    lengths = np.ascontiguousarray(classes, dtype=np.uint8)
    words = _words(raw, lengths, across)
    out = np.empty((len(lengths), across), dtype=np.int32)
    _kernels_bits.vector_values(lengths, words, out)
    return out


def _words(data: bytes, widths: NDArray[np.uint8], times: int) -> NDArray[np.uint32]:
    """`data` as words with two more at the end, once it is sure that it holds all the bits."""
    if widths.size and widths.max() > MAX_CLASS:
        raise FovealError("a number in a stream has more than 32 bits. Copy or build the file again.")
    total = times * int(widths.sum(dtype=np.int64))
    if total > 8 * len(data):
        raise FovealError(_TOO_SHORT)
    padded = np.zeros((len(data) + 3) // 4 + 2, dtype="<u4")
    padded.view(np.uint8)[: len(data)] = np.frombuffer(data, np.uint8)
    return padded.astype(np.uint32, copy=False)
