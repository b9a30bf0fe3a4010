"""A precomputed shadow: a light, how it projects, and the trees of its maps, to be asked what is lit."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike
from foveal.mesh.trimesh import TriMesh

from . import _kernels_lookup_points as kernels
from .bias import Window, as_normals, window_of
from .moving import Moving
from .pack import Packed, pack
from .projection import Projection
from .tree import Tree

if TYPE_CHECKING:
    from .light import Light, Point

__all__ = ["MOST_FOOTPRINT", "ShadowMap"]

MOST_FOOTPRINT = 63
"""Pixels along a side of a filter."""


@dataclass(frozen=True)
class ShadowMap:
    """What a light sees, at any resolution.

    Attributes
    ----------
    light : Light
        Whose shadow it is.
    projections : tuple of Projection
        One; six of a point light; of a stack one for each image.
    trees : tuple of Tree
        One; six of a point light, one for each projection; of a stack one octree for all.
    times : dict of str to float
        Seconds that each phase of building took; empty if it was read from a file.
    moving : Moving or None
        Maps of what moves, beside the trees; see `with_moving`.
    """

    light: "Light"
    projections: tuple[Projection, ...]
    trees: tuple[Tree, ...]
    times: dict[str, float] = field(default_factory=dict, compare=False, repr=False)
    moving: Moving | None = field(default=None, compare=False, repr=False)

    @property
    def resolution(self) -> int:
        """Pixels along a side of each map."""
        return 1 << self.trees[0].levels

    @property
    def is_stack(self) -> bool:
        """Whether there are many images in one octree."""
        return self.trees[0].children == 8

    @property
    def images(self) -> int:
        """How many images there are to be asked: 1 if it is no stack."""
        return len(self.projections) if self.is_stack else 1

    @cached_property
    def packed(self) -> tuple[Packed, ...]:
        """The trees as words, made when first asked for."""
        return tuple(pack(tree) for tree in self.trees)

    @cached_property
    def windows(self) -> tuple[Window, ...]:
        """What lookups know of the projections."""
        return tuple(window_of(projection, self.trees[0].levels) for projection in self.projections)

    def lookup(
        self, points: ArrayLike, /, *, normals: ArrayLike | None = None, image: int = 0
    ) -> NDArray[np.bool_]:
        """Whether points are lit.

        Parameters
        ----------
        points : (n, 3)
            In the axes and unit of what was built.
        normals : (n, 3), optional
            Unit normals of the surface at the points, on the side that is seen: with them no surface shades
            itself (`spec/shadows.md`, "Bias"). Without, the test is that of the map, exactly.
        image : int
            Of a stack, which, from 0.

        Returns
        -------
        (n,) bool
            Lit, also where the map does not reach.

        Raises
        ------
        ValueError
            If there is no such image, or the arrays do not fit each other.

        Examples
        --------
        >>> from foveal.shadows.tree import LEAF
        >>> down = Projection(np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, 1], [0, 0, 0, 1.0]]))
        >>> half_way = (np.array([1 << 31], np.uint32), np.array([0, 1, 1, 1, 1, 1]))
        >>> tree = Tree(4, 4, LEAF, np.empty(0, np.uint16), np.zeros(5, np.int64), *half_way)
        >>> ShadowMap(None, (down,), (tree,)).lookup([[0.2, 0.2, 0.9], [0.2, 0.2, 0.1], [7, 7, 0.1]])
        array([ True, False,  True])
        """
        return self._shares(points, normals, image, radius=0) > 0.5

    def pcf(
        self, points: ArrayLike, /, footprint: int = 3, *, normals: ArrayLike | None = None, image: int = 0
    ) -> NDArray[np.float32]:
        """How much of the pixels around points is lit (percentage-closer filtering).

        Parameters
        ----------
        footprint : int
            Pixels along a side of the filter: odd, up to 63.
        points, normals, image
            As for `lookup`.

        Returns
        -------
        (n,) float32
            From 0 to 1.

        References
        ----------
        Reeves, Salesin, Cook 1987. Rendering antialiased shadows with depth maps.
        Scandolo, Bauszat, Eisemann 2016, section 3.3.

        Examples
        --------
        >>> from foveal.mesh.shapes import icosphere
        >>> from foveal.shadows import Directional, build
        >>> shadow = build(icosphere(3), Directional((0, 0, -1)), resolution=64)
        >>> shadow.pcf([[0, 0, -2], [0.98, 0, -2], [1.2, 0, -2]], 5).round(2)
        array([0. , 0.4, 1. ], dtype=float32)
        """
        if not (1 <= footprint <= MOST_FOOTPRINT and footprint % 2 == 1):
            raise ValueError(f"footprint must be odd, from 1 to {MOST_FOOTPRINT}, got {footprint}")
        return self._shares(points, normals, image, radius=footprint // 2)

    def filtered(
        self, points: ArrayLike, /, *, footprint_px: ArrayLike, normals: ArrayLike | None = None
    ) -> NDArray[np.float32]:
        """How much is lit around points, at the level of the tree that fits how small they are seen.

        The two levels beside the footprint are blended, 3 x 3 pixels of each. Filtered, not lossless.

        Parameters
        ----------
        footprint_px : float or (n,)
            How many pixels of the map one pixel of the picture covers, along a side; see `footprints`.
        points, normals
            As for `lookup`.

        Raises
        ------
        FovealError
            Of a stack, whose coarser levels mix images.
        """
        if self.is_stack:
            raise FovealError(
                "coarser levels of a stack of shadow maps mix its images; use pcf or soft for it."
            )
        points, normals = _checked(points, normals)
        levels = self.trees[0].levels
        depth = np.log2(np.maximum(np.broadcast_to(footprint_px, len(points)), 1.0))
        depth = np.minimum(np.nan_to_num(depth, nan=0.0), levels)
        out = np.zeros(len(points), np.float32)
        for up in range(levels + 1):
            share = np.maximum(1 - np.abs(depth - up), 0.0)
            asked = np.flatnonzero(share)
            if len(asked):
                some = normals[asked] if len(normals) else normals
                out[asked] += share[asked] * self._shares(points[asked], some, 0, radius=1, level=levels - up)
        return out

    def soft(
        self, points: ArrayLike, /, *, samples: int | None = None, normals: ArrayLike | None = None
    ) -> NDArray[np.float32]:
        """The mean over the images of a stack: of an area light how much of it is seen.

        Parameters
        ----------
        samples : int, optional
            How many images to ask, evenly spaced; by default all.
        points, normals
            As for `lookup`.
        """
        count = self.images if samples is None else min(samples, self.images)
        if count < 1:
            raise ValueError(f"samples must be at least 1, got {samples}")
        points, normals = _checked(points, normals)
        total = np.zeros(len(points))
        for image in np.arange(count) * self.images // count:
            total += self._shares(points, normals, int(image), radius=0)
        return (total / count).astype(np.float32)

    def footprints(self, points: ArrayLike, spans: ArrayLike, /, *, image: int = 0) -> NDArray[np.float64]:
        """How many pixels of the map lie along steps from points.

        Parameters
        ----------
        points : (n, 3)
        spans : (n, k, 3)
            Steps in the world, for instance to where the neighbouring pixels of a picture look.

        Returns
        -------
        (n,) float64
            Of each point's steps the longest.
        """
        points, _ = _checked(points, None)
        spans, out = np.asarray(spans, np.float64), np.zeros(len(points))
        for number, part in self._parts(points, image):
            matrix = self.windows[number].matrix
            x, y, _, w = matrix[:, :3] @ points[part].T + matrix[:, 3:]
            dx, dy, _, dw = np.moveaxis(spans[part] @ matrix[:, :3].T, -1, 0)
            x, y, w = x[:, None], y[:, None], w[:, None]
            out[part] = np.hypot(dx - x / w * dw, dy - y / w * dw).max(axis=1) / np.abs(w[:, 0])
        return out * self.resolution

    def with_moving(self, mesh: TriMesh | None, /, *, resolution: int = 1024) -> Self:
        """The same shadow with an ordinary depth map beside it of things that move, or None for no such.

        They cast on what is static and on each other, and what is static casts on them: lit is what both
        say is lit. The trees are shared. Below open sheets those of exits "surface" may light what moves;
        build with exits="strict" then. `resolution`, a power of two, is of that map's side.
        """
        moving = None if mesh is None else Moving.of(mesh, self.projections, resolution)
        beside = replace(self, moving=moving)
        beside.__dict__["packed"] = self.packed
        return beside

    def save(self, path: PathLike, /) -> None:
        """Write it as a `.fov` of kind shadow, without what moves.

        Raises
        ------
        FovealError
            If `path` cannot be written.
        """
        from .file import write_shadow

        write_shadow(self, path)

    def _place(self, image: int) -> int:
        """Where an image is along the third axis of an octree."""
        spread = self.trees[0].spread
        return image << spread if spread >= 0 else image >> -spread

    def _parts(self, points: NDArray[np.float64], image: int) -> list[tuple[int, Any]]:
        """Which points each projection is asked about."""
        if not 0 <= image < self.images:
            raise ValueError(f"image must be from 0 to {self.images - 1}, got {image}")
        if self.is_stack or len(self.projections) == 1:
            return [(image, slice(None))]
        faces = cast("Point", self.light).face(points)
        return [(number, np.flatnonzero(faces == number)) for number in range(len(self.projections))]

    def _shares(
        self,
        points: ArrayLike,
        normals: ArrayLike | None,
        image: int,
        *,
        radius: int,
        level: int | None = None,
    ) -> NDArray[np.float32]:
        points, normals = _checked(points, normals)
        out = np.empty(len(points), np.float32)
        level = self.trees[0].levels if level is None else level
        for number, part in self._parts(points, image):
            packed = self.packed[0 if self.is_stack else number]
            some = normals[part] if len(normals) else normals
            shares = np.empty(len(points[part]), np.float32)
            asked = (
                self.windows[number],
                level,
                radius,
                self._place(image),
                len(self.projections) > 1 and not self.is_stack,
            )
            kernels.lit_shares(packed, *asked, points[part], some, shares)
            if self.moving is not None:
                self.moving.darken(number, points[part], some, radius, shares)
            out[part] = shares
        return out


def _checked(points: ArrayLike, normals: ArrayLike | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    array = np.ascontiguousarray(points, np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"points must be (n, 3), got {array.shape}")
    if normals is not None and np.shape(normals) == (0, 3):
        normals = None
    return array, as_normals(normals, len(array))
