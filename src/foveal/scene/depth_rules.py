"""What Catmull-Clark patches have alone, above all depth rules: chosen in Python or at the command line."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from foveal.base.errors import FovealError

if TYPE_CHECKING:
    from foveal.refine.slates_depth import Depths

__all__ = [
    "CATMULL_CLARK",
    "MOST_DEPTH",
    "OF_POLYGONS",
    "RULES",
    "depths_with",
    "is_chosen",
    "refuse_of_polygons",
]

CATMULL_CLARK = "catmull-clark"
MOST_DEPTH = 8

RULES: Mapping[str, Mapping[str, Any]] = {
    "curvature": {"cone": None},
    "backs": {"backs": False},
    "silhouettes": {"silhouettes": False},
    "size": {"size_px": None},
}
"""What leaves each rule out."""

OF_POLYGONS = {
    "depths": "has no rules of depth",
    "pair_triangles": "refines triangles as they are",
    "prim": "reads no USD",
    "placements": "refines in one place only",
}
"""Options of catmull-clark alone, and why another scheme has no use for each."""

_OF_CRITERIA = {"iterations": "most", "bend": "cone"}  # of front faces: they mean the same of patches


def is_chosen(options: Mapping[str, Any], name: str, /) -> bool:
    """Whether an option says anything: None is the default, and False chooses nothing.

    Examples
    --------
    >>> is_chosen({"prim": None, "pair_triangles": True}, "pair_triangles")
    True
    """
    return options.get(name) is not None and options[name] is not False


def refuse_of_polygons(scheme: str, options: Mapping[str, Any], /) -> None:
    """Say that something was chosen that only catmull-clark has.

    Raises
    ------
    FovealError
        If so.
    """
    for name, why in OF_POLYGONS.items():
        if is_chosen(options, name):
            raise FovealError(f"{scheme} {why}. Choose {CATMULL_CLARK}, or leave {name} out.")


def depths_with(base: "Depths | None", options: Mapping[str, Any], /) -> "Depths":
    """Depth rules with what `RefineOptions` choose: `depths`, and of `criteria` what patches know.

    The iterations of front faces are the maximum depth, their bend is the cone's angle, 0 for no cone.

    Raises
    ------
    FovealError
        If the options choose what patches do not have, or rules that do not hold together.

    Examples
    --------
    >>> depths_with(None, {"criteria": {"front": {"iterations": 3, "bend": 0}}, "depths": {"backs": False}})
    Depths(most=3, cone=None, backs=False, silhouettes=True, epsilon=0.1, size_px=(3.0, 24.0))
    """
    from foveal.refine.slates_depth import Depths

    if options.get("positions") == "control":
        raise FovealError(f"{CATMULL_CLARK} shows points of the limit surface only. Leave positions out.")
    if options.get("sharp_edges") is not None:
        raise FovealError(f"{CATMULL_CLARK} keeps the creases of the file. Leave sharp_edges out.")
    given = options.get("depths")
    if isinstance(given, Depths):
        base, given = given, None
    changes = {**_of_criteria(options.get("criteria")), **(given or {})}
    try:
        return replace(base or Depths(), **changes)
    except ValueError as error:
        raise FovealError(f"These rules of depth do not hold: {error}. Correct them.") from error


def _of_criteria(criteria: Any) -> dict[str, Any]:
    if criteria is None:
        return {}
    front = criteria.get("front", {}) if isinstance(criteria, Mapping) else {}
    is_known = isinstance(criteria, Mapping) and not criteria.keys() - {"front"}
    if not is_known or front.keys() - _OF_CRITERIA.keys():
        raise FovealError(
            f"{CATMULL_CLARK} knows iterations and bend, but no length of edges, and no numbers apart for "
            "silhouettes and back faces. Choose depths instead: a range of radii, rules to leave out."
        )
    times = front.get("iterations", 0)
    if not 0 <= times <= MOST_DEPTH:
        raise FovealError(
            f"{CATMULL_CLARK} knows 0 to {MOST_DEPTH} iterations, got {times}. Choose one of these."
        )
    found = {_OF_CRITERIA[key]: value for key, value in front.items()}
    return {**found, "cone": found["cone"] or None} if "cone" in found else found
