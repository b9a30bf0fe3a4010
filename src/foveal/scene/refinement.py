"""How a control mesh is refined: its scheme, criteria and limits, chosen in Python and kept in JSON."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, TypedDict, cast

from numpy.typing import ArrayLike

from foveal.base.errors import FovealError

from .depth_rules import CATMULL_CLARK, OF_POLYGONS, depths_with, is_chosen, refuse_of_polygons

if TYPE_CHECKING:
    from foveal.refine import Criteria
    from foveal.refine.slates_depth import Depths

__all__ = ["RefineOptions", "Refinement", "chosen", "refinement_json", "refinement_of"]

SCHEMES = ("sqrt3", "loop", "butterfly", CATMULL_CLARK)
_PLACINGS = ("control", "limit")
_REGIONS = ("front", "silhouette", "back")


class RefineOptions(TypedDict, total=False):
    """What verbs take that refine a control mesh. None is the default, or what the file or the scene says.

    scheme : "sqrt3", "loop", "butterfly" or "catmull-clark"
        Makes a control mesh of a mesh: √3 subdivision, RGB triangulations over the rules of Loop or of the
        modified butterfly, or Catmull-Clark patches of polygons.
    criteria : Criteria or mapping
        When a triangle is fine enough, apart for front faces, silhouettes and back faces. A mapping such as
        {"front": {"edge_px": 2.0}} leaves all else as it is. For catmull-clark only iterations and bend of
        "front", which are the maximum depth and the angle of the cone.
    depths : Depths or mapping
        By which rules patches get their depth, for catmull-clark. A mapping such as {"size_px": (2, 8)}
        leaves all else as it is.
    positions : "control" or "limit"
        Where vertices are shown.
    budget : int
        Triangles at most; 0 for no limit.
    rate : float
        Frames a second that the viewer is to hold; 0 for no such wish.
    sharp_edges : float
        Keep the edges sharp at which the control mesh bends by more than this angle, in radians, from 0 to
        pi; for √3. A `.fov` has them, a scene does not say.
    pair_triangles : bool
        Join triangles in pairs to quadrangles before all else, for catmull-clark: half the patches, on
        another surface. Kept in a `.fov` as polygons.
    placements : (k, 4, 4) float
        Where the control mesh stands, for catmull-clark: matrices from its own space, the last row 0 0 0 1.
        Each placement has its own depths. Kept in a `.fov`.
    prim : str
        Of a USD file with several meshes the path of one, such as "/town/house", for catmull-clark.
    """

    scheme: str | None
    criteria: "Criteria | Mapping[str, Mapping[str, float]] | None"
    depths: "Depths | Mapping[str, Any] | None"
    positions: str | None
    budget: int | None
    rate: float | None
    sharp_edges: float | None
    pair_triangles: bool | None
    prim: str | None
    placements: ArrayLike | None


@dataclass(frozen=True, slots=True)
class Refinement:
    """How a control mesh is refined.

    Attributes
    ----------
    scheme : "sqrt3", "loop", "butterfly" or "catmull-clark"
    criteria : Criteria
        Of catmull-clark they say nothing.
    positions : "control" or "limit"
    budget : int
        Triangles at most, or 0.
    rate : float
        Frames a second to be held, or 0.
    depths : Depths or None
        Of catmull-clark, for which None are the default ones.
    """

    scheme: Literal["sqrt3", "loop", "butterfly", "catmull-clark"]
    criteria: "Criteria"
    positions: Literal["control", "limit"] = "control"
    budget: int = 0
    rate: float = 0.0
    depths: "Depths | None" = None

    def __post_init__(self) -> None:
        if self.scheme not in SCHEMES:
            raise ValueError(f"scheme must be one of {', '.join(SCHEMES)}, got {self.scheme!r}")
        if self.positions not in _PLACINGS:
            raise ValueError(f"positions must be one of {', '.join(_PLACINGS)}, got {self.positions!r}")
        if type(self.budget) is not int or not 0 <= self.budget < 2**32:
            raise ValueError(f"budget must be a number of triangles, or 0, got {self.budget!r}")
        if not 0 <= self.rate <= 1000:
            raise ValueError(f"rate must be from 0 to 1000 frames a second, got {self.rate!r}")

    def chosen(self, options: RefineOptions, /) -> "Refinement":
        """The same with what was chosen anew.

        Raises
        ------
        FovealError
            If it is something that the scheme does not have.
        """
        names = self.__dataclass_fields__
        new: dict[str, Any] = {
            key: value for key, value in options.items() if key in names and value is not None
        }
        scheme = new.get("scheme", self.scheme)
        if scheme == CATMULL_CLARK:
            new["depths"] = depths_with(self.depths, options)
            new.pop("criteria", None)
            return replace(self, **{**new, "positions": "limit"})
        refuse_of_polygons(scheme, options)
        if isinstance(new.get("criteria"), Mapping):
            new["criteria"] = _changed(self.criteria, new["criteria"])
        return replace(self, **new)


def _changed(criteria: "Criteria", given: Mapping[str, Mapping[str, float]]) -> "Criteria":
    """Criteria with some numbers in place of their own."""
    regions = {name: replace(getattr(criteria, name), **values) for name, values in given.items()}
    return replace(criteria, **regions)


def chosen(options: RefineOptions, /) -> Refinement | None:
    """The refinement that options ask for, or None where they name no scheme.

    Raises
    ------
    FovealError
        If they choose how to refine and no scheme, or sharp edges that the scheme does not know.
    """
    scheme, sharp = options.get("scheme"), options.get("sharp_edges")
    if scheme is not None:
        if sharp is not None and not 0 <= sharp <= math.pi:
            raise ValueError(f"sharp_edges must be an angle from 0 to pi, got {sharp}")
        if sharp is not None and scheme in SCHEMES and scheme != "sqrt3":
            own = " by an angle: it keeps the creases of the file" if scheme == CATMULL_CLARK else ""
            raise FovealError(f"{scheme} knows no sharp edges{own}. Choose sqrt3, or leave sharp_edges out.")
        from foveal.refine import Criteria

        return Refinement(cast(Any, scheme), Criteria()).chosen(options)
    named = [name for name in RefineOptions.__annotations__ if is_chosen(options, name)]
    if named:
        fit = CATMULL_CLARK if set(named) & OF_POLYGONS.keys() else "sqrt3"
        raise FovealError(f"{' and '.join(named)} tell how to refine; choose a scheme, such as {fit}, too.")
    return None


def refinement_json(refinement: Refinement, /) -> dict[str, Any]:
    """As a layer of scene.json and the header of a control mesh have it; angles in degrees."""
    if refinement.scheme == CATMULL_CLARK:
        from foveal.refine.depth_words import depths_json

        rules = depths_json(refinement.depths or depths_with(None, {}))
        return {
            "scheme": refinement.scheme,
            "depths": rules,
            "budget": refinement.budget,
            "rate": refinement.rate,
        }
    return {
        "scheme": refinement.scheme,
        "criteria": {
            name: {
                "iterations": region.iterations,
                "edge_px": region.edge_px,
                "bend_degrees": math.degrees(region.bend),
            }
            for name in _REGIONS
            for region in [getattr(refinement.criteria, name)]
        },
        "positions": refinement.positions,
        "budget": refinement.budget,
        "rate": refinement.rate,
    }


def refinement_of(data: dict[str, Any], where: str, /, *, default: Refinement | None = None) -> Refinement:
    """Read what `refinement_json` gives; what is missing is as in `default`.

    Raises
    ------
    FovealError
        In a sentence that begins with `where`: no scheme, one that is not known, a number that is none.
    """
    from foveal.refine import Criteria, Region
    from foveal.refine.depth_words import depths_of

    try:
        if "scheme" not in data and default is None:
            raise ValueError('there is no "scheme"')
        base = default or Refinement(data["scheme"], Criteria())
        regions = {}
        for name in _REGIONS:
            given, was = data.get("criteria", {}).get(name, {}), getattr(base.criteria, name)
            bend = math.radians(given["bend_degrees"]) if "bend_degrees" in given else was.bend
            edge_px = float(given.get("edge_px", was.edge_px))
            regions[name] = Region(given.get("iterations", was.iterations), edge_px, bend)
        return Refinement(
            data.get("scheme", base.scheme),
            Criteria(**regions),
            data.get("positions", base.positions),
            data.get("budget", base.budget),
            float(data.get("rate", base.rate)),
            depths_of(data["depths"], default=base.depths) if "depths" in data else base.depths,
        )
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError) as error:
        raise FovealError(
            f"{where}: how it is refined is not told as it should be ({error}). Correct it, or leave it out."
        ) from error
