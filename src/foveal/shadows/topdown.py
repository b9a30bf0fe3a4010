"""The tree of a map from the root down, as published, for comparison: it needs all pixels at once."""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_topdown as kernels
from ._kernels_tiles import all_bits
from .tree import Tree

__all__ = ["tree_from_the_root"]


def tree_from_the_root(lower: NDArray[np.uint32], upper: NDArray[np.uint32], /) -> Tree:
    """The tree that takes, at each node, the depth that most pixels below it allow.

    Parameters
    ----------
    lower, upper : (side, side) uint32
        Lowest and highest legal value of each pixel; the side is a power of two, at most 2^13.

    Examples
    --------
    >>> flat = np.full((4, 4), 7, np.uint32)
    >>> tree_from_the_root(flat, flat).values
    array([7], dtype=uint32)
    """
    side = len(lower)
    levels = side.bit_length() - 1
    keys, pixels = _sorted_ends(lower, upper)
    one = np.full(1, -1)
    nodes = kernels.Nodes(keys, pixels, np.array([0, len(keys)]), one, one, np.zeros(1, np.int64))
    masks: list[NDArray[np.uint16]] = []
    values: list[NDArray[np.uint32]] = []
    root = 0
    for level in range(levels + 1):
        count = len(nodes.inherited)
        below = _room(len(nodes.keys), 4 * count)
        mine, found = np.empty(count, np.uint16), np.empty(count, np.uint32)
        above = masks[-1] if masks else np.empty(0, np.uint16)
        made, valued, children, kind = kernels.decide(
            nodes, 2 * (levels - 1 - level), above, mine, found, below
        )
        root = kind if level == 0 else root
        masks.append(mine[:made])
        values.append(found[:valued])
        nodes = kernels.Nodes(
            below.keys[: below.starts[children]],
            below.pixels[: below.starts[children]],
            below.starts[: children + 1],
            below.inherited[:children],
            below.parents[:children],
            below.numbers[:children],
        )
    return Tree(
        levels=levels,
        children=4,
        root=root,
        masks=np.concatenate(masks),
        mask_starts=np.cumsum([0, *map(len, masks[:-1])]),
        values=np.concatenate(values),
        value_starts=np.cumsum([0, *map(len, values)]),
    )


def _room(ends: int, nodes: int) -> kernels.Nodes:
    return kernels.Nodes(
        np.empty(ends, np.int64),
        np.empty(ends, np.int32),
        *(np.empty(count, np.int64) for count in (nodes + 1, nodes, nodes, nodes)),
    )


def _sorted_ends(
    lower: NDArray[np.uint32], upper: NDArray[np.uint32]
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Both ends of each pixel's interval by depth, and the pixels' numbers in the order of the tree."""
    place = np.array([all_bits(i) for i in range(len(lower))])
    number = (place[None] | place[:, None] << 1).astype(np.int32).ravel()
    keys = np.concatenate(
        [lower.ravel().astype(np.int64) << 1 | 1, (upper.ravel().astype(np.int64) + 1) << 1]
    )
    order = np.argsort(keys, kind="stable")
    return keys[order], np.concatenate([number, number])[order]
