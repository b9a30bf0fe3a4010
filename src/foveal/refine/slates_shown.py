"""Which triangles are shown: those of every patch of every placement, in runs that stay where they are."""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_slates_show as kernels
from .slates_arena import Arena, ranges
from .slates_blocks import Places
from .slates_cage import SlateCage

__all__ = ["Shown"]

Ints = NDArray[np.int64]


class Shown:
    """The triangles of `placements` times m patches. An entry is placement · m + patch.

    Attributes
    ----------
    depths, sides : (placements · m,) int8, (4 · placements · m,) int8
        Depths shown, -1 for holes, and the depths along sides.
    triangles : int
    places, counts : (placements · m,) int64
        Of each entry's triangles in `rows`.
    """

    def __init__(self, cage: SlateCage, placements: int, /) -> None:
        self._cage, count = cage, placements * len(cage.net.grid)
        self._arena = Arena((3, np.int32), (1, np.uint8))
        self.depths, self.sides = np.full(count, -1, np.int8), np.full(4 * count, -1, np.int8)
        self.places, self.counts = np.zeros(count, np.int64), np.zeros(count, np.int64)
        self.triangles = 0
        none = np.zeros(0, np.int64)
        self._written = none, none, none, none

    @property
    def rows(self) -> NDArray[np.int32]:
        """(rows, 3): of all that was ever lent; what is free now is (0, 0, 0)."""
        return self._arena.columns[0][: self._arena.rows]

    @property
    def levels(self) -> NDArray[np.uint8]:
        """(rows,): depths of the patches that `rows` belong to; rounded up to a multiple of 4, zeros."""
        return self._arena.columns[1].reshape(-1)[: -(-self._arena.rows // 4) * 4]

    def along_sides(self, depths: NDArray[np.int8], /) -> NDArray[np.int8]:
        """Of each entry's sides: the larger of the depths of the two patches."""
        sides = np.empty(4 * len(depths), np.int8)
        kernels.edge_depths(self._cage.net, depths, sides)
        return sides

    def wanted(self, depths: NDArray[np.int8], sides: NDArray[np.int8], /) -> tuple[NDArray[np.int8], ...]:
        """What all placements together need of the blocks (m,), and of the rims (4 m,).

        A patch beside a deeper one is computed a step deeper than it is shown: hubs and cut edges lie there.
        A narrow slate for these alone would be linear in them, but have its own places for each depth and
        placement; a tenth more rows than are shown in a usual view, and half more at worst, were simpler.
        """
        m = len(self._cage.net.grid)
        blocks, rims = np.full(m, -1, np.int8), np.full(4 * m, -1, np.int8)
        kernels.gather_wanted(depths, sides, blocks, rims)
        return blocks, rims

    def show(
        self,
        depths: NDArray[np.int8],
        sides: NDArray[np.int8],
        places: Places,
        is_elsewhere: NDArray[np.bool_],
        /,
    ) -> Ints:
        """Write the triangles that are others now; gives their entries."""
        m = len(self._cage.net.grid)
        is_other = np.empty(len(depths), np.bool_)
        kernels.compare(depths, self.depths, sides, self.sides, is_elsewhere, is_other)
        chosen = np.flatnonzero(is_other)
        self._written = chosen, chosen, chosen, chosen
        if len(chosen) == 0:
            return chosen
        self.depths, self.sides = depths, sides
        old, before, counts = self.counts[chosen], self.places[chosen], self.counts
        for column in range(2):
            self._arena.clear(column, before, old)
        self._arena.release(before, old)
        kernels.triangles_of_each(chosen, depths, sides, counts)
        self.triangles += int(counts[chosen].sum() - old.sum())
        self.places[chosen] = self._arena.allocate(counts[chosen])
        rows, levels = self._arena.columns
        kernels.show(places, chosen, depths, sides, self.places, m, rows)
        kernels.show_levels(chosen, depths, self.places, counts, levels)
        self._written = before, old, self.places[chosen], counts[chosen]
        return chosen

    def changed(self) -> Ints:
        """(r, 2): ranges of rows that the last `show` wrote, also to clear them."""
        before, old, places, counts = self._written
        return ranges(np.concatenate([before, places]), np.concatenate([old, counts]))
