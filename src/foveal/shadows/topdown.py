"""The tree of a map from the root down, as published, for comparison: it needs all pixels at once."""

from typing import Any

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
    level: Any = _sorted_ends(lower, upper)
    starts, inherited = np.array([0, 2 * side * side]), np.array([-1])
    level = (*level, starts, inherited, np.array([-1]), np.array([0]))
    # A list of one array, so that a kernel can say how much of it is taken.
    masks: list[NDArray[np.uint16]] = []
    values: list[NDArray[np.uint32]] = []
    root = 0
    parents = np.empty(0, np.uint16)
    for depth in range(levels + 1):
        nodes = len(level[2]) - 1
        room = 4 * nodes
        out = (
            np.empty(len(level[0]), np.int64),
            np.empty(len(level[0]), np.int32),
            *(np.empty(room + 1, np.int64) for _ in range(4)),
        )
        mine = np.concatenate([parents, np.empty(nodes, np.uint16)])
        found = np.empty(nodes, np.uint32)
        zero = np.zeros(1, np.int64)
        made, valued, count, kind = kernels.level_of(
            *level,
            2 * (levels - 1 - depth),
            (np.full(1, len(parents)), mine),
            (zero, found),
            out,
        )
        if depth == 0:
            root = kind
        else:
            masks.append(mine[: len(parents)])
        values.append(found[:valued])
        parents = mine[len(parents) : made].copy()
        level = (
            *(array[: out[2][count] if count else 0] for array in out[:2]),
            out[2][: count + 1],
            out[3][:count],
            out[4][:count] - (made - len(parents)),
            out[5][:count],
        )
        if count == 0:
            break
    masks += [np.empty(0, np.uint16)] * (levels - len(masks))
    values += [np.empty(0, np.uint32)] * (levels + 1 - len(values))
    return Tree(
        levels=levels,
        children=4,
        root=root,
        masks=np.concatenate([*masks, np.empty(0, np.uint16)]),
        mask_starts=np.cumsum([0, *map(len, masks)]),
        values=np.concatenate(values),
        value_starts=np.cumsum([0, *map(len, values)]),
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
