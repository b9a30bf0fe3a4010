"""The triangle mesh all rooms pass around: plain arrays, no behaviour beyond checking itself."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

__all__ = ["TriMesh"]


@dataclass(frozen=True, slots=True)
class TriMesh:
    """Triangles over shared vertices.

    Any triangles: open, non-manifold, degenerate and duplicate ones are all meshes. Use
    `TriMesh.of` on data from outside; the constructor itself checks nothing.

    Attributes
    ----------
    positions : (n, 3) float64
        In the unit and axes of the file they came from.
    faces : (m, 3) int32
        Vertex indices in [0, n), counter-clockwise seen from outside.
    normals : (n, 3) float32 or None
        Unit length, or zero where a vertex has none.
    colours : (n, 3) uint8 or None
        sRGB, 0 to 255.
    uvs : (n, 2) float32 or None
        Texture coordinates, from the lower left: patches of polygons have them, and PLY and GLB are written
        with them. What reads, simplifies or draws meshes leaves them out.

    Examples
    --------
    >>> mesh = TriMesh.of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> len(mesh.positions), len(mesh.faces)
    (3, 1)
    """

    positions: NDArray[np.float64]
    faces: NDArray[np.int32]
    normals: NDArray[np.float32] | None = None
    colours: NDArray[np.uint8] | None = None
    uvs: NDArray[np.float32] | None = None

    @classmethod
    def of(
        cls,
        positions: ArrayLike,
        faces: ArrayLike,
        /,
        *,
        normals: ArrayLike | None = None,
        colours: ArrayLike | None = None,
        name: str = "mesh",
    ) -> "TriMesh":
        """Check arrays from outside and hold them as contiguous arrays of the right types.

        Normals are made unit, or zero where they are not finite.

        Raises
        ------
        FovealError
            In a sentence that begins with `name`: a wrong shape or type, NaN or infinite coordinates, an
            index that is not a vertex, colours that are no bytes, or no triangle at all.
        """
        points = _numbers("positions", positions, -1, name).astype(np.float64, copy=False)
        triangles = np.ascontiguousarray(faces)
        if triangles.ndim != 2 or triangles.shape[1:] != (3,) or triangles.dtype.kind not in "iu":
            raise FovealError(
                f"{name}: faces must be integers of shape (m, 3), got {triangles.dtype} {triangles.shape}."
            )
        if len(triangles) == 0:
            raise FovealError(f"{name}: there is no triangle in it.")
        bad = ~np.isfinite(points).all(axis=1)
        if bad.any():
            raise FovealError(f"{name}: vertex {int(bad.argmax())} has a coordinate that is NaN or infinite.")
        low, high = int(triangles.min()), int(triangles.max())
        if low < 0 or high >= len(points):
            wrong = low if low < 0 else high
            raise FovealError(
                f"{name}: a triangle names vertex {wrong}, but vertices go from 0 to {len(points) - 1}."
            )
        return cls(
            points,
            triangles.astype(np.int32, copy=False),
            _normals(normals, len(points), name),
            _colours(colours, len(points), name),
        )


def _normals(values: ArrayLike | None, count: int, name: str) -> NDArray[np.float32] | None:
    if values is None:
        return None
    from .normals import unit_normals  # which knows meshes, so that it cannot come first

    array = _numbers("normals", values, count, name).astype(np.float64)
    # Those of a file are unit but for rounding, and stay as they are.
    length = np.linalg.norm(array, axis=1, keepdims=True)
    return np.where(abs(length - 1) < 1e-3, array, unit_normals(array)).astype(np.float32)


def _colours(values: ArrayLike | None, count: int, name: str) -> NDArray[np.uint8] | None:
    if values is None:
        return None
    array = _numbers("colours", values, count, name)
    if not ((array >= 0) & (array <= 255) & (array == np.floor(array))).all():
        raise FovealError(
            f"{name}: colours must be whole numbers from 0 to 255. From 0 to 1, multiply by 255 and round."
        )
    return array.astype(np.uint8, copy=False)


def _numbers(what: str, values: ArrayLike, count: int, name: str) -> NDArray[Any]:
    """(count, 3), or of any length for -1, contiguous, of any real type."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of several lengths
        raise FovealError(
            f"{name}: {what} must have shape (n, 3), each row as long as the others."
        ) from error
    if array.dtype.kind not in "biuf":
        raise FovealError(f"{name}: {what} must be real numbers, got {array.dtype}.")
    if array.ndim != 2 or array.shape[1] != 3 or count not in (len(array), -1):
        raise FovealError(
            f"{name}: {what} must have shape ({'n' if count < 0 else count}, 3), got {array.shape}."
        )
    return np.ascontiguousarray(array)
