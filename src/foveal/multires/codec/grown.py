"""A patch in the order in which its triangles are coded, with all that will be written about it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _kernels_connectivity
from . import _kernels_layout as layout
from .patch import Patch

__all__ = ["Grown", "grow"]


@dataclass(frozen=True, slots=True)
class Grown:
    """What the encoder knows of a patch's connectivity.

    Attributes
    ----------
    codes, code_contexts : (c,) uint8, (c,) int16
        The steps of the region growing, and their contexts.
    extra : (e,) int32
        Numbers that belong to codes, in order.
    order : (n,) int64
        order[i] is the vertex that comes out as vertex i; unused vertices come last.
    vertices : int
        How many of them are used by triangles.
    corners : (vertices, 6) uint32
        See `_kernels_geometry.predict`.
    degree : (n,) int32
        Triangles at each vertex, in the new order.
    is_edge : (n,) uint8
        Whether an edge there was coded as boundary, in the new order.
    """

    codes: NDArray[np.uint8]
    code_contexts: NDArray[np.int16]
    extra: NDArray[np.int32]
    order: NDArray[np.int64]
    vertices: int
    corners: NDArray[np.uint32]
    degree: NDArray[np.int32]
    is_edge: NDArray[np.uint8]


def grow(patch: Patch, /) -> Grown:
    """Find neighbours and grow a region over all triangles."""
    positions = np.ascontiguousarray(patch.positions, np.int32)
    faces = np.ascontiguousarray(patch.faces, np.int32)
    n, m = len(positions), len(faces)
    twin = np.empty(3 * m, np.int32)
    starts = np.empty(n + 2, np.int64)
    keys = np.empty(3 * m, np.int64)
    _kernels_connectivity.sort_edges(faces, starts, keys)
    _kernels_connectivity.pair_edges(positions, faces, starts, keys, twin)
    slots = 3 * m + 4
    steps = 4 * m + 4
    codes = np.empty(steps, np.uint8)
    contexts = np.empty(steps, np.int16)
    extra = np.empty(steps, np.int32)
    coded = np.empty(n + 1, np.int32)
    corners = np.empty((n + 1, 6), np.uint32)
    is_edge = np.zeros(n, np.uint8)
    degree = np.zeros(n, np.int32)
    index = np.full(n, -1, np.int32)
    count, extras, vertices = _kernels_connectivity.grow(
        faces,
        twin,
        np.zeros(m, np.uint8),
        index,
        degree,
        np.empty((slots, 5), np.int32),
        np.zeros(slots, np.uint8),
        np.full(3 * m, -1, np.int32),
        np.empty(slots, np.int32),
        codes,
        contexts,
        extra,
        coded,
        corners,
        is_edge,
    )
    new_order = np.concatenate([coded[:vertices].astype(np.int64), np.flatnonzero(index < 0)])
    return Grown(
        codes[:count],
        contexts[:count],
        extra[:extras],
        new_order,
        vertices,
        corners[:vertices],
        degree[new_order],
        is_edge[new_order],
    )


assert layout.START == layout.CODES  # the one step that is never coded as a symbol
