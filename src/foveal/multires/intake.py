"""The door: a stream of blocks becomes triangles over welded vertices on a fine grid."""

import math
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.progress import Progress
from foveal.mesh.io.blocks import FaceBlock, MeshSource, VertexBlock

from . import _kernels_cells as kernels
from .pieces import Piece, corner_sums, is_proper, local_numbers
from .spool import Column, Room

__all__ = ["FINE_BITS", "Intake", "Repairs"]

#: Bits of the grid that positions wait on until the step is chosen: 1e-9 of the extent.
FINE_BITS = 30

_ROWS = 1 << 18  # faces or vertices that are in work at once
_KEY_BYTES = 28  # of a slot of the welding table


#: Least and greatest size of a model: spheres and errors are stored as float32.
_SIZES = (1e-30, 1e30)


@dataclass
class Repairs:
    """What was odd about the input, in numbers."""

    vertices: int = 0
    """Distinct ones that are used by a triangle."""
    triangles: int = 0
    """All of the input."""
    welded: int = 0
    """Vertices at exactly the place of another."""
    unused: int = 0
    """Vertices of no triangle, left out."""
    degenerate: int = 0
    """Triangles with two corners in one vertex: the original resolution keeps them, nothing coarser does."""
    duplicate: int = 0
    """Triangles whose three corners another one has too, kept."""
    boundary_edges: int = 0
    nonmanifold_edges: int = 0

    def sentences(self) -> list[str]:
        """For the person, what is worth knowing."""
        said = [
            (self.welded, "Vertices at the same place as another, made one with it"),
            (
                self.degenerate,
                "Triangles with two corners in one point, kept at the original resolution only",
            ),
            (self.unused, "Vertices of no triangle, left out"),
            (self.duplicate, "Triangles that are there twice, kept"),
            (self.nonmanifold_edges, "Edges of more than two triangles"),
        ]
        return [f"{what}: {count:,}." for count, what in said if count]


@dataclass
class Intake:
    """A source read once, ready to be given out as pieces, any number of times."""

    room: Room
    has_normals: bool = False
    has_colours: bool = False
    low: NDArray[np.float64] = field(default_factory=lambda: np.full(3, np.inf))
    high: NDArray[np.float64] = field(default_factory=lambda: np.full(3, -np.inf))
    repairs: Repairs = field(default_factory=Repairs)
    name: str = "mesh"

    def __post_init__(self) -> None:
        self._positions = Column(self.room, np.float64, 3)
        self._faces = Column(self.room, np.int32, 3)
        self._twins = Column(self.room, np.int32, 1)
        self._attributes = Column(self.room, np.float32, 3 * (self.has_normals + self.has_colours))

    @property
    def extent(self) -> float:
        """The largest side of the box."""
        return float((self.high - self.low).max())

    @property
    def fine_step(self) -> float:
        """Unit of the pieces' positions; 1 where the box is a point."""
        return (self.extent or 1.0) / ((1 << FINE_BITS) - 2)

    @property
    def vertices_read(self) -> int:
        """Vertices of the source; ids are below."""
        return self._positions.rows

    @property
    def triangles(self) -> int:
        """Triangles of the source, degenerate ones counted."""
        return self._faces.rows

    def read(self, source: MeshSource, progress: Progress, /) -> None:
        """Take in all blocks, then weld."""
        done = 0
        with (
            progress.stage("Reading", float(source.size_hint) or None) as stage,
            closing(source.blocks()) as blocks,
        ):
            for block in blocks:
                if isinstance(block, VertexBlock):
                    self._add_vertices(block)
                elif isinstance(block, FaceBlock):
                    self._faces.append(block.faces)
                stage.advance(source.bytes_read - done)
                done = source.bytes_read
                if self._positions.rows >= 1 << 31:
                    raise FovealError(
                        f"{source.name}: it has more than two thousand million vertices. "
                        "Build its parts one by one."
                    )
        for note in source.notes:
            progress.note(note)
        for column in (self._positions, self._faces, self._attributes):
            column.seal()
        if self._faces.rows == 0:
            raise FovealError(f"{source.name}: there is no triangle in it.")
        if not self.extent <= _SIZES[1]:
            raise FovealError(f"{source.name}: its coordinates are too large. Scale the model down.")
        if 0 < self.extent < _SIZES[0]:
            raise FovealError(f"{source.name}: it is {self.extent:.3g} large. Scale the model up.")
        self._weld()

    def _add_vertices(self, block: VertexBlock) -> None:
        if len(block.positions) == 0:
            return
        self._positions.append(block.positions)
        self.low = np.minimum(self.low, block.positions.min(axis=0))
        self.high = np.maximum(self.high, block.positions.max(axis=0))
        parts = [p for p in (block.colours, block.normals) if p is not None]
        if parts:
            self._attributes.append(np.concatenate([p.astype(np.float32) for p in parts], axis=1))

    def _weld(self) -> None:
        """Find for each vertex the first one at exactly its place."""
        count = self._positions.rows
        # The table is rebuilt for one share of all hashes at a time if it would not fit.
        share = max(1 << 22, self.room.left // 3)
        groups = max(1, math.ceil(2.5 * count * _KEY_BYTES / share))
        slots = 1 << max(4, math.ceil(math.log2(2.2 * count / groups + 16)))
        table, keys = np.empty(slots, np.int32), np.empty((slots, 3), np.uint64)
        for _ in range(0, count, _ROWS):
            self._twins.append(np.full((min(_ROWS, count - self._twins.rows), 1), -1, np.int32))
        self._twins.seal()
        distinct = 0
        for group in range(groups):
            table[:] = kernels.MISSING
            for begin in range(0, count, _ROWS):
                # + 0.0 makes one zero of the two.
                bits = (self._positions.part(begin, begin + _ROWS) + 0.0).view(np.uint64)
                twins = self._twins.part(begin, begin + _ROWS)
                distinct += kernels.weld(bits, begin, group, groups, table, keys, twins[:, 0])
                self._twins.set(begin, twins)
        self.repairs.welded = count - distinct
        if self.repairs.welded and (self.has_colours or self.has_normals):
            self._average_attributes()

    def _average_attributes(self) -> None:
        """Give the first of each group of twins the mean of their attributes."""
        from_, to = [], []
        for begin in range(0, self._twins.rows, _ROWS):
            twins = self._twins.part(begin, begin + _ROWS)[:, 0]
            numbers = np.arange(begin, begin + len(twins), dtype=np.int64)
            is_copy = twins != numbers
            from_.append(numbers[is_copy])
            to.append(twins[is_copy].astype(np.int64))
        copies, firsts = np.concatenate(from_), np.concatenate(to)
        targets, which = np.unique(firsts, return_inverse=True)
        sums = self._attributes.take(targets).astype(np.float64)
        counts = np.ones(len(targets))
        for begin in range(0, len(copies), _ROWS):
            part = slice(begin, begin + _ROWS)
            np.add.at(sums, which[part], self._attributes.take(copies[part]))
            np.add.at(counts, which[part], 1.0)
        sums /= counts[:, None]
        for begin in range(0, self._attributes.rows, _ROWS):
            inside = slice(*np.searchsorted(targets, [begin, begin + _ROWS]).tolist())
            rows = self._attributes.part(begin, begin + _ROWS).copy()
            rows[targets[inside] - begin] = sums[inside]
            self._attributes.set(begin, rows)

    def _fine(self, numbers: NDArray[np.int64]) -> NDArray[np.int32]:
        scaled = (self._positions.take(numbers) - self.low) / self.fine_step
        return np.rint(scaled).astype(np.int32)

    def centroids(self, stride: int, /) -> NDArray[np.float64]:
        """Sums of the corners of every `stride`-th triangle."""
        found = []
        for begin in range(0, self._faces.rows, _ROWS):
            faces = self._faces.part(begin, begin + _ROWS)[(-begin) % stride :: stride]
            numbers, local = _numbered(faces)
            found.append(corner_sums(self._fine(numbers), local))
        return np.concatenate(found)

    def pieces(self) -> Iterator[Piece]:
        """All triangles, positions in fine steps from `low`."""
        self.repairs.degenerate = 0
        for begin in range(0, self._faces.rows, _ROWS):
            faces = self._faces.part(begin, begin + _ROWS)
            numbers, local = _numbered(faces)
            # Two steps: first corners to the file's vertices, then those to their first twins.
            ids, renumber = _unique(self._twins.take(numbers)[:, 0])
            local = renumber[local]
            self.repairs.degenerate += int(len(faces) - np.count_nonzero(is_proper(local)))
            wide = ids.astype(np.int64)
            yield Piece(
                ids,
                self._fine(wide),
                np.ascontiguousarray(local),
                np.zeros(len(local), np.float32),
                self._attributes.take(wide) if self._attributes.rows else np.empty((len(ids), 0), np.float32),
            )

    def close(self) -> None:
        """Let go of memory and scratch files."""
        for column in (self._positions, self._faces, self._twins, self._attributes):
            column.close()


def _unique(ids: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    local, first = local_numbers(np.ascontiguousarray(ids))
    return ids[first], local


def _numbered(faces: NDArray[np.int32]) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """The vertices that occur, and the faces in terms of them."""
    numbers, local = _unique(np.ascontiguousarray(faces).reshape(-1))
    return numbers.astype(np.int64), local.reshape(-1, 3)
