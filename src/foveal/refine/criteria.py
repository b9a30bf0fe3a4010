"""What is refined for a view: how often, down to which edge in pixels, where the surface bends."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foveal.view.camera import Camera

__all__ = ["MAX_LEVEL", "Criteria", "Region", "view_of"]

#: Iterations at most: 3^30 triangles for one are far more than a double can tell apart.
MAX_LEVEL = 30


@dataclass(frozen=True, slots=True)
class Region:
    """When a triangle is fine enough; it is split while none of these holds.

    Attributes
    ----------
    iterations : int
        Never finer than this level.
    edge_px : float
        Its longest edge is at most so many pixels; 0 for no such limit.
    bend : float
        Its normal and the limit surface's at its corner differ by at most this angle, in radians.
    """

    iterations: int = 6
    edge_px: float = 0.0
    bend: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.iterations <= MAX_LEVEL or int(self.iterations) != self.iterations:
            raise ValueError(
                f"iterations must be a whole number from 0 to {MAX_LEVEL}, got {self.iterations}"
            )
        if not (math.isfinite(self.edge_px) and self.edge_px >= 0):
            raise ValueError(f"edge_px must be a length in pixels or 0, got {self.edge_px}")
        if not 0 <= self.bend <= math.pi:
            raise ValueError(f"bend must be an angle from 0 to pi, got {self.bend}")


@dataclass(frozen=True, slots=True)
class Criteria:
    """Limits apart for what faces the eye, what is on the silhouette, and what faces away.

    Defaults are the paper's way: fine silhouettes, coarser fronts, backs left alone.
    """

    front: Region = field(default_factory=lambda: Region(4, 8.0))
    silhouette: Region = field(default_factory=lambda: Region(6, 4.0))
    back: Region = field(default_factory=lambda: Region(0))

    def limits(self) -> NDArray[np.float64]:
        """(6, 3): what kernels read; the bend as 1 - cos. The last three rows for what is hidden."""
        return np.array(
            [
                (r.iterations, r.edge_px, 1 - math.cos(r.bend))
                for r in (self.front, self.silhouette, self.back, self.back, self.back, self.back)
            ]
        )


def view_of(camera: Camera, /) -> NDArray[np.float64]:
    """(24,): the eye, pixels per radian, the frustum's five planes."""
    return np.concatenate([camera.position, [camera.pixels_per_radian()], camera.frustum().reshape(-1)])
