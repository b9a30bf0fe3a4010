"""The flat arrays of a √3 refinement as published: the mesh of the moment and the history of its actions."""

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from .cage import Cage

__all__ = ["FilterNet"]

#: What fields hold one entry each of, in the order of `counts`.
_FIELDS = (
    ("corners", "beside", "levels", "flags"),
    ("positions", "around", "marks"),
    ("splits",),
    ("moved", "before"),
    ("swaps",),
)


class FilterNet(NamedTuple):
    """Faces of three vertices and three neighbours, vertices, and a stack of actions of each kind.

    What was made last is undone first, so faces and vertices lie in the order in which they were made, and
    no slot is ever free. A face's own history is not kept apart from the others' (in the paper each has a
    list): a step's actions are the end of one of the three stacks.

    Attributes
    ----------
    corners : (F, 3) int32
        Counter-clockwise.
    beside : (F, 3) int32
        The face beyond the edge from corner k to k + 1, or -1.
    levels, flags : (F,) uint8
        How often it was split, and what extraction knows of it (`_kernels_extract.py`).
    positions : (V, 3) float64
    around : (V,) int32
        One of its faces; -1 where there is none.
    marks : (V,) uint8
        Set for a moment, while a search has met it.
    splits : (S,) int32
        2 face, + 1 where a border edge was cut in three.
    moved, before : (M,) int32, (M, 3) float64
        Vertices and where they were. (The paper keeps by how much they moved; taken away again, that need
        not give the same bits.)
    swaps : (W,) int32
        4 face, + 1 and + 2 where `around` of a vertex was one of the two faces and had to change.
    counts : (5,) int64
        How many faces, vertices, splits, moves and swaps there are.
    """

    corners: NDArray[np.int32]
    beside: NDArray[np.int32]
    levels: NDArray[np.uint8]
    flags: NDArray[np.uint8]
    positions: NDArray[np.float64]
    around: NDArray[np.int32]
    marks: NDArray[np.uint8]
    splits: NDArray[np.int32]
    moved: NDArray[np.int32]
    before: NDArray[np.float64]
    swaps: NDArray[np.int32]
    counts: NDArray[np.int64]

    @classmethod
    def of(cls, cage: Cage, /) -> Self:
        """A control mesh with nothing done to it."""
        faces, vertices = len(cage.faces), len(cage.positions)
        around = np.full(vertices, -1, np.int32)
        around[cage.faces] = np.arange(faces, dtype=np.int32)[:, None]
        return cls(
            cage.faces.copy(),
            cage.beside.copy(),
            np.zeros(faces, np.uint8),
            np.zeros(faces, np.uint8),
            cage.positions.copy(),
            around,
            np.zeros(vertices, np.uint8),
            np.zeros(0, np.int32),
            np.zeros(0, np.int32),
            np.zeros((0, 3)),
            np.zeros(0, np.int32),
            np.array([faces, vertices, 0, 0, 0]),
        )

    def with_room(self, more: tuple[int, int, int, int, int], /) -> Self:
        """The same with room for so many more of each kind of `counts`."""
        changed: dict[str, NDArray[Any]] = {}
        for count, extra, names in zip(self.counts, more, _FIELDS, strict=True):
            for name in names:
                old: NDArray[Any] = getattr(self, name)
                if len(old) < count + extra:
                    # Half as much again at least: else many small iterations would copy all each time.
                    room = max(int(count) + extra, len(old) + len(old) // 2)
                    changed[name] = np.zeros((room, *old.shape[1:]), old.dtype)
                    changed[name][:count] = old[:count]
        return self._replace(**changed) if changed else self

    @property
    def bytes_used(self) -> int:
        """What is there takes, the history with it."""
        return sum(
            getattr(self, name)[:count].nbytes
            for count, names in zip(self.counts, _FIELDS, strict=True)
            for name in names
        )
