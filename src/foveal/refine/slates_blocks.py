"""Limit points and normals of patches, kept as deep as they were ever wanted.

A patch has a block of (2^d + 1)^2 rows, of which coarser depths take every second, fourth, .. row and column;
and for each side beyond which it is deeper than its own block a rim of 2^d + 1 rows. Points do not move with
the depth, so a block is made anew only to become deeper, or when the control mesh moved near it.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import DTypeLike, NDArray

from foveal.base.tasks import threads

from ._kernels_slates import tessellate
from ._kernels_slates_cage import touched
from ._kernels_slates_rims import rims
from ._kernels_slates_vertices import vertex_limits
from .slates_arena import Arena, ranges
from .slates_cage import SlateCage
from .slates_work import Rows, Work

__all__ = ["Blocks", "Places"]

#: Rows that are worth to be computed by several workers: 3 ms of one, where threads to begin take 0.2.
_WORTH_WORKERS = 60_000

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Places(NamedTuple):
    """Where things are in the rows.

    Attributes
    ----------
    places, depths : (m,) int64, int8
        Of blocks; the depth is -1 where there is none.
    rims, rim_depths : (4 m,) int64, int8
        The same of sides.
    """

    places: Ints
    depths: NDArray[np.int8]
    rims: Ints
    rim_depths: NDArray[np.int8]


class Blocks:
    """The blocks and rims of all patches of a control mesh.

    Attributes
    ----------
    places : Places
    points : list of (n, 3) float64
        Of the quadrangles' vertices: positions, then further columns by three.
    corner_points, corner_normals : list of (n, 3) float64, (t, 3) float64
        Limits at vertices.
    """

    def __init__(
        self, cage: SlateCage, columns: list[Floats], dtype: DTypeLike, /, *, workers: int = 1
    ) -> None:
        self._cage, net = cage, cage.net
        m, normals = len(net.grid), int(net.normal_starts[-1])
        self._columns = columns
        self._arena = Arena(*((3, dtype),) * (len(columns) + 1))
        self._workers, self._works = workers, [Work.of(net, 0)]
        places, depths = np.zeros(m, np.int64), np.full(m, -1, np.int8)
        self.places = Places(places, depths, np.zeros(4 * m, np.int64), np.full(4 * m, -1, np.int8))
        self.points = [cage.points(column) for column in columns]
        self.corner_points = [np.zeros_like(points) for points in self.points]
        self.corner_normals = np.zeros((normals, 3))
        self._spare = np.zeros((normals, 3)) if len(columns) > 1 else self.corner_normals
        self._is_stale = np.zeros(m, np.bool_)
        self._written = np.zeros(0, np.int64), np.zeros(0, np.int64)
        self._limits(np.arange(len(self.points[0])))

    def _limits(self, vertices: Ints) -> None:
        for i, points in enumerate(self.points):
            normals = self._spare if i else self.corner_normals
            vertex_limits(self._cage.net, points, vertices, self.corner_points[i], normals)

    def move(self, positions: Floats, /) -> tuple[Ints, Ints]:
        """New positions of the control mesh; which vertices and patches have such in their rings."""
        net, points = self._cage.net, self._cage.points(positions)
        is_vertex, is_patch = np.empty(len(points), np.bool_), np.empty(len(net.grid), np.bool_)
        touched(net, (points != self.points[0]).any(axis=1), is_vertex, is_patch)
        self.points[0] = points
        vertices = np.flatnonzero(is_vertex)
        self._limits(vertices)
        self._is_stale |= is_patch
        return vertices, np.flatnonzero(is_patch)

    @property
    def rows(self) -> list[NDArray[Any]]:
        """Positions, normals, further columns by three: (rows, 3) each, of all that was ever computed."""
        columns = self._arena.columns
        return [column[: self._arena.rows] for column in (columns[0], columns[-1], *columns[1:-1])]

    def changed(self) -> Ints:
        """(r, 2): ranges of rows that the last `ensure` wrote."""
        here, (patches, sides) = self.places, self._written
        sizes = _rows_of(here.depths[patches]), _points_of(here.rim_depths[sides])
        return ranges(np.concatenate([here.places[patches], here.rims[sides]]), np.concatenate(sizes))

    def ensure(self, depths: NDArray[np.int8], sides: NDArray[np.int8], /) -> tuple[NDArray[np.bool_], Ints]:
        """Blocks and rims as deep as wanted, at least.

        Parameters
        ----------
        depths : (m,) int8
            Of blocks, -1 for none.
        sides : (4 m,) int8
            The depth wanted along a side, -1 for none.

        Returns
        -------
        (m,) bool, (p,) int64
            Patches of which something is elsewhere now, and patches whose blocks were computed.
        """
        here, stale = self.places, self._is_stale
        is_new = (depths > here.depths) | (stale & (depths >= 0))
        is_lost = (is_new & (depths != here.depths) & (here.depths >= 0)) | (stale & (depths < 0))
        patches = np.flatnonzero(is_new)
        is_elsewhere = is_new & (depths != here.depths)
        self._release(np.flatnonzero(is_lost & (here.depths >= 0)))
        here.depths[is_lost] = -1
        fresh = patches[depths[patches] != here.depths[patches]]
        here.places[fresh] = self._arena.allocate(_rows_of(depths[fresh]))
        here.depths[fresh] = depths[fresh]
        rim, is_fresh = self._place_rims(sides, np.repeat(stale, 4))
        is_elsewhere[rim[is_fresh] // 4] = True
        stale[depths >= 0] = False
        stale[is_lost & (depths < 0)] = False
        self._compute(patches, rim)
        return is_elsewhere, patches

    def _place_rims(
        self, sides: NDArray[np.int8], stale: NDArray[np.bool_]
    ) -> tuple[Ints, NDArray[np.bool_]]:
        """Which rims are to be computed, and which of these have a new place."""
        here = self.places
        wanted = np.where(sides > np.repeat(here.depths, 4), sides, -1)
        is_kept = stale & (wanted == here.rim_depths)
        is_new = (wanted > here.rim_depths) | (stale & (wanted >= 0))
        dropped = np.flatnonzero((is_new | stale) & ~is_kept & (here.rim_depths >= 0))
        self._arena.release(here.rims[dropped], _points_of(here.rim_depths[dropped]))
        here.rim_depths[dropped] = -1
        placed = np.flatnonzero(is_new & ~is_kept)
        here.rim_depths[placed] = wanted[placed]
        here.rims[placed] = self._arena.allocate(_points_of(wanted[placed]))
        rim = np.flatnonzero(is_new)
        return rim, ~is_kept[rim]

    def _release(self, patches: Ints) -> None:
        self._arena.release(self.places.places[patches], _rows_of(self.places.depths[patches]))

    def _compute(self, patches: Ints, sides: Ints) -> None:
        """Blocks and rims, each where it belongs, so that several workers need not know of each other."""
        here, net = self.places, self._cage.net
        self._written = patches, sides
        depths, rim_depths = here.depths[patches], here.rim_depths[sides]
        deepest = max(int(depths.max(initial=0)), int(rim_depths.max(initial=0)))
        parts = self._workers if int(_rows_of(depths).sum()) > _WORTH_WORKERS else 1
        if deepest > self._works[0].depth or parts > len(self._works):
            deepest = max(deepest, self._works[0].depth)
            self._works = [Work.of(net, deepest) for _ in range(max(parts, len(self._works)))]
        if parts == 1:
            self._compute_part(self._works[0], patches, sides)
            return
        shares = [(patches[i::parts], sides[i::parts]) for i in range(parts)]
        with threads(parts) as pool:
            list(pool.map(self._compute_part, self._works, *zip(*shares, strict=True)))

    def _compute_part(self, work: Work, patches: Ints, sides: Ints) -> None:
        here, net = self.places, self._cage.net
        depths, rim_depths = here.depths[patches], here.rim_depths[sides].astype(np.int64)
        columns = self._arena.columns
        for i, points in enumerate(self.points):
            out = Rows(columns[i], columns[-1])
            data = points, self.corner_points[i], self.corner_normals
            for depth in np.unique(depths).tolist():
                chosen = patches[depths == depth]
                tessellate(net, work, *data, chosen, here.places[chosen], depth, out, i == 0)
            rims(net, work, *data, sides, rim_depths, here.rims[sides], out, i == 0)

    @property
    def bytes_beside(self) -> int:
        """What is kept beside rows of output: slates, limits at vertices, where things are."""
        own = [*self.points, *self.corner_points, self.corner_normals]
        return sum(array.nbytes for arrays in (*self._works, self.places, own) for array in arrays)


def _rows_of(depths: NDArray[np.int8]) -> Ints:
    return _points_of(depths) ** 2


def _points_of(depths: NDArray[np.int8]) -> Ints:
    points: Ints = (1 << depths.astype(np.int64)) + 1
    return points
