"""The way down a tree that its encoder and its decoder share."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.coding.binary import BYTES_A_BIT, Coder, drain

from . import _kernels_coded as kernels
from .tree import FAR, INNER

__all__ = ["Walk", "room"]

_SLICE = 1 << 12  # nodes that are written before their bytes are drained
_MOST_BITS_A_VALUE = kernels.MOST_SIDES + 1 + 2 * 32


class _Level(NamedTuple):
    """Nodes with children of one level; (nodes, sides) what is beside them."""

    masks: NDArray[np.uint16]
    held: NDArray[np.uint32]
    is_inner: NDArray[np.uint8]
    cells: NDArray[np.uint32]  # (nodes * children,) the last value on the way to each child, as known
    links: NDArray[np.int32]  # which node of the level is there, -1 where none is
    outer: NDArray[np.uint32]  # the value there where none is

    @classmethod
    def blank(cls, masks: NDArray[np.uint16], dims: int, value: int) -> "_Level":
        nodes = len(masks)
        return cls(
            masks,
            np.full(nodes, value, np.uint32),
            np.ones(nodes, np.uint8),
            np.full(nodes << dims, value, np.uint32),
            np.full((nodes, 2 * dims), -1, np.int32),
            np.full((nodes, 2 * dims), value, np.uint32),
        )


class Walk:
    """A way down a tree, stage by stage: the root's value, then masks of a level and values of the next."""

    def __init__(self, levels: int, children: int, root: int) -> None:
        self.levels = levels
        self.dims = children.bit_length() - 1
        self.root = root
        self.stage = 0
        self.root_value = FAR
        self.above: _Level | None = None

    def go(self, coder: Coder, masks: NDArray[np.uint16], values: NDArray[np.uint32]) -> tuple[bytes, Coder]:
        """Write a stage, or read it into `masks` and `values`: what was written, the coder that goes on.

        Raises
        ------
        ValueError
            If they do not fit each other.
        """
        self.stage += 1
        if self.stage == 1:
            self.root_value = kernels.code_value(
                coder, int(values[0]), FAR, np.zeros(0, np.int64), 0, int(self.root == INNER)
            )
            values[0] = self.root_value
            return b"", coder
        level = self._below(masks)
        data = bytearray()
        at = 0
        for begin in range(0, len(masks), _SLICE):
            end = min(begin + _SLICE, len(masks))
            is_last = int(self.stage - 1 == self.levels)
            at = kernels.code_nodes(level, values, at, begin, end, self.dims, is_last, coder)
            if at < 0:
                raise ValueError("masks and values do not fit each other")
            if not coder.is_reading:
                written, coder = drain(coder, room(1 << self.dims))
                data += written
        if at != len(values):
            raise ValueError("masks and values do not fit each other")
        self.above = level
        return bytes(data), coder

    def _below(self, masks: NDArray[np.uint16]) -> _Level:
        """The level under the one before, of so many nodes."""
        below = _Level.blank(masks, self.dims, self.root_value)
        if self.above is not None:
            numbers = np.empty(len(self.above.masks) << self.dims, np.int32)
            if kernels.number(self.above.masks, self.dims, numbers) != len(masks):
                raise ValueError("masks of two levels do not fit each other")
            kernels.descend(self.above, numbers, self.dims, below)
        return below


def room(children: int) -> int:
    """Bytes that a slice can take."""
    return int(BYTES_A_BIT * _SLICE * children * (2 + _MOST_BITS_A_VALUE))
