"""A light that shines everywhere: a cube of six maps."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .frames import MARGIN, NEAREST, checked_resolution, seen_from, through_window, unit, vector
from .projection import Projection
from .single_lights import Single, set_fields

__all__ = ["CUBE", "Point"]

CUBE = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
"""The axes of a point light's projections, in their order."""
_SEAM = 4
"""Pixels by which a face of the cube goes on beyond 90 degrees: a filter needs no pixel of the next one."""


@dataclass(frozen=True, slots=True)
class Point(Single):
    """A light at a place that shines everywhere: six maps around it, a cube.

    Attributes
    ----------
    position : (float, float, float)
        Where it stands.

    Raises
    ------
    FovealError
        If it is no number.

    Examples
    --------
    >>> light = Point((0, 0, 0))
    >>> light.face([[2, 1, 1], [-2, 1, 1], [1, 1, -1], [0, 0, 3]])
    array([0, 1, 0, 4])
    """

    position: tuple[float, float, float]

    def __post_init__(self) -> None:
        set_fields(self, position=vector("the light's position", self.position))

    def face(self, points: ArrayLike, /) -> NDArray[np.int64]:
        """(n,): which of the projections a point belongs to: +x, -x, +y, -y, +z, -z.

        The axis is that of the largest distance, of equal ones the first; spec/shadows.md has it too.
        """
        away = np.asarray(points, np.float64) - self.position
        axis: NDArray[np.int64] = np.abs(away).argmax(axis=1)
        is_behind = np.take_along_axis(away, axis[:, None], axis=1)[:, 0] < 0
        return 2 * axis + is_behind.astype(np.int64)

    def projections(self, positions: ArrayLike, resolution: int, /) -> tuple[Projection, ...]:
        """Six, in the order of `face`; each goes on beyond 90 degrees by 4 pixels or more a side."""
        checked_resolution(resolution)
        margin = min(0.125, max(MARGIN, _SEAM / resolution))
        seen = [seen_from(self.position, axis, positions) for axis in CUBE]
        far = float(np.abs(seen[0].points).max())
        # The scene lies within its box; where the light is outside, so much is free all around.
        low, high = seen[0].points.min(axis=0), seen[0].points.max(axis=0)
        free = float(np.maximum(low, -high).max())
        depths = max(free - MARGIN * (far - free), NEAREST * far), far
        square = ((-1.0, 1.0), (-1.0, 1.0))
        return tuple(through_window(face, square, depths, margin=margin) for face in seen)

    def towards(self, points: ArrayLike, /, image: int = 0) -> NDArray[np.float64]:
        """(n, 3): unit vectors from points to the light."""
        return unit(self.position - np.asarray(points, np.float64))

    def to_json(self) -> dict[str, Any]:
        """As files keep it."""
        return {"kind": "point", "position": list(self.position)}
