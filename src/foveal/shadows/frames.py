"""Projections that are tight around a scene: parallel, oblique, perspective and off-axis."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from .projection import Projection

__all__ = [
    "MOST_RESOLUTION",
    "NEAREST",
    "Seen",
    "basis",
    "checked_resolution",
    "cone_window",
    "parallel",
    "seen_along",
    "seen_from",
    "span",
    "through_window",
    "unit",
    "vector",
]

MOST_RESOLUTION = 1 << 20
MARGIN = 2.0**-10
"""What stays free at each end of u, v and depth, so that rounding never brings a point off the map, and none
to the last depths, which mean that nothing was hit. The same at every resolution: pixels of a map are the
quarters of those of a map half as large."""
NEAREST = 2.0**-20
"""Share of the farthest distance within which a light at a place sees nothing: there it would stand in it."""


def checked_resolution(resolution: int, /, *, images: int = 1) -> int:
    """A number of pixels a side that a map can have.

    Raises
    ------
    FovealError
        If it is no power of two from 2 to 1,048,576, or less than the images of a stack.
    """
    is_whole = isinstance(resolution, (int, np.integer)) and not isinstance(resolution, bool)
    if not is_whole or not 2 <= resolution <= MOST_RESOLUTION or resolution & (resolution - 1):
        near = 2 ** min(20, max(1, round(math.log2(resolution)))) if is_whole and resolution > 0 else 4096
        raise FovealError(
            f"the resolution must be a power of two from 2 to {MOST_RESOLUTION}, got {resolution}. "
            f"Take {near}."
        )
    if images > resolution:
        raise FovealError(
            f"a stack of {images} images needs a resolution of at least as much, got {resolution}. "
            "Choose fewer, or a higher resolution."
        )
    return int(resolution)


def vector(what: str, value: ArrayLike, /) -> tuple[float, float, float]:
    """Three numbers.

    Raises
    ------
    FovealError
        If there are not three, or one is not finite.
    """
    try:
        numbers = np.asarray(value, np.float64)
    except (TypeError, ValueError) as error:
        raise FovealError(f"{what} must be three numbers, got {value!r:.60}.") from error
    if numbers.shape != (3,) or not np.isfinite(numbers).all() or np.abs(numbers).max() > 1e100:
        raise FovealError(f"{what} must be three numbers, got {value!r:.60}.")
    x, y, z = numbers.tolist()
    return x, y, z


def unit(vectors: NDArray[np.float64], /) -> NDArray[np.float64]:
    """(..., 3) vectors at length 1; zero stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0, lengths, 1.0)


def basis(axis: ArrayLike, /) -> NDArray[np.float64]:
    """(3, 3): a row each for right, up and ahead, which is `axis`, of unit length.

    Up leans to y, or where that is all but ahead or behind, to -z and z, so that what looks down has x to the
    right. Right x up is against ahead: what is counter-clockwise to the light is so in (u, v).
    """
    ahead = unit(np.asarray(axis, np.float64))
    lean = np.array([0.0, 1.0, 0.0])
    if abs(ahead[1]) > 0.99:
        lean = np.array([0.0, 0.0, math.copysign(1.0, ahead[1])])
    right = unit(np.cross(ahead, lean))
    return np.stack([right, np.cross(right, ahead), ahead])


@dataclass(frozen=True, slots=True)
class Seen:
    """A scene's points as a light sees them.

    Attributes
    ----------
    rows : (3, 3) float64
        As `basis` gives them.
    origin : (3,) float64
        Where the light stands; for parallel light the middle of the scene's depths.
    points : (n, 3) float64
        To the right, up and ahead of there.
    """

    rows: NDArray[np.float64]
    origin: NDArray[np.float64]
    points: NDArray[np.float64]

    def extremes(self, axis: int, slopes: tuple[float, float] = (0.0, 0.0), /) -> tuple[float, float]:
        """Least and largest of a coordinate where each point is moved along the slope onto the middle plane.

        The largest of functions that are linear in the slope is convex in it: its ends are enough.
        """
        moved = [self.points[:, axis] - slope * self.points[:, 2] for slope in sorted({*slopes})]
        return min(float(m.min()) for m in moved), max(float(m.max()) for m in moved)

    def functional(self, row: NDArray[np.float64], constant: float) -> NDArray[np.float64]:
        """(4,): of a function of right, up and ahead, that of x, y, z and 1."""
        world = row @ self.rows
        return np.append(world, constant - world @ self.origin)


def _positions(positions: ArrayLike) -> NDArray[np.float64]:
    points = np.asarray(positions, np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"positions must have shape (n, 3), got {points.shape}")
    if len(points) == 0:
        raise FovealError("there is nothing that the light could fall on. Name a scene that has triangles.")
    if not np.isfinite(points).all():
        raise FovealError("a position is no number. Correct the mesh.")
    return points


def seen_along(direction: ArrayLike, positions: ArrayLike, /) -> Seen:
    """Points before parallel light."""
    rows, points = basis(direction), _positions(positions)
    # Relative to a place among the points first: a scene may be far from where its coordinates begin.
    first = points[0]
    ahead = (points - first) @ rows[2]
    origin = first + rows[2] * (float(ahead.min()) + float(ahead.max())) / 2
    return Seen(rows, origin, (points - origin) @ rows.T)


def seen_from(place: ArrayLike, axis: ArrayLike, positions: ArrayLike, /) -> Seen:
    """Points before a light that stands at a place.

    Raises
    ------
    FovealError
        If it stands at one of them.
    """
    rows, origin, points = basis(axis), np.asarray(place, np.float64), _positions(positions)
    local = (points - origin) @ rows.T
    distances = np.abs(local).max(axis=1)
    if distances.min() <= NEAREST * distances.max():
        raise FovealError("the light stands at a vertex of what it lights. Move it.")
    return Seen(rows, origin, local)


def span(low: float, high: float, margin: float = MARGIN, /, *, least: float = 0.0) -> tuple[float, float]:
    """Scale and offset that take [low, high], or `least` around its middle, to [margin, 1 - margin]."""
    extent = max(high - low, least)
    scale = (1 - 2 * margin) / extent
    return scale, 0.5 - scale * (low + high) / 2


def _depths(near: float, far: float, least: float) -> tuple[float, float]:
    """Of depths, which need a place behind more than one before."""
    scale, offset = span(near, far, least=least)
    return scale * (1 - MARGIN), offset * (1 - MARGIN)


def parallel(
    seen: Seen,
    window: tuple[tuple[float, float], tuple[float, float]],
    slopes: tuple[float, float] = (0.0, 0.0),
    /,
) -> Projection:
    """Parallel light through a window on the plane across the middle direction, at the middle of the depths.

    Parameters
    ----------
    seen : Seen
        By `seen_along`.
    window : ((float, float), (float, float))
        From and to, to the right and up.
    slopes : (float, float)
        How far the light goes to the right and up for each step ahead; 0, 0 is straight.
    """
    extents = [high - low for low, high in window]
    near, far = seen.extremes(2)
    least = max(*extents, far - near) * 1e-6 or 1.0  # of a single point
    matrix = np.zeros((4, 4))
    for axis, (low, high) in enumerate(window):
        scale, offset = span(low, high, least=least)
        row = np.eye(3)[axis] - [0, 0, slopes[axis]]
        matrix[axis] = seen.functional(scale * row, offset)
    scale, offset = _depths(near, far, least)
    matrix[2] = seen.functional(np.array([0, 0, scale]), offset)
    matrix[3, 3] = 1.0
    return Projection(matrix)


def through_window(
    seen: Seen,
    window: tuple[tuple[float, float], tuple[float, float]],
    depths: tuple[float, float],
    shift: tuple[float, float] = (0.0, 0.0),
    /,
    *,
    plane: float = math.inf,
    margin: float = MARGIN,
) -> Projection:
    """Light from a place, to the right and up of the middle one by `shift`, through a window.

    Parameters
    ----------
    seen : Seen
        By `seen_from`, from the middle place.
    window : ((float, float), (float, float))
        Tangents from and to, to the right and up, as the middle place sees the window.
    depths : (float, float)
        The least and largest distance ahead that counts.
    shift : (float, float)
        Where the place is.
    plane : float
        How far ahead the window is: what lies there is at the same pixel whatever the shift.
    margin : float
        Share of the map's side beyond the window, on each side.
    """
    matrix = np.zeros((4, 4))
    least = 1e-6 * max(high - low for low, high in window) or 1e-6
    for axis, (low, high) in enumerate(window):
        scale, offset = span(low, high, margin, least=least)
        row = scale * np.eye(3)[axis] + [0, 0, scale * shift[axis] / plane + offset]
        matrix[axis] = seen.functional(row, -scale * shift[axis])
    near, far = depths
    scale = (1 - 2 * MARGIN) / max(far - near, 1e-6 * far)
    matrix[2] = seen.functional(np.array([0, 0, scale]), -scale * near)
    matrix[3] = seen.functional(np.array([0.0, 0, 1]), 0.0)
    return Projection(matrix)


def cone_window(
    seen: Seen, tangent: float, shifts: Any = ((0.0, 0.0), (0.0, 0.0)), /
) -> tuple[tuple[tuple[float, float], tuple[float, float]], tuple[float, float], float]:
    """Window, depths and plane of a light that shines ahead within a cone, from places around the middle one.

    The scene lies within the hull of its points. If all of that is ahead, its picture is within the hull of
    the points' pictures, and what is nearer than the nearest of them is free. Else nothing is known but the
    cone, since a triangle may reach through it whose corners are all outside.

    Parameters
    ----------
    seen : Seen
        By `seen_from`.
    tangent : float
        Of half the cone's angle.
    shifts : ((float, float), (float, float))
        From and to, to the right and up.

    Raises
    ------
    FovealError
        If nothing lies in the cone.
    """
    ahead = seen.points[:, 2]
    far, first = float(ahead.max()), float(ahead.min())
    nothing = FovealError("nothing lies in the light's cone. Turn it to the scene, or widen its angle.")
    if far <= 0:
        raise nothing
    is_all_ahead = first > NEAREST * far
    near = max(first - MARGIN * (far - first), NEAREST * far)
    plane = (max(first, near) + far) / 2
    window = []
    for axis in (0, 1):
        low, high = -tangent, tangent
        if is_all_ahead:
            pictures = [(seen.points[:, axis] - s) / ahead + s / plane for s in sorted({*shifts[axis]})]
            low = max(low, min(float(p.min()) for p in pictures))
            high = min(high, max(float(p.max()) for p in pictures))
        if low > high:
            raise nothing
        window.append((low, high))
    return (window[0], window[1]), (near, far), plane
