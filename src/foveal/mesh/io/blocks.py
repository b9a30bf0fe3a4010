"""What all readers give: a mesh as a stream of blocks, bounded whatever the size of the file."""

from abc import ABC, abstractmethod
from collections.abc import Generator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = ["Block", "Blocks", "FaceBlock", "MeshSource", "VertexBlock"]


@dataclass(frozen=True, slots=True)
class VertexBlock:
    """The next vertices, numbered on from those of the blocks before.

    Attributes
    ----------
    positions : (k, 3) float64
        Finite.
    normals : (k, 3) float32 or None
        Unit length or zero.
    colours : (k, 3) uint8 or None
        sRGB.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float32] | None = None
    colours: NDArray[np.uint8] | None = None


@dataclass(frozen=True, slots=True)
class FaceBlock:
    """The next triangles.

    Attributes
    ----------
    faces : (k, 3) int64
        Vertex indices that count from 0 over the whole file; they may be of vertices still to come.
    sizes : (p,) int64 or None
        Corners of each polygon that begins in this block: one of s corners is the next s - 2 triangles, a
        fan around its first corner, which may go on in later blocks. None where all are triangles.
    """

    faces: NDArray[np.int64]
    sizes: NDArray[np.int64] | None = None


Block = VertexBlock | FaceBlock
Blocks = Generator[Block, None, None]
"""What `MeshSource.blocks` gives: an iterator of blocks with a `close`."""


@dataclass
class MeshSource(ABC):
    """A mesh that can be read from its start to its end, any number of times.

    Attributes
    ----------
    name : str
        What messages call it: the file's name.
    up : str
        "x", "y" or "z".
    has_normals, has_colours : bool
        Whether every vertex block carries them.
    size_hint : int
        Total bytes of the file, for progress.
    bytes_read : int
        How far the present reading has come; reaches `size_hint` at the end.
    notes : list of str
        Sentences for the person, such as what was left out. More may come while blocks are read.
    """

    name: str
    up: str = "y"
    has_normals: bool = False
    has_colours: bool = False
    size_hint: int = 0
    bytes_read: int = 0
    notes: list[str] = field(default_factory=list)

    @abstractmethod
    def blocks(self) -> Blocks:
        """Read the file from its start, in blocks of at most about a quarter of a million rows.

        Closing the iterator early closes the file.

        Raises
        ------
        FovealError
            While it is iterated: coordinates that are not finite, indices of no vertex, no triangle, a
            file that ends too early or is damaged. Indices are checked at the latest with the last block.
        """
