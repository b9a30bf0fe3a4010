"""A patch to bytes, in the paper's coding."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foveal.coding.bits import encode_signed, encode_vectors, pack_bits
from foveal.multires.codec import Patch

from . import _kernels_front, _kernels_predict, _kernels_topology
from .streams import Writer

__all__ = ["HAS_COLOURS", "HAS_NORMALS", "PER_COMPONENT", "encode", "stream_sizes"]

HAS_NORMALS, HAS_COLOURS, PER_COMPONENT = 1, 2, 4
"""Flags of the first byte."""


def encode(
    patch: Patch,
    /,
    *,
    word_bits: int = 12,
    normal_bits: int = 10,
    classes: Literal["vertex", "component"] = "vertex",
    may_delay: bool = True,
) -> bytes:
    """Code a patch as the paper does; `decode` gives it back with vertices and triangles reordered.

    Parameters
    ----------
    patch : Patch
        Any triangles. Vertices without one come last.
    word_bits : int
        Bits of Tunstall's words, 6 to 12.
    normal_bits : int
        Bits of each octahedral coordinate which the estimated normals get, 4 to 14.
    classes : "vertex" or "component"
        Whether position and normal differences have one log2 class a vertex (as the published program
        does, and faster) or one a component (as the paper's text reads, and smaller).
    may_delay : bool
        Whether an edge whose triangle would be a split is left for later, as the published program
        does. Without it a quarter of all vertices are splits.

    References
    ----------
    Ponchio, F. and Dellepiane, M. (2015). Fast decompression for web-based view-dependent 3D rendering.
    Proc. Web3D, section 3.3.

    Examples
    --------
    >>> import numpy as np
    >>> corners = np.array([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], np.int32)
    >>> patch = Patch(corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32))
    >>> len(encode(patch, word_bits=8))
    31
    """
    return bytes(_write(patch, word_bits, normal_bits, classes, may_delay).data)


def stream_sizes(
    patch: Patch,
    /,
    *,
    word_bits: int = 12,
    normal_bits: int = 10,
    classes: Literal["vertex", "component"] = "vertex",
    may_delay: bool = True,
) -> dict[str, int]:
    """Bytes that each stream of `encode` takes with these options, tables included."""
    writer = _write(patch, word_bits, normal_bits, classes, may_delay)
    return {"header": len(writer.data) - sum(writer.sizes.values()), **writer.sizes}


def _write(patch: Patch, word_bits: int, normal_bits: int, classes: str, may_delay: bool) -> Writer:
    if not 6 <= word_bits <= 12:
        raise ValueError(f"word_bits must be 6 to 12, got {word_bits}")
    if not 4 <= normal_bits <= 14:
        raise ValueError(f"normal_bits must be 4 to 14, got {normal_bits}")
    if classes not in ("vertex", "component"):
        raise ValueError(f'classes must be "vertex" or "component", got {classes!r}')
    faces = np.ascontiguousarray(patch.faces, dtype=np.int32)
    n = len(patch.positions)
    if faces.size and (faces.min() < 0 or faces.max() >= n):
        raise ValueError(f"faces must name vertices in [0, {n})")
    order, corners, symbols, splits, split_bits = _walk(faces, n, may_delay)
    positions = np.ascontiguousarray(patch.positions[order], dtype=np.int32)
    base = (positions[0] if n else np.zeros(3)).astype(np.int64)

    writer = Writer(word_bits)
    per_component = classes == "component"
    flags = HAS_NORMALS * (patch.normals is not None) | HAS_COLOURS * (patch.colours is not None)
    writer.data += bytes([flags | PER_COMPONENT * per_component, word_bits, normal_bits])
    for number in (n, len(faces), len(symbols)):
        writer.number(number)
    for axis in range(3):
        writer.signed(int(base[axis]))
    writer.symbols("connectivity", symbols)
    writer.raw("splits", pack_bits(splits, split_bits))

    differences = np.empty((n, 3), dtype=np.int32)
    _kernels_predict.residuals(positions, corners, base, differences)
    _write_differences(writer, "position", differences, per_component)
    if patch.normals is not None:
        places = np.empty(n, dtype=np.int32)
        places[order] = np.arange(n, dtype=np.int32)
        guess = np.empty((n, 2), dtype=np.int32)
        most = (1 << (normal_bits - 1)) - 1
        _kernels_predict.guess_normals(positions, places[faces], most, np.zeros((n, 3), np.int64), guess)
        _write_differences(writer, "normal", patch.normals[order].astype(np.int32) - guess, per_component)
    if patch.colours is not None:
        luma = np.empty((n, 3), dtype=np.int32)
        _kernels_predict.to_luma(patch.colours[order], luma)
        _kernels_predict.residuals(luma, _beside(corners), np.zeros(3, np.int64), differences)
        _write_differences(writer, "colour", differences, True)
    return writer


def _walk(
    faces: NDArray[np.int32], n: int, may_delay: bool
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.uint8], NDArray[np.int32], NDArray[np.uint8]]:
    """New order of the vertices, their predictors, and the walk's symbols, splits and widths of those."""
    m = len(faces)
    halves = 3 * m
    twins = np.empty(halves, dtype=np.int32)
    low, high, edges, spare = np.empty((4, halves), dtype=np.int32)
    _kernels_topology.pair_edges(faces, low, high, edges, spare, np.empty(n + 2, np.int32), twins)
    ids = np.full(n, -1, dtype=np.int32)
    order = np.empty(n, dtype=np.int32)
    corners = np.empty((n, 3), dtype=np.int32)
    symbols = np.empty(9 * m, dtype=np.uint8)
    splits = np.empty(halves, dtype=np.int32)
    split_bits = np.empty(halves, dtype=np.uint8)
    counts = np.zeros(4, dtype=np.int64)
    front = np.empty((halves, 7), dtype=np.int32)
    visited = np.zeros(m, dtype=np.uint8)
    _kernels_front.encode(
        faces, twins, front, visited, ids, order, corners, symbols, splits, split_bits, counts,
        np.empty(halves, np.int32), may_delay,
    )  # fmt: skip
    met = int(counts[0])
    order[met:] = np.flatnonzero(ids < 0)
    corners[met:] = np.arange(met - 1, n - 1, dtype=np.int32)[:, None]
    return order, corners, symbols[: counts[1]], splits[: counts[2]], split_bits[: counts[2]]


def _beside(corners: NDArray[np.int32]) -> NDArray[np.int32]:
    """Predictors that are the edge's first corner alone, for colours."""
    return np.ascontiguousarray(np.repeat(corners[:, :1], 3, axis=1))


def _write_differences(
    writer: Writer, name: str, differences: NDArray[np.int32], per_component: bool
) -> None:
    """Classes as symbols, then raw bits; `per_component` gives each component streams of its own."""
    if not per_component:
        classes, raw = encode_vectors(differences)
        writer.symbols(f"{name} classes", classes)
        writer.raw(f"{name} raw bits", raw)
        return
    for component in differences.T:
        classes, raw = encode_signed(component)
        writer.symbols(f"{name} classes", classes)
        writer.raw(f"{name} raw bits", raw)
