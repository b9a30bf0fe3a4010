"""From casters and many projections to one octree: the maps of an area light, or of a sun's path."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor, ordered_map, thread_count

from . import _kernels_stack as kernels
from ._kernels_flat import Flat
from ._kernels_sets import KEPT
from .construct import Pool, refuse_too_many
from .flat import PLACE_BITS
from .stream import Part, empty_up, joined, part_of
from .tree import Tree

__all__ = ["tree_of_stack"]


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
    scratch = Pool()

    def make(flat_of: Callable[[], Flat]) -> Part:
        with scratch.taken() as mine:
            return mine.part(flat_of(), 0, levels, PLACE_BITS - levels, is_strict, True, most)

    parts = []
    with progress.stage("Tracing depth", float(len(flats))) as stage:
        nodes = 0
        for part in ordered_map(executor, make, flats, ahead=thread_count() + 1):
            parts.append(part)
            nodes += len(part.codes)
            refuse_too_many(nodes)
            stage.advance()
    sizes = [len(part.codes) for part in parts]
    squares = kernels.Squares(
        np.empty(nodes, np.int64),
        np.empty(nodes, np.uint32),
        np.empty(nodes, np.uint32),
        np.cumsum([0, *sizes])[:-1],
    )
    for part, root in zip(parts, squares.roots, strict=True):
        kernels.squares_of(part.codes, part.bounds, squares, root, np.empty(4 * levels + 8, np.int64))
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


def _stacked(squares: kernels.Squares, levels: int, spread: int, executor: Executor, most: int) -> Tree:
    up = empty_up(2 * len(squares.first) + 100, levels=levels, children=8)
    ways = np.empty((levels + 1, len(squares.roots)), np.int64)
    while not kernels.up_from_squares(up, squares, levels, spread, ways, most):
        up = empty_up(2 * len(up.codes), levels=levels, children=8)
    tree = joined([part_of(up)], levels, 0, children=8, most=most, executor=executor)
    return replace(tree, spread=spread)


def _size(tree: Tree) -> int:
    return len(tree.masks) + len(tree.values)
