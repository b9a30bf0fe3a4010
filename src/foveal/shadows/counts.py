"""How many nodes of each kind a tree has, and what that is in memory."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from .tree import INNER, Tree

__all__ = ["Counts", "counts"]


class Counts(NamedTuple):
    """Nodes by kind; see `Tree`.

    Attributes
    ----------
    leaf, empty, inner : int
        With a value; with children; with both.
    """

    leaf: int
    empty: int
    inner: int

    @property
    def memory_bytes(self) -> int:
        """Of the words for lookups, as they would be without padding."""
        return 4 * self.leaf + 4 * self.empty + 8 * self.inner


def counts(trees: Tree | Iterable[Tree], /) -> Counts:
    """How many nodes of each kind one tree, or several together, have.

    Examples
    --------
    >>> import numpy as np
    >>> starts, no_masks = np.array([0, 1, 1]), np.empty(0, np.uint16)
    >>> lone = Tree(0, 4, 1, no_masks, starts[:1], np.array([7], np.uint32), starts[:2])
    >>> counts(lone), counts(lone).memory_bytes
    (Counts(leaf=1, empty=0, inner=0), 4)
    """
    leaf = empty = inner = 0
    for tree in [trees] if isinstance(trees, Tree) else trees:
        both_bits = tree.masks & (tree.masks >> 1) & np.uint16(0x5555)
        inners = int(np.bitwise_count(both_bits).sum()) + (tree.root == INNER)
        inner += inners
        leaf += len(tree.values) - inners
        empty += len(tree.masks) - inners
    return Counts(leaf, empty, inner)
