"""Lights of one map: parallel light, the sun, and a spot light."""

import math
from dataclasses import dataclass
from datetime import datetime
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from .frames import (
    checked_resolution,
    cone_window,
    parallel,
    seen_along,
    seen_from,
    through_window,
    unit,
    vector,
)
from .projection import Projection
from .sun import elevation, ground_axes, moment, sun_on_the_ground

__all__ = [
    "MOST_ANGLE",
    "Directional",
    "Single",
    "Spot",
    "Sun",
    "checked_place",
    "set_fields",
    "sun_direction",
]

MOST_ANGLE = math.radians(170)
"""Of a cone. At 170 degrees a pixel at the rim has 0.0007 of the solid angle of one in the middle."""


class Single:
    """A light of one image, be that a map or a cube of six."""

    is_stack: ClassVar[bool] = False
    images: ClassVar[int] = 1


def set_fields(light: Any, /, **values: Any) -> None:
    """Give a frozen dataclass its checked fields."""
    for name, value in values.items():
        object.__setattr__(light, name, value)


@dataclass(frozen=True, slots=True)
class Directional(Single):
    """Parallel light.

    Attributes
    ----------
    direction : (float, float, float)
        The way the light travels, of any length.

    Raises
    ------
    FovealError
        If it is zero or no number.

    Examples
    --------
    >>> light = Directional((0, 0, -2))
    >>> light.towards([[5, 5, 5]])
    array([[0., 0., 1.]])
    >>> (projection,) = light.projections([[0, 0, 0], [4, 2, 1]], 1024)
    >>> projection.project([[0, 0, 1], [2, 1, 0.5], [4, 2, 0]]).round(2)
    array([[0. , 0. , 0. ],
           [0.5, 0.5, 0.5],
           [1. , 1. , 1. ]])
    """

    direction: tuple[float, float, float]

    def __post_init__(self) -> None:
        direction = vector("the direction of light", self.direction)
        if not np.linalg.norm(direction) > 1e-100:
            raise FovealError("the direction of light has no length. Say which way the light travels.")
        set_fields(self, direction=direction)

    def projections(self, positions: ArrayLike, resolution: int, /) -> tuple[Projection, ...]:
        """One, tight around (n, 3) positions in u, v and depth."""
        checked_resolution(resolution)
        seen = seen_along(self.direction, positions)
        return (parallel(seen, (seen.extremes(0), seen.extremes(1))),)

    def towards(self, points: ArrayLike, /, image: int = 0) -> NDArray[np.float64]:
        """(n, 3): unit vectors from points to the light."""
        to_light = unit(-np.asarray(self.direction)) + 0.0
        return np.broadcast_to(to_light, np.shape(points)).copy()

    def to_json(self) -> dict[str, Any]:
        """As files keep it."""
        return {"kind": "directional", "direction": list(self.direction)}


def sun_direction(
    time: datetime, latitude: float, longitude: float, up: str, north: str | float | None
) -> tuple[tuple[float, float, float], float]:
    """Which way sunlight travels in the axes of a model, and the sun's height in degrees."""
    on_the_ground = sun_on_the_ground(time, latitude, longitude)
    x, y, z = (-ground_axes(up, north) @ on_the_ground + 0.0).tolist()
    return (x, y, z), elevation(on_the_ground)


def checked_place(latitude: float, longitude: float, /) -> tuple[float, float]:
    """A place on the Earth, in degrees.

    Raises
    ------
    FovealError
        If there is none such.
    """
    if not (-90 <= latitude <= 90 and -180 <= longitude <= 360):
        raise FovealError(
            f"{latitude:g}, {longitude:g} is no place: degrees of latitude from -90 to 90 and of "
            "longitude from -180 to 180 are needed."
        )
    return float(latitude), float(longitude)


@dataclass(frozen=True, slots=True)
class Sun(Single):
    """Sunlight of a time at a place.

    Attributes
    ----------
    time : datetime
        Also as ISO 8601 has it; without an offset it is UTC.
    latitude, longitude : float
        In degrees, as maps tell them, to the north and to the east.
    up : "x", "y" or "z"
        The axis of the model that points up.
    north : str, float or None
        The axis that points north, such as "y" or "-z", or degrees by which north is turned clockwise, seen
        from above, from where it usually is: -z where y is up, y where z is up, z where x is up.

    Raises
    ------
    FovealError
        If there is no such time, place or axis, or the sun is below the horizon.

    Examples
    --------
    >>> light = Sun("2026-06-21T15:00+02:00", 43.72, 10.40, up="z")
    >>> light.towards([[0, 0, 0]]).round(3)  # to the south-west, 61 degrees up
    array([[-0.387, -0.287,  0.876]])
    """

    time: datetime
    latitude: float
    longitude: float
    up: str = "y"
    north: str | float | None = None

    def __post_init__(self) -> None:
        latitude, longitude = checked_place(self.latitude, self.longitude)
        set_fields(self, time=moment(self.time), latitude=latitude, longitude=longitude)
        _, height = self._where()
        if height <= 0:
            raise FovealError(
                f"{self.time.isoformat()}: the sun is {-height:.1f} degrees below the horizon there. "
                "Choose a time of day, and mind the offset to UTC."
            )

    def _where(self) -> tuple[tuple[float, float, float], float]:
        return sun_direction(self.time, self.latitude, self.longitude, self.up, self.north)

    @property
    def direction(self) -> tuple[float, float, float]:
        """The way the light travels, of unit length."""
        return self._where()[0]

    def projections(self, positions: ArrayLike, resolution: int, /) -> tuple[Projection, ...]:
        """One, tight around (n, 3) positions in u, v and depth."""
        return Directional(self.direction).projections(positions, resolution)

    def towards(self, points: ArrayLike, /, image: int = 0) -> NDArray[np.float64]:
        """(n, 3): unit vectors from points to the light."""
        return Directional(self.direction).towards(points)

    def to_json(self) -> dict[str, Any]:
        """As files keep it; `direction` is for who does not reckon with the sun."""
        place = {"latitude": self.latitude, "longitude": self.longitude, "up": self.up, "north": self.north}
        time = self.time.isoformat()
        return {"kind": "sun", "time": time, **place, "direction": list(self.direction)}


@dataclass(frozen=True, slots=True)
class Spot(Single):
    """A light at a place that shines within a cone.

    The map is the square around the cone; what is nearer than a millionth of the scene's reach casts nothing.

    Attributes
    ----------
    position, target : (float, float, float)
        Where it stands, and what it shines at.
    angle : float
        Of the whole cone, in radians, up to 170 degrees.

    Raises
    ------
    FovealError
        If position and target are one, or the angle is out of range.

    Examples
    --------
    >>> light = Spot((0, 0, 3), (0, 0, 0), angle=1.0)
    >>> light.towards([[0, 0, 1], [0, 4, 0]])
    array([[ 0. ,  0. ,  1. ],
           [ 0. , -0.8,  0.6]])
    >>> (projection,) = light.projections([[-9, -9, 0], [9, -9, 0], [0, 9, 0], [0, 0, 1]], 1024)
    >>> projection.project([[0, 0, 0]]).round(2)
    array([[0.5, 0.5, 1. ]])
    """

    position: tuple[float, float, float]
    target: tuple[float, float, float]
    angle: float = math.radians(60)

    def __post_init__(self) -> None:
        position, target = vector("the light's position", self.position), vector("its target", self.target)
        if np.linalg.norm(np.subtract(target, position)) <= 1e-12 * np.abs([position, target]).max():
            raise FovealError("the spot light's target is where it stands. Say what it shines at.")
        if not 0 < self.angle <= MOST_ANGLE:
            raise FovealError(
                "the angle of a cone must be above 0 and at most 170 degrees, got "
                f"{math.degrees(self.angle):g}."
            )
        set_fields(self, position=position, target=target, angle=float(self.angle))

    @property
    def axis(self) -> NDArray[np.float64]:
        """(3,): from the position to the target."""
        return np.asarray(np.subtract(self.target, self.position), np.float64)

    def projections(self, positions: ArrayLike, resolution: int, /) -> tuple[Projection, ...]:
        """One, tight around what of (n, 3) positions is in the cone."""
        checked_resolution(resolution)
        seen = seen_from(self.position, self.axis, positions)
        window, depths, _ = cone_window(seen, math.tan(self.angle / 2))
        return (through_window(seen, window, depths),)

    def towards(self, points: ArrayLike, /, image: int = 0) -> NDArray[np.float64]:
        """(n, 3): unit vectors from points to the light."""
        return unit(self.position - np.asarray(points, np.float64))

    def to_json(self) -> dict[str, Any]:
        """As files keep it; the angle in degrees."""
        place = {"position": list(self.position), "target": list(self.target)}
        return {"kind": "spot", **place, "angle_degrees": math.degrees(self.angle)}
