"""Bytes to a patch, whatever the bytes."""

import numpy as np

from foveal.base.errors import FovealError

from . import _kernels_decode, _kernels_geometry
from . import _kernels_layout as layout
from .patch import Patch
from .tables import Tables

__all__ = ["decode"]

_LOW = 1 << 16  # both states when all is read


def decode(
    data: bytes,
    tables: Tables,
    /,
    *,
    has_normals: bool,
    has_colours: bool,
    max_vertices: int = 1 << 20,
    max_triangles: int = 1 << 21,
) -> Patch:
    """The patch in `data`; vertices and triangles come in the order in which they were coded.

    Parameters
    ----------
    data : bytes
        What `encode` gave, whole.
    tables : Tables
        Those it was given.
    has_normals, has_colours : bool
        Whether the patch was encoded with them; the file's header says so.
    max_vertices, max_triangles : int
        More than these are refused before anything is allocated.

    Raises
    ------
    FovealError
        If the bytes are not a patch.
    """
    n, at = _varint(data, 0)
    m, at = _varint(data, at)
    if n > max_vertices or m > max_triangles:
        raise FovealError(
            f"a patch of {n} vertices and {m} triangles is larger than a file may hold "
            f"({max_vertices} and {max_triangles}). Copy or build the file again."
        )
    coarse = data[at] if at < len(data) else 0
    at += 1
    if len(data) < at + 8 or (len(data) - at) % 2 or coarse > layout.MOST_COARSE:
        raise FovealError("a patch ends too early. Copy or build the file again.")
    words = np.zeros((len(data) - at) // 2 + 1, np.uint16)  # the one at the end is read again past it
    words[:-1] = np.frombuffer(data, "<u2", offset=at)
    a, b = int(words[0]) | int(words[1]) << 16, int(words[2]) | int(words[3]) << 16
    if a < _LOW or b < _LOW:
        raise FovealError(_DAMAGED)
    slots, table_of, shift_of = tables.slots, tables.table_of, tables.shift_of
    faces = np.empty((m, 3), np.int32)
    corners = np.empty((n, 6), np.uint32)
    degree = np.zeros(n, np.int32)
    is_edge = np.zeros(n, np.uint8)
    front = np.empty((3 * m + 4, 4), np.int32)
    state = np.zeros(3 * m + 4, np.uint8)
    stack = np.empty(m + 1, np.int32)
    vertices, a, at = _kernels_decode.connectivity(
        words, a, 4, slots, table_of, faces, corners, degree, is_edge, front, state, stack
    )
    if vertices < 0 or at >= len(words):
        raise FovealError(_DAMAGED)
    positions = np.empty((n, 3), np.int32)
    a, b, at = _kernels_decode.geometry(
        words,
        a,
        b,
        at,
        slots,
        table_of,
        shift_of,
        tables.all_weights,
        coarse,
        corners,
        degree,
        vertices,
        positions,
    )
    normals = colours = None
    if has_normals:
        most = (1 << (tables.normal_bits - 1)) - 1
        sums = np.empty((n, 3), np.int64)
        normals = np.empty((n, 2), np.int16)
        _kernels_geometry.vertex_normals(positions, faces, sums)
        _kernels_geometry.predicted_octahedral(sums, most, normals)
        a, b, at = _kernels_decode.normals(words, a, b, at, slots, table_of, shift_of, is_edge, most, normals)
    if has_colours:
        colours = np.empty((n, 3), np.uint8)
        ycc = np.empty((n, 3), np.int32)
        a, b, at = _kernels_decode.colours(
            words, a, b, at, slots, table_of, shift_of, corners, vertices, ycc, colours
        )
    if a != _LOW or b != _LOW or at != len(words) - 1:
        raise FovealError(_DAMAGED)
    return Patch(positions, faces, normals, colours)


_DAMAGED = "a patch is damaged: its bytes do not add up. Copy or build the file again."


def _varint(data: bytes, at: int) -> tuple[int, int]:
    value = 0
    for shift in range(0, 35, 7):
        if at >= len(data):
            raise FovealError("a patch ends too early. Copy or build the file again.")
        value |= (data[at] & 127) << shift
        at += 1
        if data[at - 1] < 128:
            return value, at
    raise FovealError(_DAMAGED)
