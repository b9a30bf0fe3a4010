"""Bytes in the paper's coding to a patch, whatever the bytes."""

import numpy as np
from numpy.typing import NDArray

from foveal.coding.bits import decode_signed, decode_vectors, unpack_bits
from foveal.multires.codec import Patch

from . import _kernels_front, _kernels_predict
from .encode import HAS_COLOURS, HAS_NORMALS, PER_COMPONENT, _beside
from .streams import Reader

__all__ = ["decode"]


def decode(data: bytes, /, *, max_vertices: int = 1 << 20, max_triangles: int = 1 << 21) -> Patch:
    """The patch in `data`, with vertices in the order in which the walk meets them.

    Parameters
    ----------
    data : bytes
        From `encode`, or anything.
    max_vertices, max_triangles : int
        A patch that claims more is refused before anything is allocated for it.

    Raises
    ------
    FovealError
        If the bytes are no patch, or one that is too large.

    Examples
    --------
    >>> from foveal.multires.paper import encode
    >>> corners = np.array([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], np.int32)
    >>> again = decode(encode(Patch(corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32))))
    >>> again.positions.tolist(), again.faces.tolist()
    ([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], [[0, 1, 2], [0, 2, 3]])
    """
    reader = Reader(data)
    flags = reader.byte()
    reader.word_bits = reader.byte()
    normal_bits = reader.byte()
    if flags > 7 or not 6 <= reader.word_bits <= 12 or not 4 <= normal_bits <= 14:
        raise reader.fault()
    n, m, count = reader.number(), reader.number(), reader.number()
    if n > max_vertices or m > max_triangles or not m <= count <= 9 * m:
        raise reader.fault()
    base = np.array([reader.signed() for _ in range(3)], dtype=np.int64)
    faces, corners = _walk(reader, n, m, count)
    per_component = bool(flags & PER_COMPONENT)
    positions = _read_differences(reader, n, 3, per_component)
    _kernels_predict.restore(positions, corners, base)
    normals = colours = None
    if flags & HAS_NORMALS:
        values = _read_differences(reader, n, 2, per_component)
        guess = np.empty((n, 2), dtype=np.int32)
        most = (1 << (normal_bits - 1)) - 1
        _kernels_predict.guess_normals(positions, faces, most, np.zeros((n, 3), np.int64), guess)
        normals = (values + guess).astype(np.int16)
    if flags & HAS_COLOURS:
        values = _read_differences(reader, n, 3, True)
        _kernels_predict.restore(values, _beside(corners), np.zeros(3, np.int64))
        colours = np.empty((n, 3), dtype=np.uint8)
        if not _kernels_predict.from_luma(values, colours):
            raise reader.fault()
    reader.end()
    return Patch(positions, faces, normals, colours)


def _walk(reader: Reader, n: int, m: int, count: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Triangles, and the predictors of all vertices."""
    symbols = reader.symbols(count)
    raw = reader.raw()
    # An index has as many bits as tell the vertices apart that were met before it.
    widths = _split_widths(symbols)
    splits = unpack_bits(raw, widths).astype(np.int32)
    faces = np.empty((m, 3), dtype=np.int32)
    corners = np.empty((n, 3), dtype=np.int32)
    front = np.empty((3 * m, 7), dtype=np.int32)
    met, used = _kernels_front.decode(symbols, splits, n, front, np.empty(3 * m, np.int32), faces, corners)
    if met < 0 or used != len(splits):
        raise reader.fault()
    corners[met:] = np.arange(met - 1, n - 1, dtype=np.int32)[:, None]
    return faces, corners


def _split_widths(symbols: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Bits of each split's index, from how many VERTEX symbols precede it."""
    at = np.flatnonzero(symbols == _kernels_front.SPLIT)
    if not len(at):
        return np.zeros(0, dtype=np.uint8)
    met = np.cumsum(symbols == _kernels_front.VERTEX, dtype=np.int32)[at]
    # frexp gives the bit length: that of met - 1 is the least b with met <= 2^b.
    return np.frexp(np.maximum(met - 1, 0).astype(np.float64))[1].astype(np.uint8)


def _read_differences(reader: Reader, n: int, across: int, per_component: bool) -> NDArray[np.int32]:
    if not per_component:
        classes = reader.symbols(n)
        return decode_vectors(classes, reader.raw(), across)
    out = np.empty((n, across), dtype=np.int32)
    for component in range(across):
        classes = reader.symbols(n)
        out[:, component] = decode_signed(classes, reader.raw())
    return out
