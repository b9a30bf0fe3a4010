"""The sun's way over a day, or part of one: a stack of maps, one for each time."""

import math
from dataclasses import dataclass
from datetime import datetime
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from .area_light import MOST_IMAGES, oblique
from .frames import basis, checked_resolution, seen_along, unit
from .projection import Projection
from .single_lights import Directional, checked_place, set_fields, sun_direction
from .sun import moment

__all__ = ["WIDEST", "SunPath"]

WIDEST = math.radians(60)
"""How far from the middle a direction may be for all images to share a window: twice as wide as its own."""


@dataclass(frozen=True)
class SunPath:
    """Sunlight at times that are evenly spaced, both ends told; what is night is left out.

    If all directions are within 60 degrees of their middle, the images look through one window, as those of
    an `AreaLight`; else each has a frame of its own, tight around the scene.

    Attributes
    ----------
    begin, end : datetime
        Also as ISO 8601 has them; without an offset they are UTC.
    steps : int
        How many times, 2 to 4096.
    latitude, longitude, up, north
        As for `Sun`.

    Raises
    ------
    FovealError
        If there is no such time, place or axis, the end is not after the begin, or all is night.

    Examples
    --------
    >>> path = SunPath("2026-03-20T00:00", "2026-03-20T23:00", 24, 43.72, 10.40, up="z")
    >>> path.images, path.left_out, path.times[0].isoformat()
    (12, 12, '2026-03-20T06:00:00+00:00')
    >>> path.towards([[0, 0, 0]], 5).round(2)
    array([[ 0.11, -0.69,  0.72]])
    """

    begin: datetime
    end: datetime
    steps: int
    latitude: float
    longitude: float
    up: str = "y"
    north: str | float | None = None

    is_stack: ClassVar[bool] = True

    def __post_init__(self) -> None:
        latitude, longitude = checked_place(self.latitude, self.longitude)
        set_fields(
            self, begin=moment(self.begin), end=moment(self.end), latitude=latitude, longitude=longitude
        )
        if not self.begin < self.end:
            raise FovealError(
                f"the sun's path ends at {self.end.isoformat()}, which is not after its beginning, "
                f"{self.begin.isoformat()}. Say an earlier and a later time."
            )
        if not (isinstance(self.steps, (int, np.integer)) and 2 <= self.steps <= MOST_IMAGES):
            raise FovealError(f"the steps of a sun's path must be 2 to {MOST_IMAGES}, got {self.steps}.")
        if not self.times:
            raise FovealError(
                f"from {self.begin.isoformat()} to {self.end.isoformat()} the sun is below the horizon. "
                "Choose times of day, and mind the offset to UTC."
            )

    @cached_property
    def _day(self) -> list[tuple[datetime, tuple[float, float, float]]]:
        step = (self.end - self.begin) / (self.steps - 1)
        found = []
        for i in range(self.steps):
            time = self.begin + i * step
            direction, height = sun_direction(time, self.latitude, self.longitude, self.up, self.north)
            if height > 0:
                found.append((time, direction))
        return found

    @property
    def times(self) -> tuple[datetime, ...]:
        """Of each image."""
        return tuple(time for time, _ in self._day)

    @property
    def images(self) -> int:
        """How many maps there are: one for each time at which the sun is up."""
        return len(self._day)

    @property
    def left_out(self) -> int:
        """How many of the steps are night."""
        return self.steps - self.images

    @cached_property
    def directions(self) -> NDArray[np.float64]:
        """(images, 3): the way the light travels, of unit length."""
        return np.array([direction for _, direction in self._day])

    def projections(self, positions: ArrayLike, resolution: int, /) -> tuple[Projection, ...]:
        """One for each image, tight around (n, 3) positions."""
        checked_resolution(resolution, images=self.images)
        middle = unit(self.directions.sum(axis=0))
        if not (self.directions @ middle >= math.cos(WIDEST)).all():
            return tuple(Directional(d).projections(positions, resolution)[0] for d in self.directions)
        local = self.directions @ basis(middle).T
        return oblique(seen_along(middle, positions), local[:, :2] / local[:, 2:])

    def towards(self, points: ArrayLike, /, image: int = 0) -> NDArray[np.float64]:
        """(n, 3): unit vectors from points to the sun of one image."""
        return np.broadcast_to(-self.directions[image] + 0.0, np.shape(points)).copy()

    def to_json(self) -> dict[str, Any]:
        """As files keep it; `times` and `directions` are for who does not reckon with the sun."""
        place = {"latitude": self.latitude, "longitude": self.longitude, "up": self.up, "north": self.north}
        return {
            "kind": "sun_path",
            "begin": self.begin.isoformat(),
            "end": self.end.isoformat(),
            "steps": self.steps,
            **place,
            "times": [time.isoformat() for time in self.times],
            "directions": self.directions.tolist(),
        }
