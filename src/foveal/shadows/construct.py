"""From casters and a projection to a tree: squares of the map on all processors, then what is above them."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor, ordered_map, thread_count

from . import _kernels_cover as cover
from . import _kernels_pixels as pixels
from . import _kernels_stack as stack
from . import _kernels_stream as stream
from . import _kernels_tiles as tiles
from ._kernels_flat import Flat
from ._kernels_sets import KEPT
from .flat import PLACE_BITS
from .tree import Tree

__all__ = ["pixels_of_triangles", "tree_of_pixels", "tree_of_stack", "tree_of_triangles"]

MOST_NODES = 1 << 28
"""Nodes under construction at most: 2.4 GB. A closed scene of 1.5 million triangles at a million pixels
a side takes a quarter."""
_AHEAD = 8
_CODES = 1 << 16
_HITS = 1 << 14


@dataclass(frozen=True, slots=True)
class Part:
    """The stream of a square (see `_kernels_stream`): its nodes, and their intervals."""

    codes: NDArray[np.uint8]
    bounds: NDArray[np.uint32]


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
    scratch = _Pool()

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
        for part in ordered_map(executor, make, range(4**top), ahead=_AHEAD):
            parts.append(part)
            nodes += len(part.codes)
            _refuse_too_many(nodes)
            stage.advance()
    return joined(parts, levels, top, children=4, most=most, executor=executor)


def _refuse_too_many(nodes: int) -> None:
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
            _refuse_too_many(self._codes)
            self._lists *= 2 if state == tiles.NO_LIST else 1
            self._hits = max(self._hits, self._lists)
            self._make()
        return part_of(self.up)


class _Pool:
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

    for _ in ordered_map(executor, make, np.array_split(np.arange(4 ** (levels - size)), 8), ahead=_AHEAD):
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


def empty_up(codes: int, /, *, levels: int, children: int) -> stream.Up:
    """Room for a stream of so many nodes."""
    bounds = 2 * codes + stream.PUSH_BOUNDS
    ends = 2 * children * KEPT
    return stream.Up(
        codes=np.empty(codes, np.uint8),
        bounds=np.empty(bounds, np.uint32),
        at=np.zeros(2, np.int64),
        filled=np.zeros(levels + 1, np.int64),
        all_leaves=np.zeros(levels + 1, bool),
        begun=np.zeros((levels + 1, 2), np.int64),
        counts=np.zeros((levels + 1, children), np.int64),
        low=np.zeros((levels + 1, children, KEPT), np.int64),
        high=np.zeros((levels + 1, children, KEPT), np.int64),
        ends=np.zeros(ends, np.int64),
        steps=np.zeros(ends, np.int64),
        set_low=np.zeros(KEPT, np.int64),
        set_high=np.zeros(KEPT, np.int64),
    )


def clear(up: stream.Up, /) -> None:
    """Begin a stream anew."""
    up.at[:] = 0
    up.filled[:] = 0


def part_of(up: stream.Up, /) -> Part:
    """What was written, copied."""
    codes, bounds = up.at
    return Part(up.codes[:codes].copy(), up.bounds[:bounds].copy())


def joined(
    parts: list[Part], levels: int, top: int, /, *, children: int, most: int, executor: Executor
) -> Tree:
    """The tree of the squares (or cubes) that a map is divided in `top` times, in the order of the tree."""
    counts = np.array([part.codes[-1] & stream.COUNT for part in parts], np.int64)
    is_inner = np.array([part.codes[-1] & stream.IS_INNER != 0 for part in parts])
    bounds = np.zeros((len(parts), KEPT, 2), np.int64)
    for root, part, count in zip(bounds, parts, counts, strict=True):
        root[:count] = part.bounds[len(part.bounds) - 2 * count :].reshape(-1, 2)
    up = empty_up(2 * len(parts) + 100, levels=top, children=children)
    while not pixels.up_from_roots(up, counts, bounds, is_inner, top, most):
        up = empty_up(2 * len(up.codes), levels=top, children=children)
    above = part_of(up)
    head = _read(above, -1, top, children)
    inner = [part for part, has_more in zip(parts, is_inner, strict=True) if has_more]
    below = levels - top

    def read(task: tuple[Part, int]) -> "_Lists":
        return _read(task[0], task[1], below, children)

    tasks = zip(inner, head.elsewhere.tolist(), strict=True)
    tails = list(ordered_map(executor, read, tasks, ahead=_AHEAD))
    # The root of a square is in the head; its mask, of the level where head and tails meet, in its own list.
    masks = [*head.masks[:top], *(_level(tails, "masks", level) for level in range(below))]
    values = [*head.values, *(_level(tails, "values", level) for level in range(1, below + 1))]
    return Tree(
        levels=levels,
        children=children,
        root=head.root,
        masks=np.concatenate([*masks, np.empty(0, np.uint16)]),
        mask_starts=np.cumsum([0, *map(len, masks)]),
        values=np.concatenate(values),
        value_starts=np.cumsum([0, *map(len, values)]),
    )


@dataclass(frozen=True, slots=True)
class _Lists:
    """Masks and values of a part, by level, and what holds where it goes on elsewhere."""

    root: int
    masks: list[NDArray[np.uint16]]
    values: list[NDArray[np.uint32]]
    elsewhere: NDArray[np.int64]


def _level(lists: list[_Lists], name: str, level: int) -> NDArray[np.uint16] | NDArray[np.uint32]:
    kind = np.uint16 if name == "masks" else np.uint32
    return np.concatenate([np.empty(0, kind), *(getattr(part, name)[level] for part in lists)])


def _read(part: Part, inherited: int, levels: int, children: int) -> _Lists:
    nodes, inner = np.zeros(levels + 1, np.int64), np.zeros(levels + 1, np.int64)
    stream.survey(part.codes, children, np.zeros(levels + 1, np.int64), nodes, inner)
    mask_starts, value_starts = np.cumsum([0, *inner]), np.cumsum([0, *nodes])
    begin = np.zeros(levels + 1, np.int64)
    begin[0] = inherited
    down = stream.Down(
        inherited=begin,
        child=np.zeros(levels + 1, np.int64),
        parent=np.zeros(levels + 1, np.int64),
        mask_at=mask_starts[:-1].copy(),
        value_at=value_starts[:-1].copy(),
        masks=np.empty(mask_starts[-1], np.uint16),
        values=np.empty(value_starts[-1], np.uint32),
        elsewhere=np.empty(int(nodes[-1]), np.int64),
        elsewhere_at=np.zeros(1, np.int64),
    )
    root = stream.descend(down, part.codes, part.bounds, children)
    return _Lists(
        root,
        [down.masks[a:b].copy() for a, b in zip(mask_starts, down.mask_at, strict=False)],
        [down.values[a:b].copy() for a, b in zip(value_starts, down.value_at, strict=False)],
        down.elsewhere[: down.elsewhere_at[0]],
    )


def tree_of_stack(
    flats: Sequence[Callable[[], Flat]],
    levels: int,
    /,
    *,
    executor: Executor,
    is_strict: bool = False,
    most: int = KEPT,
    progress: Progress = SILENT,
) -> Tree:
    """The octree of a stack of maps of 2^levels pixels a side, from what makes each image's triangles."""
    scratch = _Pool()

    def make(flat_of: Callable[[], Flat]) -> Part:
        with scratch.taken() as mine:
            return mine.part(flat_of(), 0, levels, PLACE_BITS - levels, is_strict, True, most)

    parts = []
    with progress.stage("Tracing depth", float(len(flats))) as stage:
        nodes = 0
        for part in ordered_map(executor, make, flats, ahead=thread_count() + 1):
            parts.append(part)
            nodes += len(part.codes)
            _refuse_too_many(nodes)
            stage.advance()
    sizes = [len(part.codes) for part in parts]
    squares = stack.Squares(
        np.empty(nodes, np.int64),
        np.empty(nodes, np.uint32),
        np.empty(nodes, np.uint32),
        np.cumsum([0, *sizes])[:-1],
    )
    for part, root in zip(parts, squares.roots, strict=True):
        stack.squares_of(part.codes, part.bounds, squares, root, np.empty(4 * levels + 8, np.int64))
    best: Tree | None = None
    with progress.stage("Stacking images", None):
        # How far apart images should be, what is smallest says: it is twice the size otherwise (a sun's path
        # of 32 images), or 1.2 times (an area light, whose images are best side by side).
        for spread in range(levels - (len(parts) - 1).bit_length() + 1):
            tree = _stacked(squares, levels, spread, executor, most)
            if best is not None and _size(tree) >= _size(best):
                break
            best = tree
    assert best is not None
    return best


def _stacked(squares: stack.Squares, levels: int, spread: int, executor: Executor, most: int) -> Tree:
    up = empty_up(2 * len(squares.first) + 100, levels=levels, children=8)
    ways = np.empty((levels + 1, len(squares.roots)), np.int64)
    while not stack.up_from_squares(up, squares, levels, spread, ways, most):
        up = empty_up(2 * len(up.codes), levels=levels, children=8)
    tree = joined([part_of(up)], levels, 0, children=8, most=most, executor=executor)
    return replace(tree, spread=spread)


def _size(tree: Tree) -> int:
    return len(tree.masks) + len(tree.values)
