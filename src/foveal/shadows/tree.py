"""The tree of a shadow map, level by level: made by construction, kept in files, packed for lookups."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["EMPTY", "FAR", "INNER", "LEAF", "NONE", "STEPS", "Tree"]

STEPS = 1 << 32
"""Steps of depth between the light's near end and its far end: a depth z in [0, 1) is step floor(z STEPS)."""
FAR = STEPS - 1
"""The value of what no ray hits: everything is lit. No surface lies at this step."""

NONE, LEAF, EMPTY, INNER = range(4)
"""What a child is: nothing is there, the last value above holds; a value; children; a value and children."""


@dataclass(frozen=True, slots=True)
class Tree:
    """A quadtree over the pixels of a shadow map, or an octree over those of a stack of maps.

    A node is looked up by the bits of x, y (and image), from the highest: child number
    `x_bit | y_bit << 1 | image_bit << 2`. The value of a pixel is the last one on the way down. A receiver at
    depth step s is lit where `s <= value`.

    Attributes
    ----------
    levels : int
        The map has 2^levels pixels a side; the root is level 0, single pixels are level `levels`. Also of a
        stack, whose images past the last are not there and never asked for.
    children : int
        4 or 8.
    root : int
        LEAF or INNER: the root always has a value.
    masks : (m,) uint16
        Of each node with children (EMPTY, INNER), level after level, within a level in order of the parents
        and of children within a parent: the kind of child i in bits 2 i and 2 i + 1. At the last level but
        one children are LEAF or NONE. No mask is 0.
    mask_starts : (levels + 1,) int64
        The masks of level l are `masks[mask_starts[l]:mask_starts[l + 1]]`.
    values : (v,) uint32
        Of each node with a value (LEAF, INNER), in the same order.
    value_starts : (levels + 2,) int64
        The values of level l are `values[value_starts[l]:value_starts[l + 1]]`.
    spread : int
        Of a stack: image i is at i 2^spread along the third axis, and nothing is between. Images that differ
        much, as those of a sun's path, want to be apart: else a part that is plain in one image alone would
        be cut into cubes of one pixel. Below 0 where finer levels have been left out.

    Based on: Scandolo, Bauszat, Eisemann 2016, section 3.2.
    """

    levels: int
    children: int
    root: int
    masks: NDArray[np.uint16]
    mask_starts: NDArray[np.int64]
    values: NDArray[np.uint32]
    value_starts: NDArray[np.int64]
    spread: int = 0
