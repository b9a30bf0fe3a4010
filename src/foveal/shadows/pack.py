"""The tree of a shadow map as words that can be looked up anywhere, by `spec/shadows.md`."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from . import _kernels_pack as kernels
from .tree import INNER, Tree

__all__ = ["Packed", "pack"]

_MOST_POINTER = (1 << 16) - 1
_TRIALS = 16  # scales tried for the least padding
_MOST_WORDS = 1 << 32


class Packed(NamedTuple):
    """A tree as words, made by `pack`.

    Attributes
    ----------
    words : (w,) uint32
        As `spec/shadows.md` says.
    scales : (levels,) int64
        Words that a pointer of one means, by the level of the node that has it.
    levels, children, root : int
        As of the `Tree`.
    """

    words: NDArray[np.uint32]
    scales: NDArray[np.int64]
    levels: int
    children: int
    root: int


def pack(tree: Tree, /) -> Packed:
    """Lay a tree out for lookups: 4 bytes a leaf or empty node, 8 an inner one, and a little padding.

    Raises
    ------
    FovealError
        If the words would be 2^32 or more.

    References
    ----------
    Lefebvre, S., Hoppe, H. (2007). Compressed random-access trees for spatially coherent data. EGSR.
    Scandolo, Bauszat, Eisemann 2016, section 3.3.

    Examples
    --------
    >>> from foveal.shadows.tree import LEAF
    >>> no_masks = (np.empty(0, np.uint16), np.array([0, 0]))
    >>> pack(Tree(1, 4, LEAF, *no_masks, np.array([7], np.uint32), np.array([0, 1, 1]))).words
    array([7], dtype=uint32)
    """
    masks = [tree.masks[start:end] for start, end in _spans(tree.mask_starts)]
    values = [tree.values[start:end] for start, end in _spans(tree.value_starts)]
    scales = np.ones(tree.levels, np.int64)
    if tree.root != INNER:
        return Packed(tree.values.copy(), scales, tree.levels, tree.children, tree.root)
    extents = [np.empty(len(level), np.int64) for level in masks] + [np.empty(0, np.int64)]
    for level in reversed(range(tree.levels)):
        scale = _best_scale(masks[level], extents[level + 1], extents[level])
        if level + 1 < tree.levels:
            scales[level + 1] = scale
    count = 2 + int(extents[0][0])
    if count >= _MOST_WORDS:
        raise FovealError(
            f"The shadow map needs {count:,} words to be looked up, more than 2^32; use a lower resolution."
        )
    words = np.zeros(count, np.uint32)
    words[1] = tree.values[0]
    links, blocks = np.array([0]), np.array([2])
    for level in range(tree.levels):
        below = extents[level + 1]
        links_below, blocks_below = np.empty(len(below), np.int64), np.empty(len(below), np.int64)
        scale_below = scales[level + 1] if level + 1 < tree.levels else 1
        kernels.write(
            *(masks[level], links, blocks, scales[level], below, scale_below, values[level + 1]),
            *(links_below, blocks_below, words),
        )
        links, blocks = links_below, blocks_below
    return Packed(words, scales, tree.levels, tree.children, tree.root)


def _spans(starts: NDArray[np.int64]) -> list[tuple[int, int]]:
    return list(zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True))


def _best_scale(masks: NDArray[np.uint16], below: NDArray[np.int64], extents: NDArray[np.int64]) -> int:
    """The scale of the level below, by which `extents` are laid out."""
    longest, _ = kernels.lay(masks, below, 1, extents)
    if longest <= _MOST_POINTER:
        return 1
    first = -(-longest // _MOST_POINTER)
    found = []
    for scale in range(first, first + _TRIALS):
        longest, padding = kernels.lay(masks, below, scale, extents)
        if longest <= _MOST_POINTER * scale:
            found.append((padding, scale))
    if not found:
        raise FovealError("The shadow map is too large for 16-bit pointers; use a lower resolution.")
    scale = min(found)[1]
    kernels.lay(masks, below, scale, extents)
    return scale
