"""A control mesh, and how it is meant to be refined: what a `.fov` of kind "cage" holds."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from .depth_rules import CATMULL_CLARK, is_chosen
from .refinement import Refinement

if TYPE_CHECKING:  # which knows of kernels: half a second for those who show patches only
    from foveal.mesh.polymesh import PolyMesh
    from foveal.mesh.trimesh import TriMesh

__all__ = ["MOST_CORNERS", "ControlMesh"]

MOST_CORNERS = 1 << 26
"""Of all polygons in all their places: what a chunk can hold, and more than anybody refines."""


@dataclass(frozen=True, slots=True)
class ControlMesh:
    """What a `.fov` of kind "cage" holds.

    Attributes
    ----------
    mesh : TriMesh
        Positions and faces only; of polygons their fans.
    refinement : Refinement
        What is meant where nothing else is chosen.
    up : "x", "y" or "z"
    sharp : (k, 2) int32 or None
        The vertices of edges that stay sharp, where there are any.
    polygons : PolyMesh or None
        What it is made of where that is more than triangles, for catmull-clark.
    placements : (k, 4, 4) float64 or None
        Where the polygons stand, if not once and where they are. `mesh` is all of them, in place.
    """

    mesh: "TriMesh"
    refinement: Refinement
    up: str
    sharp: NDArray[np.int32] | None = None
    polygons: "PolyMesh | None" = None
    placements: NDArray[np.float64] | None = None

    @classmethod
    def of_polygons(
        cls,
        polygons: "PolyMesh",
        refinement: Refinement,
        up: str,
        /,
        *,
        placements: NDArray[np.float64] | None = None,
    ) -> "ControlMesh":
        """One of polygons."""
        mesh = _in_place(polygons, placements).triangulated()
        return cls(mesh, refinement, up, None, polygons, placements)

    def with_placements(self, options: Mapping[str, Any], name: str, /) -> "ControlMesh":
        """The same where the chosen `placements` have it, if any are.

        Raises
        ------
        FovealError
            If one is no placement.
        """
        from .cage_options import placements_with

        polygons = self.surface()
        chosen = placements_with(polygons, options, name)
        if chosen is None:
            return self
        return self.of_polygons(polygons, self.refinement, self.up, placements=chosen)

    def with_options(self, options: Mapping[str, Any], name: str, /) -> "ControlMesh":
        """The same with what is chosen of `pair_triangles` and `placements`; for catmull-clark.

        Raises
        ------
        FovealError
            If there is no pair, one is no placement, or a prim is chosen, since the file is not the USD it
            came from.
        """
        from .cage_options import with_pairs

        if is_chosen(options, "prim"):
            raise FovealError(f"{name}: only a USD file has prims to choose from. Leave prim out.")
        polygons = with_pairs(self.surface(), options, name)
        cage = self.of_polygons(polygons, self.refinement, self.up, placements=self.placements)
        return cage.with_placements(options, name)

    def surface(self) -> "PolyMesh":
        """The polygons, once and where they are, or the triangles as such."""
        from foveal.mesh.polymesh import PolyMesh

        return self.polygons or PolyMesh.of_triangles(self.mesh)

    def in_place(self) -> "PolyMesh":
        """The polygons in all their places, as one mesh."""
        return _in_place(self.surface(), self.placements)

    def refuse_misfit(self, scheme: str, name: str, /) -> None:
        """Say that it cannot be refined by a scheme.

        Raises
        ------
        FovealError
            If it has what the scheme does not know.
        """
        has, known = None, "sqrt3"
        if self.sharp is not None and scheme != "sqrt3":
            has = "sharp edges"
        elif self.polygons is not None and scheme != CATMULL_CLARK:
            has, known = "polygons and their creases", CATMULL_CLARK
        if has:
            raise FovealError(
                f"{name}: it has {has}, which {scheme} does not know. Choose {known}, or build it anew by "
                f"{scheme}, which leaves them out."
            )


def _in_place(polygons: "PolyMesh", placements: NDArray[np.float64] | None) -> "PolyMesh":
    from foveal.refine.slates_placements import placed

    return polygons if placements is None else placed(polygons, placements)
