"""Triangles on their way between partitions: pieces, split by cell and joined by vertex number."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from . import _kernels_cells as kernels
from . import _kernels_partition as partition_kernels
from .partition import Partition

__all__ = ["Piece", "box", "corner_sums", "is_proper", "join", "local_numbers", "split"]


@dataclass(frozen=True, slots=True)
class Piece:
    """Some triangles of a level, with vertices of their own.

    Attributes
    ----------
    ids : (n,) int32
        The vertices' numbers in the whole mesh: equal in two pieces means the same vertex.
    positions : (n, 3) int32
        On the grid.
    faces : (m, 3) int32
        Indices in [0, n).
    errors : (m,) float32
        For each face a bound of the distance to the original surface, in steps of the grid.
    attributes : (n, k) float32
        Colour (0 to 255), then normal, as far as the input has them.
    """

    ids: NDArray[np.int32]
    positions: NDArray[np.int32]
    faces: NDArray[np.int32]
    errors: NDArray[np.float32]
    attributes: NDArray[np.float32]

    def arrays(self) -> tuple[NDArray[Any], ...]:
        """What a store keeps; `Piece.of` is the way back."""
        return (self.ids, self.positions, self.faces, self.errors, self.attributes)

    @classmethod
    def of(cls, arrays: tuple[NDArray[Any], ...], /) -> Self:
        """A piece from what `arrays` gave."""
        return cls(*arrays)


def box(positions: NDArray[Any], /) -> tuple[NDArray[Any], NDArray[Any]]:
    """(low, high), each (3,): least and greatest coordinates of positions (n, 3), n > 0."""
    low, high = np.empty(3, positions.dtype), np.empty(3, positions.dtype)
    partition_kernels.box(positions, low, high)
    return low, high


def corner_sums(
    positions: NDArray[np.int32], faces: NDArray[np.int32], /, *, first: int = 0, stride: int = 1
) -> NDArray[np.float64]:
    """(k, 3): sums of the corners, which is what partitions are made of, of each `stride`-th face."""
    out = np.empty((len(range(first, len(faces), stride)), 3))
    partition_kernels.corner_sums(positions, faces, first, stride, out)
    return out


def is_proper(faces: NDArray[np.int32], /) -> NDArray[np.bool_]:
    """(m,): whether the three corners are three vertices.

    Examples
    --------
    >>> is_proper(np.array([[0, 1, 2], [3, 1, 3]], np.int32))
    array([ True, False])
    """
    a, b, c = faces.T
    found: NDArray[np.bool_] = (a != b) & (b != c) & (c != a)
    return found


def local_numbers(ids: NDArray[np.int32], /) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """(local, first): equal ids get equal numbers from 0 on; first[local[i]] is where the id is first seen.

    Examples
    --------
    >>> [a.tolist() for a in local_numbers(np.array([70, 30, 70, 50], np.int32))]
    [[0, 1, 0, 2], [0, 1, 3]]
    """
    size = 1 << max(4, int(2 * len(ids)).bit_length())
    local, first = np.empty(len(ids), np.int32), np.empty(len(ids), np.int64)
    count = kernels.join(ids, np.empty(size, np.int32), np.empty(size, np.int64), local, first)
    return local, first[:count]


def join(pieces: list[Piece], /) -> tuple[Piece, list[NDArray[np.int32]]]:
    """One piece of several, equal ids becoming one vertex; and for each piece its vertices' new indices."""
    if len(pieces) == 1:
        return pieces[0], [np.arange(len(pieces[0].ids), dtype=np.int32)]
    local, first = local_numbers(np.concatenate([p.ids for p in pieces]))
    ends = np.cumsum([len(p.ids) for p in pieces])
    maps = np.split(local, ends[:-1])
    whole = Piece(
        np.concatenate([p.ids for p in pieces])[first],
        np.concatenate([p.positions for p in pieces])[first],
        np.concatenate([where[p.faces] for p, where in zip(pieces, maps, strict=True)]),
        np.concatenate([p.errors for p in pieces]),
        np.concatenate([p.attributes for p in pieces])[first],
    )
    return whole, maps


def split(piece: Piece, cells: Partition, /) -> list[tuple[int, Piece]]:
    """The parts of a piece in each cell that it meets, by rising number of the cell."""
    cell_of = cells.assign(piece.positions, piece.faces)
    met, compact = _compact(cell_of, cells.cells)
    if len(met) == 1:
        return [(int(met[0]), piece)]
    count, faces = len(piece.ids), len(piece.faces)
    first_face, first_vertex = np.empty(len(met) + 1, np.int64), np.empty(len(met) + 1, np.int64)
    order = np.empty(faces, np.int64)
    # Borders between the parts repeat vertices: at most three a face.
    vertices = np.empty(3 * faces, np.int32)
    local = np.empty((faces, 3), np.int32)
    kernels.split(
        piece.faces,
        compact,
        len(met),
        first_face,
        order,
        np.empty(count, np.int32),
        np.empty(count, np.int32),
        vertices,
        first_vertex,
        local,
    )
    parts = []
    for i, cell in enumerate(met.tolist()):
        own = slice(int(first_face[i]), int(first_face[i + 1]))
        kept = vertices[first_vertex[i] : first_vertex[i + 1]]
        parts.append(
            (
                cell,
                Piece(
                    piece.ids[kept],
                    piece.positions[kept],
                    local[own].copy(),
                    piece.errors[order[own]],
                    piece.attributes[kept],
                ),
            )
        )
    return parts


def _compact(cell_of: NDArray[np.int32], cells: int) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    is_met = np.zeros(cells, np.bool_)
    is_met[cell_of] = True
    return np.flatnonzero(is_met), (np.cumsum(is_met, dtype=np.int32) - 1).astype(np.int32)[cell_of]
