"""A tree as few bytes: adaptive binary coding, top levels first (spec/shadows.md, "The coded tree").

Chances are learnt over a whole tree, so chunks are decoded in their order; a reader may stop after any. What
is known around a node tells most: which values are beyond its sides, as far as they are decoded yet. Bytes
against the greedy tree in memory, of a closed scene at 4096² and an open one at 2048²:

| entropy of masks by levels, of values' lengths, and their free bits | 0.214 | 0.254 |
| lzma of masks and values                                            | 0.164 | 0.216 |
| masks coded with their earlier siblings, values with recent ones    | 0.152 | 0.199 |
| and with the values beyond their sides                              | 0.115 | 0.165 |

Chances that settle by how often they were met would take 2 % less and a third table; nothing else that was
tried more than 1 %.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.coding.binary import MOST_BITS_A_BYTE, Chances, finish, is_at_end, reader, writer

from ._kernels_coded import CONTEXTS
from .coded_walk import Walk, room
from .tree import INNER, LEAF, Tree

__all__ = ["MOST_LEVELS", "Counts", "coarser", "decode", "encode", "parts_of"]

MOST_LEVELS = 24
SMALL_PART = 1 << 12
"""Nodes with children: levels are put into one chunk while they have no more of them together."""


@dataclass(frozen=True, slots=True)
class Counts:
    """What a decoder is told beforehand of a tree; all but the last two as in `Tree`.

    Attributes
    ----------
    masks : (levels,) int64
        Nodes with children on each level.
    values : (levels + 1,) int64
        Nodes with a value on each level.
    """

    levels: int
    children: int
    root: int
    masks: NDArray[np.int64]
    values: NDArray[np.int64]

    @classmethod
    def of(cls, tree: Tree, /) -> "Counts":
        """The counts of a tree."""
        return cls(
            tree.levels, tree.children, tree.root, np.diff(tree.mask_starts), np.diff(tree.value_starts)
        )

    @property
    def is_possible(self) -> bool:
        """Whether any tree has so many."""
        most = self.children * self.masks
        return bool(
            0 <= self.levels <= MOST_LEVELS
            and self.children in (4, 8)
            and self.root in (LEAF, INNER)
            and self.masks.shape == (self.levels,)
            and self.values.shape == (self.levels + 1,)
            and self.masks[:1].sum() == (self.root == INNER)
            and self.values[0] == 1
            and (self.masks[1:] <= most[:-1]).all()
            and (self.values[1:] <= most).all()
        )


def parts_of(trees: Iterable[Tree], /) -> list[int]:
    """The levels with which chunks end: the first holds many small ones, then each has its own.

    Examples
    --------
    >>> from foveal.shadows.tree import Tree
    >>> no_masks = (np.zeros(0, np.uint16), np.zeros(4, int))
    >>> blank = Tree(3, 4, LEAF, *no_masks, np.zeros(1, np.uint32), np.array([0, 1, 1, 1, 1]))
    >>> parts_of([blank])
    [3]
    """
    sums = sum(np.diff(tree.mask_starts) for tree in trees)
    levels = len(np.atleast_1d(sums))
    together = int((np.cumsum(sums) <= SMALL_PART).sum())
    return [level for level in range(levels + 1) if level >= together]


def encode(tree: Tree, parts: Sequence[int], /) -> list[bytes]:
    """The chunks of a tree; `Counts` must be kept beside.

    Parameters
    ----------
    tree : Tree
    parts : levels, ascending
        Chunk i ends with the values of level `parts[i]`; the last is `tree.levels`.

    Raises
    ------
    ValueError
        If the tree is none: its starts do not fit its masks, or a mask is 0.
    """
    counts = Counts.of(tree)
    if not counts.is_possible:
        raise ValueError("a tree's starts do not fit its levels")
    walk = Walk(counts.levels, counts.children, counts.root)
    chances = Chances.even(CONTEXTS)
    chunks = []
    for begin, end in _stages(parts):
        coder = writer(chances, room(tree.children))
        data = bytearray()
        for stage in range(begin, end):
            masks = (
                tree.masks[tree.mask_starts[stage - 1] : tree.mask_starts[stage]] if stage else tree.masks[:0]
            )
            values = tree.values[tree.value_starts[stage] : tree.value_starts[stage + 1]]
            written, coder = walk.go(coder, masks.copy(), values.copy())
            data += written
        chunks.append(bytes(data) + finish(coder))
    return chunks


def decode(counts: Counts, parts: Sequence[int], chunks: Sequence[bytes], /) -> Tree:
    """The tree of some chunks, which may be any bytes; of its first chunks alone, a tree of fewer levels.

    Parameters
    ----------
    counts : Counts
    parts : levels, ascending
        As they were given to `encode`.
    chunks : at least one
        Where they are fewer than `parts`, the tree has `parts[len(chunks) - 1]` levels: an inner node that
        is a pixel of these is a leaf, an empty one is none.

    Raises
    ------
    FovealError
        If counts or bytes are damaged, before much is allocated.
    """
    if not counts.is_possible:
        raise damaged()
    walk = Walk(counts.levels, counts.children, counts.root)
    chances = Chances.even(CONTEXTS)
    all_masks: list[NDArray[np.uint16]] = []
    all_values: list[NDArray[np.uint32]] = []
    for (begin, end), data in zip(_stages(parts[: len(chunks)]), chunks, strict=True):
        if counts.children * int(counts.masks[max(begin - 1, 0) : end - 1].sum()) > MOST_BITS_A_BYTE * len(
            data
        ):
            raise damaged()
        coder = reader(chances, data)
        for stage in range(begin, end):
            masks = np.zeros(int(counts.masks[stage - 1]) if stage else 0, np.uint16)
            values = np.zeros(int(counts.values[stage]), np.uint32)
            try:
                walk.go(coder, masks, values)
            except ValueError as error:
                raise damaged() from error
            all_masks.append(masks)
            all_values.append(values)
        if not is_at_end(coder):
            raise damaged()
    tree = Tree(
        levels=len(all_values) - 1,
        children=counts.children,
        root=counts.root,
        masks=np.concatenate(all_masks),
        mask_starts=np.cumsum([len(masks) for masks in all_masks]),
        values=np.concatenate(all_values),
        value_starts=np.cumsum([0, *map(len, all_values)]),
    )
    return tree if tree.levels == counts.levels else coarser(tree)


def coarser(tree: Tree, /) -> Tree:
    """A tree whose lowest masks tell of children below its last level, without these.

    A mask that is 0 then goes, and what it was a mask of is a leaf or nothing.
    """
    masks = tree.masks.copy()
    levels = [masks[a:b] for a, b in zip(tree.mask_starts, tree.mask_starts[1:], strict=False)]
    places = np.arange(tree.children, dtype=np.uint16)
    is_gone: NDArray[np.bool_] | None = None  # nodes of the level below
    for level in reversed(range(tree.levels)):
        is_split = levels[level][:, None] >> 2 * places + 1 & 1
        if is_gone is not None:
            is_split[is_split == 1] = ~is_gone
        else:
            is_split[:] = 0
        kept = is_split << 2 * places + 1 | (levels[level][:, None] & 1 << 2 * places)
        levels[level] = np.bitwise_or.reduce(kept, axis=1).astype(np.uint16)
        is_gone = levels[level] == 0
        levels[level] = levels[level][~is_gone]
    return Tree(
        levels=tree.levels,
        children=tree.children,
        root=INNER if tree.levels and len(levels[0]) else LEAF,
        masks=np.concatenate([*levels, masks[:0]]),
        mask_starts=np.cumsum([0, *map(len, levels)]),
        values=tree.values,
        value_starts=tree.value_starts,
    )


def damaged() -> FovealError:
    """The one sentence for bytes that are no tree."""
    return FovealError("a shadow tree is damaged. Copy or build the file again.")


def _stages(parts: Sequence[int]) -> Iterable[tuple[int, int]]:
    """Of each chunk, its first stage and the one after its last."""
    return zip([0, *(part + 1 for part in parts)], [part + 1 for part in parts], strict=False)
