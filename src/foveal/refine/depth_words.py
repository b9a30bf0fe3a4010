"""The depth rules of Catmull-Clark patches in JSON: in files and on the wire."""

import math
from dataclasses import asdict, replace
from typing import Any

from .slates_depth import Depths

__all__ = ["depths_json", "depths_of"]

_MOST_PX = 1e9


def depths_json(depths: Depths, /) -> dict[str, Any]:
    """As a layer of scene.json, the header of a control mesh and the wire have them; angles in degrees."""
    words = asdict(depths)
    cone = words.pop("cone")
    size = depths.size_px
    return {
        **words,
        "cone_degrees": None if cone is None else math.degrees(cone),
        "size_px": None if size is None else [float(size[0]), float(size[1])],
    }


def depths_of(data: Any, /, *, default: Depths | None = None) -> Depths:
    """Read what `depths_json` gives; what is missing is as in `default`.

    Raises
    ------
    ValueError, TypeError
        If a word is no such thing.
    """
    if not isinstance(data, dict):
        raise TypeError("depths must be an object")
    changes = {
        key: data[key] for key in ("most", "backs", "silhouettes", "epsilon", "size_px") if key in data
    }
    is_sound = (
        type(changes.get("most", 0)) is int
        and all(type(changes.get(key, True)) is bool for key in ("backs", "silhouettes"))
        and _is_number(changes.get("epsilon", 0), 1.0)
    )
    if not is_sound:
        raise ValueError("depths need a whole number as most, true or false as backs and silhouettes")
    if changes.get("size_px") is not None:
        changes["size_px"] = _pair(changes["size_px"])
    if "cone_degrees" in data:
        cone = data["cone_degrees"]
        if cone is not None and not _is_number(cone, 180.0):
            raise ValueError("cone_degrees must be an angle or null")
        changes["cone"] = None if cone is None else math.radians(cone)
    return replace(default or Depths(), **changes)


def _is_number(value: Any, most: float) -> bool:
    return type(value) in (int, float) and 0 <= value <= most


def _pair(value: Any) -> tuple[float, float]:
    if type(value) is not list or len(value) != 2 or not all(_is_number(v, _MOST_PX) for v in value):
        raise ValueError("size_px must be two radii, or null")
    return float(value[0]), float(value[1])
