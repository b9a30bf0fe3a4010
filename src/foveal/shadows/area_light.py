"""A light with a surface: a stack of maps, each from one place of it."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError

from .frames import (
    basis,
    checked_resolution,
    cone_window,
    parallel,
    seen_along,
    seen_from,
    through_window,
    unit,
)
from .projection import Projection
from .samples import on_a_disc, on_a_square
from .single_lights import Directional, Spot, Sun, set_fields

__all__ = ["MOST_IMAGES", "MOST_RADIUS", "SUN_RADIUS", "AreaLight"]

MOST_IMAGES = 4096
MOST_RADIUS = math.radians(45)
"""Of a disc of parallel light. The sun's is 0.27 degrees; beyond 45 no direction would be the middle one."""
SUN_RADIUS = math.radians(0.2666)
"""Half the sun's angular diameter, as the year has it in the mean."""


@dataclass(frozen=True)
class AreaLight:
    """A spot light, sunlight or parallel light that comes from a surface, sampled: one image a sample.

    Around a spot light's position the surface is a disc or a rectangle across its axis. Around a direction it
    is a disc or a rectangle of directions. All images look through one window, on the plane across the
    middle direction in the middle of the scene's depths: what lies there is at the same pixel in each, and
    what lies near it nearly so, which is what an octree of the stack lives on. Samples are in Hilbert order.

    Attributes
    ----------
    light : Spot, Sun or Directional
        The middle.
    radius : float or None
        Of the disc: a length, or of directions an angle in radians, up to 45 degrees.
    size : (float, float) or None
        Instead, width and height of the rectangle, likewise.
    samples : int
        1, 4, 16, ... up to 4096: a grid of a power of two.
    jitter : bool
        Whether each sample is at random in its cell of the grid, not in the middle.
    seed : int
        By which random numbers.

    Raises
    ------
    FovealError
        If a number is out of range.

    Examples
    --------
    >>> lamp = AreaLight(Spot((0, 0, 4), (0, 0, 0)), radius=0.5, samples=16)
    >>> projections = lamp.projections([[-1, -1, 0], [1, 1, 0], [0, 0, 2]], 512)
    >>> len(projections), lamp.images
    (16, 16)
    >>> in_window = [projection.project([[0.5, 0.5, 1]])[0] for projection in projections]
    >>> float(np.ptp(in_window, axis=0).max().round(12))  # in the middle of the depths all stays in place
    0.0
    """

    light: Spot | Sun | Directional
    radius: float | None = None
    size: tuple[float, float] | None = None
    samples: int = 64
    jitter: bool = False
    seed: int = 0

    is_stack: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not isinstance(self.light, (Spot, Sun, Directional)):
            raise FovealError("an area light is made of a spot light, the sun or parallel light.")
        if (self.radius is None) == (self.size is None):
            raise FovealError("an area light has either a radius or a width and height. Say one.")
        largest = math.inf if isinstance(self.light, Spot) else MOST_RADIUS
        extents = [self.radius] if self.size is None else [extent / 2 for extent in self.size]
        for extent in extents:
            if not (extent and 0 < extent <= largest and math.isfinite(extent)):
                limit = "" if largest == math.inf else f" and at most {math.degrees(largest):g} degrees"
                raise FovealError(f"the extent of an area light must be above 0{limit}, got {extent:g}.")
        grids = [4**k for k in range(7)]
        if self.samples not in grids:
            raise FovealError(
                f"the samples must be a grid of a power of two, so one of {', '.join(map(str, grids))}; "
                f"got {self.samples}."
            )
        if self.seed < 0:
            raise FovealError(f"the seed must be 0 or more, got {self.seed}.")
        if self.size is not None:
            set_fields(self, size=(float(self.size[0]), float(self.size[1])))

    @property
    def images(self) -> int:
        """How many maps there are: one for each sample."""
        return self.samples

    @cached_property
    def offsets(self) -> NDArray[np.float64]:
        """(images, 2): where each sample is, to the right and up of the middle, in lengths or radians."""
        square = on_a_square(self.samples, jitter=self.jitter, seed=self.seed)
        if self.size is not None:
            return square * (np.array(self.size) / 2)
        assert self.radius is not None
        return on_a_disc(square) * self.radius

    @cached_property
    def _rows(self) -> NDArray[np.float64]:
        if isinstance(self.light, Spot):
            return basis(self.light.axis)
        return basis(self.light.direction)

    @cached_property
    def places(self) -> NDArray[np.float64]:
        """(images, 3): where each sample is, or of directions the unit vector that the light travels."""
        right, up, ahead = self._rows
        x, y = self.offsets[:, :1], self.offsets[:, 1:]
        if isinstance(self.light, Spot):
            return np.asarray(self.light.position + x * right + y * up, np.float64)
        return unit(ahead + np.tan(x) * right + np.tan(y) * up)

    def projections(self, positions: ArrayLike, resolution: int, /) -> tuple[Projection, ...]:
        """One for each image, through one window that is tight around (n, 3) positions."""
        checked_resolution(resolution, images=self.images)
        if isinstance(self.light, Spot):
            return self._from_places(positions)
        seen = seen_along(self.light.direction, positions)
        return oblique(seen, np.tan(self.offsets))

    def _from_places(self, positions: ArrayLike) -> tuple[Projection, ...]:
        assert isinstance(self.light, Spot)
        seen = seen_from(self.light.position, self.light.axis, positions)
        ends = _ends(self.offsets)
        window, depths, plane = cone_window(seen, math.tan(self.light.angle / 2), ends)
        return tuple(
            through_window(seen, window, depths, (x, y), plane=plane) for x, y in self.offsets.tolist()
        )

    def towards(self, points: ArrayLike, /, image: int = 0) -> NDArray[np.float64]:
        """(n, 3): unit vectors from points to the light's place of one image."""
        if isinstance(self.light, Spot):
            return unit(self.places[image] - np.asarray(points, np.float64))
        return np.broadcast_to(-self.places[image], np.shape(points)).copy()

    def to_json(self) -> dict[str, Any]:
        """As files keep it; angles in degrees. `places` are there for who does not reckon with samples."""
        is_placed = isinstance(self.light, Spot)
        scale = 1.0 if is_placed else math.degrees(1)
        extent: dict[str, Any] = {} if self.radius is None else {"radius": self.radius * scale}
        if self.size is not None:
            extent = {"size": [length * scale for length in self.size]}
        return {
            "kind": "area",
            "light": self.light.to_json(),
            **extent,
            "samples": self.samples,
            "jitter": self.jitter,
            "seed": self.seed,
            "positions" if is_placed else "directions": self.places.tolist(),
        }


def _ends(slopes: NDArray[np.float64]) -> tuple[tuple[float, float], tuple[float, float]]:
    (left, below), (right, above) = slopes.min(axis=0).tolist(), slopes.max(axis=0).tolist()
    return (left, right), (below, above)


def oblique(seen: Any, slopes: NDArray[np.float64], /) -> tuple[Projection, ...]:
    """Parallel light of several directions through one window.

    Parameters
    ----------
    seen : Seen
        Along the middle direction.
    slopes : (n, 2)
        How far each goes to the right and up for a step ahead.
    """
    # The plane at the median of depths in place of their middle took 0.4 % off a stack: not worth a pass.
    x, y = _ends(slopes)
    window = seen.extremes(0, x), seen.extremes(1, y)
    return tuple(parallel(seen, window, (a, b)) for a, b in slopes.tolist())
