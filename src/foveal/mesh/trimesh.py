"""The triangle mesh all rooms pass around: plain arrays, no behaviour beyond checking itself."""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

__all__ = ["TriMesh"]

Scalar = TypeVar("Scalar", bound=np.generic)


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

        Raises
        ------
        FovealError
            In a sentence that begins with `name`: a wrong shape, NaN or infinite coordinates, an index
            that is not a vertex, or no triangle at all.
        """
        points = np.ascontiguousarray(positions, dtype=np.float64)
        triangles = np.ascontiguousarray(faces)
        if points.ndim != 2 or points.shape[1:] != (3,):
            raise FovealError(f"{name}: positions must have shape (n, 3), got {points.shape}.")
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
            _attribute("normals", normals, np.float32, len(points), name),
            _attribute("colours", colours, np.uint8, len(points), name),
        )


def _attribute(
    what: str, values: ArrayLike | None, dtype: type[Scalar], count: int, name: str
) -> NDArray[Scalar] | None:
    if values is None:
        return None
    array: NDArray[Scalar] = np.ascontiguousarray(values, dtype=dtype)
    if array.shape != (count, 3):
        raise FovealError(f"{name}: {what} must have shape ({count}, 3), got {array.shape}.")
    return array
