"""A patch to bytes."""

import numpy as np
from numpy.typing import NDArray

from foveal.coding import _kernels_rans

from . import _kernels_encode
from . import _kernels_layout as layout
from .grown import Grown, grow
from .normals import predicted_normals
from .patch import Patch
from .tables import Tables

__all__ = ["coarse_grid", "encode", "events"]


def encode(patch: Patch, tables: Tables, /) -> bytes:
    """The bytes of `patch`: `spec/patch.md`.

    Vertices and triangles come out of `decode` in another order; corners of a triangle may be rotated.

    Examples
    --------
    >>> import numpy as np
    >>> from foveal.multires.codec import decode, encode, train
    >>> patch = Patch(np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0]], "i4"), np.array([[0, 1, 2]], "i4"))
    >>> tables = train([patch])
    >>> decode(encode(patch, tables), tables, has_normals=False, has_colours=False).positions.tolist()
    [[0, 0, 0], [9, 0, 0], [0, 9, 0]]
    """
    grown = grow(patch)
    coarse = coarse_grid(patch)
    contexts, values = events(patch, grown, coarse, tables.all_weights, tables.normal_bits)
    # A code is one operation and at most four more; a value at most four.
    operations = np.empty(len(grown.codes) + 4 * len(grown.extra) + 4 * len(values) + 8, np.int32)
    count = _kernels_encode.connectivity_operations(
        grown.codes, grown.code_contexts, len(grown.codes), grown.extra, tables.table_of, operations
    )
    count = _kernels_encode.value_operations(
        contexts,
        values,
        len(values),
        tables.table_of,
        tables.shift_of,
        tables.frequencies,
        operations,
        count,
    )
    words = np.empty(count + 4, np.uint16)
    at = _kernels_rans.write(
        operations, count, tables.frequencies, tables.starts, layout.PROBABILITY_BITS, words
    )
    if at < 0:
        raise ValueError("these tables give no room to a code; tables come from `train`")
    head = _varint(len(patch.positions)) + _varint(len(patch.faces)) + bytes([coarse])
    return head + words[at:].astype("<u2").tobytes()


def coarse_grid(patch: Patch, /) -> int:
    """The k for which saying "on multiples of 2^k" vertex by vertex saves most; 0 if nothing is saved."""
    counts = np.empty(layout.MOST_COARSE + 1, np.int64)
    positions = np.ascontiguousarray(patch.positions, np.int32)
    _kernels_encode.coarse_counts(positions, len(positions), counts)
    # Three coordinates of k bits each, against about 0.7 bits a vertex for saying which are.
    saved = 30 * np.arange(len(counts)) * counts - 7 * len(positions)
    saved[0] = 0
    return int(saved.argmax())


def events(
    patch: Patch, grown: Grown, coarse: int, weights: NDArray[np.int64], normal_bits: int, /
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Contexts and values of all that is coded after the connectivity."""
    n, used = len(patch.positions), grown.vertices
    positions = np.ascontiguousarray(patch.positions[grown.order], np.int32)
    each = 4 + (2 if patch.normals is not None else 0) + (3 if patch.colours is not None else 0)
    contexts = np.empty(each * n + 1, np.int32)
    values = np.empty(each * n + 1, np.int64)
    at = _kernels_encode.position_events(
        positions, grown.degree, grown.corners, used, weights, coarse, contexts, values
    )
    at += _kernels_encode.lone_events(positions, used, contexts[at:], values[at:])
    corners = np.full((n, 6), layout.FIRST, np.uint32)
    corners[:used] = grown.corners
    if patch.normals is not None:
        index = np.empty(n, np.int32)
        index[grown.order] = np.arange(n, dtype=np.int32)
        predicted = predicted_normals(positions, index[patch.faces], bits=normal_bits)
        normals = np.ascontiguousarray(patch.normals[grown.order], np.int16)
        at += _kernels_encode.normal_events(normals, predicted, grown.is_edge, n, contexts[at:], values[at:])
    if patch.colours is not None:
        colours = np.ascontiguousarray(patch.colours[grown.order], np.uint8)
        at += _kernels_encode.colour_events(
            colours, corners, n, np.empty((n, 3), np.int32), contexts[at:], values[at:]
        )
    return contexts[:at], values[:at]


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)
