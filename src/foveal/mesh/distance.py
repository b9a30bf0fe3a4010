"""Distances between points and surfaces, and between two surfaces."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _kernels_distance as kernels
from .trimesh import TriMesh

__all__ = ["SurfaceIndex", "closest_distance", "mean_distance", "sample_surface", "sampled_hausdorff"]

_TRIANGLES_A_LEAF = 4  # measured: 2 to 8 differ by less than a tenth


class SurfaceIndex:
    """A mesh prepared for many questions of the kind "how far is this point from the surface?".

    The answers are exact up to rounding, for triangles of any size and shape. Reading it from several
    threads is safe, and the kernel lets them run side by side.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch
    >>> SurfaceIndex(grid_patch(4)).distance([[0.5, 0.5, 2.0], [-3.0, 0.5, 4.0]])
    array([2., 5.])
    """

    def __init__(self, mesh: TriMesh, /) -> None:
        if len(mesh.faces) == 0:
            raise ValueError("the mesh has no triangle to be near to")
        low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
        # Relative to the middle and in units of the size: no rounding by UTM offsets, no underflow.
        self._origin = (low + high) / 2
        self._scale = float((high - low).max()) or 1.0
        corners = ((mesh.positions - self._origin) / self._scale)[mesh.faces]
        self._order = _along_curve(corners.mean(axis=1))
        self._corners = corners[self._order]
        self._leaves = 1 << max(0, (len(corners) // _TRIANGLES_A_LEAF).bit_length())
        self._boxes = np.empty((2 * self._leaves, 6))
        kernels.fill_boxes(self._corners, self._leaves, self._boxes)

    def closest(self, points: ArrayLike, /) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """(k,) distances of points (k, 3) to the surface, and (k,) the triangles that are nearest."""
        places = np.ascontiguousarray(points, dtype=np.float64)
        if places.ndim != 2 or places.shape[1:] != (3,):
            raise ValueError(f"points must have shape (k, 3), got {places.shape}")
        places = (places - self._origin) / self._scale
        order = _along_curve(places)
        squares, which = np.empty(len(places)), np.empty(len(places), dtype=np.int64)
        kernels.closest(places[order], self._corners, self._leaves, self._boxes, squares, which)
        distances, triangles = np.empty(len(places)), np.empty(len(places), dtype=np.int64)
        distances[order] = np.sqrt(squares) * self._scale
        triangles[order] = self._order[which]
        return distances, triangles

    def distance(self, points: ArrayLike, /) -> NDArray[np.float64]:
        """(k,) distances of points (k, 3) to the surface."""
        return self.closest(points)[0]


def _along_curve(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """The order of points, in the unit cube around 0, along a Morton curve."""
    codes = np.empty(len(points), dtype=np.int64)
    kernels.morton_codes(np.ascontiguousarray(points), np.full(3, -0.5), 2.0**21, codes)
    return np.argsort(codes, kind="stable")


def closest_distance(points: ArrayLike, mesh: TriMesh, /) -> NDArray[np.float64]:
    """(k,) exact distances of points (k, 3) to the surface of a mesh; see `SurfaceIndex` for many calls.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch
    >>> closest_distance([[0.25, 0.25, -1.5]], grid_patch(1))
    array([1.5])
    """
    return SurfaceIndex(mesh).distance(points)


def sample_surface(mesh: TriMesh, count: int, /, *, seed: int = 0) -> NDArray[np.float64]:
    """(count, 3) points spread evenly by area; over the triangles if they have no area at all.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch
    >>> sample_surface(grid_patch(1), 1000).mean(axis=0).round(1)
    array([0.5, 0.5, 0. ])
    """
    rng = np.random.default_rng(seed)
    a, b, c = (mesh.positions[mesh.faces[:, i]] for i in range(3))
    scale = float(np.ptp(mesh.positions, axis=0).max()) or 1.0
    areas = np.linalg.norm(np.cross((b - a) / scale, (c - a) / scale), axis=1)
    total = np.cumsum(areas if areas.any() else np.ones(len(areas)))
    chosen = np.searchsorted(total, rng.uniform(0, total[-1], count), side="right")
    chosen = np.minimum(chosen, len(total) - 1)
    root, t = np.sqrt(rng.uniform(size=(count, 1))), rng.uniform(size=(count, 1))
    a, b, c = a[chosen], b[chosen], c[chosen]
    points: NDArray[np.float64] = a + root * (1 - t) * (b - a) + root * t * (c - a)
    return points


def _one_sided(a: TriMesh, b: TriMesh, samples: int, seed: int) -> float:
    points = sample_surface(a, samples, seed=seed)
    used = np.unique(a.faces)
    if len(used) > samples:
        used = np.random.default_rng(seed).choice(used, samples, replace=False)
    return float(closest_distance(np.concatenate([points, a.positions[used]]), b).max())


def sampled_hausdorff(
    a: TriMesh, b: TriMesh, /, *, samples: int = 100_000, seed: int = 0
) -> tuple[float, float]:
    """Lower bounds of the one-sided Hausdorff distances from `a` to `b` and from `b` to `a`.

    The largest exact distance of `samples` points of the surface, and of as many of its vertices, to
    the other surface. The true value is at least that.
    """
    return _one_sided(a, b, samples, seed), _one_sided(b, a, samples, seed)


def mean_distance(a: TriMesh, b: TriMesh, /, *, samples: int = 100_000, seed: int = 0) -> float:
    """The mean distance from the surface of `a` to that of `b`, estimated from `samples` points of `a`."""
    return float(closest_distance(sample_surface(a, samples, seed=seed), b).mean())
