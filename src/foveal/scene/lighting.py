"""How a scene's precomputed light falls on what is drawn: where it comes from, and how much arrives."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike
from foveal.mesh.trimesh import TriMesh

from .scene import Scene

if TYPE_CHECKING:
    from foveal.shadows import ShadowMap

__all__ = ["FILTERS", "Lighting", "lighting", "lighting_of"]

FILTERS = ("hard", "pcf3", "pcf5", "filtered", "soft")
"""How the pixels of a shadow map are made one answer."""
_MOVING, _MOVING_CUBE = 2048, 1024


@dataclass(frozen=True, slots=True)
class Lighting:
    """A light with its shadows, as `raster.picture` asks for it.

    Attributes
    ----------
    shadow : ShadowMap
        Of the light.
    filter : str
        One of `FILTERS`.
    image : int
        Of a stack, which; with "soft" all are meant.
    """

    shadow: "ShadowMap"
    filter: str
    image: int = 0

    def __call__(
        self, points: NDArray[np.float64], normals: NDArray[np.float64], spans: NDArray[np.float64], /
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Unit vectors to the light, and how much of it arrives."""
        light = self.shadow.light
        source = getattr(light, "light", light)  # the middle of a surface that shines
        is_middle = self.filter == "soft" and source is not light
        towards = source.towards(points) if is_middle else light.towards(points, self.image)
        shares = self._shares(points, normals, spans)
        # A cone ends where it ends, while its map is the square around it.
        angle, axis = getattr(source, "angle", None), getattr(source, "axis", None)
        if angle is not None and axis is not None:
            cosines = -(source.towards(points) @ axis) / np.linalg.norm(axis)
            shares = np.where(cosines >= np.cos(angle / 2), shares, np.float32(0))
        return towards, shares

    def with_moving(self, mesh: TriMesh, /) -> "Lighting":
        """The same light, with what moves before it: as many pixels as in the page."""
        side = _MOVING_CUBE if len(self.shadow.trees) > 1 else _MOVING
        return replace(self, shadow=self.shadow.with_moving(mesh, resolution=side))

    def _shares(
        self, points: NDArray[np.float64], normals: NDArray[np.float64], spans: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        shadow, image = self.shadow, self.image
        if self.filter == "soft":
            return shadow.soft(points, normals=normals)
        if self.filter == "filtered":
            footprint = shadow.footprints(points, spans)
            return shadow.filtered(points, footprint_px=footprint, normals=normals)
        side = {"hard": 1, "pcf3": 3, "pcf5": 5}[self.filter]
        return shadow.pcf(points, footprint=side, normals=normals, image=image)


def lighting(
    shadow: "ShadowMap | PathLike | None", filter: str | None = None, image: int = 0, /
) -> Lighting | None:
    """The light of a shadow map or its file, None for None.

    Raises
    ------
    FovealError
        If the file cannot be read, or there is no such filter or image.
    """
    if filter is not None and filter not in FILTERS:
        raise FovealError(f"the shadow filter {filter!r} is not known; choose one of {', '.join(FILTERS)}.")
    if shadow is None:
        return None
    found: Any = shadow
    if not hasattr(found, "trees"):
        from foveal.shadows.file import read_shadow

        found = read_shadow(found)
    has_surface = hasattr(found.light, "light")
    chosen = filter or ("soft" if has_surface else "pcf3")
    if chosen == "soft" and not found.is_stack:
        raise FovealError(
            'the shadow filter "soft" is of the light of a surface; this shadow has one image. Try "pcf5".'
        )
    if chosen == "filtered" and found.is_stack:
        raise FovealError(
            'the shadow filter "filtered" is of one image; this shadow is a stack. Try "pcf5" or "soft".'
        )
    if not 0 <= image < found.images:
        raise FovealError(f"the shadow has images 0 to {found.images - 1}; there is no image {image}.")
    return Lighting(found, chosen, image)


def lighting_of(scene: Scene, filter: str | None = None, image: int = 0, /) -> Lighting | None:
    """The light of a scene that has one."""
    return lighting(scene.light, filter, image)
