"""From casters and a projection to a tree: squares of the map on all processors, then what is above them."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor, ordered_map

from . import _kernels_cover as cover
from . import _kernels_pixels as pixels
from . import _kernels_tiles as tiles
from ._kernels_flat import Flat
from ._kernels_sets import KEPT
from .flat import PLACE_BITS
from .stream import AHEAD, Part, clear, empty_up, joined, part_of
from .tree import Tree

__all__ = [
    "MOST_NODES",
    "Pool",
    "pixels_of_triangles",
    "refuse_too_many",
    "tree_of_pixels",
    "tree_of_triangles",
]

MOST_NODES = 1 << 28
"""Nodes under construction at most: 2.4 GB. A closed scene of 1.5 million triangles at a million pixels
a side takes a quarter."""
_CODES = 1 << 16
_HITS = 1 << 14


def tree_of_triangles(
    flat: Flat,
    levels: int,
    /,
    *,
    executor: Executor,
    is_strict: bool = False,
    is_sparse: bool = True,
    most: int = KEPT,
    progress: Progress = SILENT,
) -> Tree:
    """The tree of a map of 2^levels pixels a side, from triangles."""
    top = min(7, max(0, levels - 8))
    squares = _dealt(flat, levels, top)
    scratch = Pool()

    def make(square: int) -> Part:
        triangles = squares.of(square)
        # Of its own, so that what is read again and again is together.
        own = flat._replace(
            corners=flat.corners[triangles],
            planes=flat.planes[triangles],
            depths=flat.depths[triangles],
            edges=flat.edges[triangles],
            sides=flat.sides[triangles],
        )
        with scratch.taken() as mine:
            return mine.part(own, square, levels - top, PLACE_BITS - levels, is_strict, is_sparse, most)

    with progress.stage("Tracing depth", float(4**top)) as stage:
        parts = []
        nodes = 0
        for part in ordered_map(executor, make, range(4**top), ahead=AHEAD):
            parts.append(part)
            nodes += len(part.codes)
            refuse_too_many(nodes)
            stage.advance()
    return joined(parts, levels, top, children=4, most=most, executor=executor)


def refuse_too_many(nodes: int, /) -> None:
    """Stop before memory is full.

    Raises
    ------
    FovealError
        If there are more than MOST_NODES.
    """
    if nodes > MOST_NODES:
        raise FovealError(
            f"the tree would have more than {MOST_NODES} nodes, more than memory is meant for: too much of "
            "the model is sheets or grazed by the light. Take a lower resolution, or exits 'surface'."
        )


@dataclass(frozen=True, slots=True)
class _Squares:
    starts: NDArray[np.int64]
    triangles: NDArray[np.int32]

    def of(self, square: int) -> NDArray[np.int32]:
        return self.triangles[self.starts[square] : self.starts[square + 1]]


def _dealt(flat: Flat, levels: int, top: int) -> _Squares:
    counts = np.zeros(4**top, np.int64)
    size = (PLACE_BITS - levels, levels - top, top)
    tiles.deal(flat, *size, counts, np.empty(0, np.int32))
    starts = np.concatenate([[0], np.cumsum(counts)])
    triangles = np.empty(starts[-1], np.int32)
    tiles.deal(flat, *size, starts[:-1].copy(), triangles)
    return _Squares(starts, triangles)


class _Scratch:
    """What one square at a time is made in; it grows when a square wants more."""

    def __init__(self) -> None:
        self._codes, self._lists, self._hits = _CODES, 1 << 14, _HITS
        self._make()

    def _make(self) -> None:
        self.up = empty_up(self._codes, levels=20, children=4)
        self.work = _work(self._hits, tiles.BLOCK**2, self._lists)

    def part(self, flat: Flat, /, *options: int) -> Part:
        """The stream of a square from all triangles that meet it."""
        count = len(flat.corners)
        while 2 * count > self._lists or count > self._hits:
            self._lists *= 2
            self._hits = max(self._hits, self._lists)
            self._make()
        while True:
            clear(self.up)
            self.work.lists[:count] = np.arange(count, dtype=np.int32)
            state = tiles.up_from_triangles(self.up, flat, self.work, count, *options)
            if state == tiles.DONE:
                break
            self._codes *= 2 if state == tiles.NO_STREAM else 1
            refuse_too_many(self._codes)
            self._lists *= 2 if state == tiles.NO_LIST else 1
            self._hits = max(self._hits, self._lists)
            self._make()
        return part_of(self.up)


class Pool:
    """Scratch for as many squares as are under way at once, made when first wanted."""

    def __init__(self) -> None:
        self._free: list[_Scratch] = []

    @contextmanager
    def taken(self) -> Iterator[_Scratch]:
        """Some, which is given back after the block."""
        try:
            mine = self._free.pop()
        except IndexError:
            mine = _Scratch()
        yield mine
        self._free.append(mine)


def _work(hits: int, pixels_a_block: int, lists: int = 0) -> tiles.Work:
    return tiles.Work(
        lists=np.empty(lists, np.int32),
        list_starts=np.zeros(24, np.int64),
        hits=np.empty(hits, np.int64),
        hit_count=np.empty(pixels_a_block, np.int64),
        lower=np.empty(pixels_a_block, np.int64),
        upper=np.empty(pixels_a_block, np.int64),
        least=np.empty(cover.MOST, np.int64),
        greatest=np.empty(cover.MOST, np.int64),
        near=np.empty(cover.MOST + 1, np.int32),
        stamp=np.zeros(1, np.int64),
        stamps=np.zeros(cover.SLOTS, np.int64),
        keys=np.empty(cover.SLOTS, np.int32),
        sums=np.empty(cover.SLOTS, np.int32),
        slots=np.empty(3 * cover.MOST, np.int32),
    )


def pixels_of_triangles(
    flat: Flat, levels: int, /, *, executor: Executor, is_strict: bool = False
) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """(side, side) lowest and highest legal value of each pixel of a map: what trees are held to."""
    size = min(levels, 5)
    squares = _dealt(flat, levels, levels - size)
    room = int(np.diff(squares.starts).max()) << (2 * size)
    lower = np.empty((1 << levels, 1 << levels), np.uint32)
    upper = np.empty_like(lower)

    def make(numbers: NDArray[np.int64]) -> None:
        work = _work(max(1, room), 1 << (2 * size))._replace(lists=squares.triangles)
        bits = PLACE_BITS - levels
        tiles.pixels_of_squares(*(flat, work, squares.starts, numbers, size, bits, is_strict, lower, upper))

    for _ in ordered_map(executor, make, np.array_split(np.arange(4 ** (levels - size)), 8), ahead=AHEAD):
        pass
    return lower, upper


def tree_of_pixels(
    lower: NDArray[np.int64], upper: NDArray[np.int64], /, *, executor: Executor, most: int = KEPT
) -> Tree:
    """The tree of a map from its pixels' intervals, (side, side), or of a stack from (images, side, side).

    Both ends are legal.
    """
    children = 8 if lower.ndim == 3 else 4
    levels = lower.shape[-1].bit_length() - 1
    shape = (-1, *lower.shape[-2:])
    up = empty_up(2 * lower.size + 100, levels=levels, children=children)
    while not pixels.up_from_pixels(up, lower.reshape(shape), upper.reshape(shape), levels, most):
        up = empty_up(2 * len(up.codes), levels=levels, children=children)
        clear(up)
    return joined([part_of(up)], levels, 0, children=children, most=most, executor=executor)
