"""The lights whose shadows are precomputed, and how files tell of them."""

import math
from collections.abc import Callable
from typing import Any

from foveal.base.errors import FovealError

from .area_light import AreaLight
from .point_light import Point
from .single_lights import Directional, Spot, Sun
from .sun_path import SunPath

__all__ = ["AreaLight", "Directional", "Light", "Point", "Spot", "Sun", "SunPath", "light_from_json"]

Light = Directional | Sun | Spot | Point | AreaLight | SunPath
"""Each has is_stack, images, projections(positions, resolution), towards(points, image) and to_json()."""


def light_from_json(data: Any, /) -> Light:
    """The light that `to_json` told of. Keys that are not known are ignored.

    Raises
    ------
    FovealError
        If it is no light, in a sentence.

    Examples
    --------
    >>> light_from_json({"kind": "point", "position": [0, 0, 2]})
    Point(position=(0.0, 0.0, 2.0))
    """
    kind = data.get("kind") if isinstance(data, dict) else None
    if not isinstance(kind, str) or kind not in _READERS:
        raise FovealError(
            f"the light {kind!r:.40} is not known; this foveal knows {', '.join(_READERS)}. Use a newer one."
        )
    try:
        return _READERS[kind](data)
    except FovealError:
        raise
    except (LookupError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise FovealError(f"the light is not told as it should be ({kind}: {error}).") from error


def _place(data: dict[str, Any]) -> dict[str, Any]:
    north = data.get("north")
    return {
        "latitude": float(data["latitude"]),
        "longitude": float(data["longitude"]),
        "up": data.get("up", "y"),
        "north": north if north is None or isinstance(north, str) else float(north),
    }


def _sun(data: dict[str, Any]) -> Light:
    return Sun(data["time"], **_place(data))


def _sun_path(data: dict[str, Any]) -> Light:
    return SunPath(data["begin"], data["end"], int(data["steps"]), **_place(data))


def _spot(data: dict[str, Any]) -> Light:
    return Spot(data["position"], data["target"], math.radians(float(data["angle_degrees"])))


def _area(data: dict[str, Any]) -> Light:
    light = light_from_json(data["light"])
    if not isinstance(light, (Spot, Sun, Directional)):
        raise ValueError("it is made of no light that could have a surface")
    scale = 1.0 if isinstance(light, Spot) else math.radians(1)
    radius, size = data.get("radius"), data.get("size")
    return AreaLight(
        light,
        None if radius is None else float(radius) * scale,
        None if size is None else (float(size[0]) * scale, float(size[1]) * scale),
        int(data["samples"]),
        bool(data.get("jitter", False)),
        int(data.get("seed", 0)),
    )


_READERS: dict[str, Callable[[dict[str, Any]], Light]] = {
    "directional": lambda data: Directional(data["direction"]),
    "sun": _sun,
    "spot": _spot,
    "point": lambda data: Point(data["position"]),
    "area": _area,
    "sun_path": _sun_path,
}
