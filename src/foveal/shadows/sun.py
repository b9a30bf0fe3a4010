"""Where the sun stands, and which way the axes of a model point on the ground."""

import math
from datetime import UTC, datetime

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

__all__ = ["elevation", "ground_axes", "has_offset", "moment", "sun_on_the_ground"]

_J2000 = datetime(2000, 1, 1, 12, tzinfo=UTC)
_BEHIND = (
    69 / 86400
)  # days by which clocks, which the Earth's turn sets, are behind even time since about 2015
_PARALLAX = 4.26e-5  # the Earth's radius in astronomical units
_AXES = {name: np.eye(3)[i] for i, name in enumerate("xyz")}
_NORTH = {"x": "z", "y": "-z", "z": "y"}
_SIGHT = -1.0  # degrees: what is lower is not refracted, since nobody sees it


def sun_on_the_ground(
    time: datetime, latitude: float, longitude: float, /, *, has_air: bool = True
) -> NDArray[np.float64]:
    """(3,): the unit vector to the sun, in parts to the east, to the north and up.

    Within 0.01 degrees from 1950 to 2050, as vectors throughout: there is no pole and no zenith at which it
    would jump. Libraries that were looked at come as far in accuracy, but hold still at the poles, turn at
    the zenith and leave out fractions of a second (astral 3.2), or bring pandas with them (pvlib).

    Parameters
    ----------
    time : datetime
        With an offset to UTC.
    latitude, longitude : float
        Degrees, to the north and to the east.
    has_air : bool
        Whether air of 1010 hPa and 10 °C lifts the sun, by 0.5 degrees at the horizon.

    References
    ----------
    Meeus, J. (1998). Astronomical Algorithms, 2nd ed., chapters 12, 16 and 25 (the low accuracy), which
    NOAA's solar calculator computes too.

    Examples
    --------
    >>> noon = datetime.fromisoformat("2026-03-20T12:07:30+00:00")  # at the equinox, on the equator
    >>> sun_on_the_ground(noon, 0.0, 0.0).round(2) + 0.0
    array([0., 0., 1.])
    """
    days = (time - _J2000).total_seconds() / 86400
    (x, y, z), nutation = _equatorial((days + _BEHIND) / 36525)
    # The Earth's turn since then: Greenwich's apparent sidereal time, and the place's own.
    turned = math.radians((280.46061837 + 360.98564736629 * days + nutation + longitude) % 360)
    cos, sin = math.cos(turned), math.sin(turned)
    meridian, east = x * cos + y * sin, y * cos - x * sin
    cos, sin = math.cos(math.radians(latitude)), math.sin(math.radians(latitude))
    north, up = z * cos - meridian * sin, meridian * cos + z * sin - _PARALLAX
    return _lifted(east, north, up) if has_air else _unit(np.array([east, north, up]))


def _equatorial(t: float) -> tuple[tuple[float, float, float], float]:
    """The sun as seen from the Earth's centre, t Julian centuries after 2000, and by how much to turn it.

    The vector's parts are to the equinox, along the equator a quarter on, and to the pole; the angle, in
    degrees, is nutation in right ascension.
    """
    anomaly = math.radians(357.52911 + (35999.05029 - 0.0001537 * t) * t)
    centre = (1.914602 - (0.004817 + 0.000014 * t) * t) * math.sin(anomaly)
    centre += (0.019993 - 0.000101 * t) * math.sin(2 * anomaly) + 0.000289 * math.sin(3 * anomaly)
    node = math.radians(125.04 - 1934.136 * t)
    nutation = -0.00478 * math.sin(node)
    tilt = math.radians(23.4392911 - 0.0130042 * t + 0.00256 * math.cos(node))
    # The sun's mean longitude, the equation of the centre, aberration and nutation.
    mean = 280.46646 + (36000.76983 + 0.0003032 * t) * t
    longitude = math.radians(mean + centre - 0.00569 + nutation)
    across = math.sin(longitude)
    vector = math.cos(longitude), math.cos(tilt) * across, math.sin(tilt) * across
    return vector, nutation * math.cos(tilt)


def _lifted(east: float, north: float, up: float) -> NDArray[np.float64]:
    """What air does to a direction (Sæmundsson's formula, Meeus 16.4)."""
    height = math.degrees(math.atan2(up, math.hypot(east, north)))
    if height < _SIGHT:
        return _unit(np.array([east, north, up]))
    seen = math.radians(height + refraction(height))
    across = max(math.hypot(east, north), 1e-12)
    return _unit(
        np.array(
            [
                east / across * math.cos(seen),
                north / across * math.cos(seen),
                math.sin(min(seen, math.pi / 2)),
            ]
        )
    )


def refraction(height: float, /) -> float:
    """By how many degrees the air lifts what is `height` degrees above the horizon.

    Examples
    --------
    >>> round(refraction(0.0), 3), round(refraction(45.0), 3)
    (0.483, 0.017)
    """
    return max(0.0, 1.02 / math.tan(math.radians(height + 10.3 / (height + 5.11))) / 60)


def _unit(vector: NDArray[np.float64]) -> NDArray[np.float64]:
    return vector / np.linalg.norm(vector)


def elevation(direction: NDArray[np.float64], /) -> float:
    """Degrees above the horizon, of what `sun_on_the_ground` gives."""
    return math.degrees(math.asin(min(1.0, max(-1.0, float(direction[2])))))


def ground_axes(up: str, north: str | float | None = None, /) -> NDArray[np.float64]:
    """(3, 3): a column each for east, north and up, in the axes of a model.

    Parameters
    ----------
    up : "x", "y" or "z"
        The axis that points up.
    north : str or float, optional
        An axis such as "y" or "-z", or degrees by which north is turned clockwise, seen from above, from its
        usual axis. That is, for up z, y as on maps; for y, -z; for x, z.

    Raises
    ------
    FovealError
        If it is no axis and no number, or north is up or down.

    Examples
    --------
    >>> ground_axes("y").astype(int)
    array([[ 1,  0,  0],
           [ 0,  0,  1],
           [ 0, -1,  0]])
    """
    if up not in _AXES:
        raise FovealError(f'up must be "x", "y" or "z", got {up!r}.')
    above, turn = _AXES[up], 0.0
    axis = _NORTH[up] if north is None else str(north).strip().lower().removeprefix("+")
    if axis.removeprefix("-") not in _AXES:
        turn, axis = _degrees(axis), _NORTH[up]
    ahead = _AXES[axis.removeprefix("-")] * (-1 if axis.startswith("-") else 1)
    if ahead @ above != 0:
        raise FovealError(f"north {north!r} cannot be the axis that points up. Choose one across {up}.")
    east = np.cross(ahead, above)
    cos, sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    ahead, east = cos * ahead + sin * east, cos * east - sin * ahead
    return np.stack([east, ahead, above], axis=1) + 0.0


def _degrees(text: str) -> float:
    try:
        angle = float(text)
    except ValueError:
        angle = math.nan
    if not abs(angle) <= 360:
        raise FovealError(f"north {text!r} is neither an axis such as y or -z nor degrees, up to 360.")
    return angle


def moment(given: datetime | str, /) -> datetime:
    """A point in time with its offset to UTC; without one it is UTC.

    Raises
    ------
    FovealError
        If the text is not as ISO 8601 has it.

    Examples
    --------
    >>> moment("2026-06-21T15:00+02:00").isoformat(), moment("2026-06-21T15:00").isoformat()
    ('2026-06-21T15:00:00+02:00', '2026-06-21T15:00:00+00:00')
    """
    try:
        time = datetime.fromisoformat(given.strip()) if isinstance(given, str) else given
    except ValueError as error:
        raise FovealError(
            f"{given!r:.60} is not a time; write for instance 2026-06-21T15:00+02:00."
        ) from error
    if time.tzinfo is None:
        time = time.replace(tzinfo=UTC)
    try:
        time.astimezone(UTC)
    except OverflowError as error:
        raise FovealError(f"{time} is beyond the years that can be reckoned with.") from error
    return time


def has_offset(time: str, /) -> bool:
    """Whether a time tells its offset to UTC.

    Examples
    --------
    >>> has_offset("2026-06-21T15:00+02:00"), has_offset("2026-06-21T15:00")
    (True, False)
    """
    return datetime.fromisoformat(time.strip()).tzinfo is not None
