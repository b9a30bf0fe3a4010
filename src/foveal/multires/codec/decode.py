"""Bytes to a patch, whatever the bytes."""

import numpy as np

from foveal.base.errors import FovealError

from .patch import Patch
from .tables import Tables

__all__ = ["decode"]


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
    """The patch in `data`; vertices and triangles may come in another order than they were given in."""
    if len(data) < 8:
        raise FovealError("a patch ends too early. Copy or build the file again.")
    n, m = (int(v) for v in np.frombuffer(data, "<u4", 2))
    each = 12 + 4 * has_normals + 3 * has_colours
    if n > max_vertices or m > max_triangles or len(data) != 8 + each * n + 12 * m:
        raise FovealError("a patch's length does not fit its counts. Copy or build the file again.")
    at = 8
    positions = np.frombuffer(data, "<i4", 3 * n, at).reshape(n, 3).astype(np.int32)
    at += 12 * n
    faces = np.frombuffer(data, "<i4", 3 * m, at).reshape(m, 3).astype(np.int32)
    at += 12 * m
    normals = colours = None
    if has_normals:
        normals = np.frombuffer(data, "<i2", 2 * n, at).reshape(n, 2).astype(np.int16)
        at += 4 * n
    if has_colours:
        colours = np.frombuffer(data, "u1", 3 * n, at).reshape(n, 3).copy()
    if m and (faces.min() < 0 or faces.max() >= n):
        raise FovealError(
            "a patch's triangle names a vertex that is not there. Copy or build the file again."
        )
    return Patch(positions, faces, normals, colours)
