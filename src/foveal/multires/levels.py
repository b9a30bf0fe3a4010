"""The loop of construction: partition, simplify each cell to a half, hand the halves to the next partition.

Based on: Cignoni et al. Batched multi triangulation. IEEE Visualization 2005; Ponchio, Dellepiane 2015,
sections 3.1 and 3.2.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.progress import Progress
from foveal.base.tasks import ordered_map

from . import _kernels_cells as kernels
from .cell import CellResult, CellTask, SharedNormals, work
from .codec import Patch, quantise_normals
from .intake import Intake
from .partition import Partition, partition
from .pieces import Piece, corner_sums, local_numbers, split
from .spool import Room, Store

__all__ = ["Grid", "Level", "Levels", "Node", "Settings"]

#: Centroids that a partition is made from: a thousand a cell, so that its size is off by 3 %, and no more
#: than a million for the memory's sake.
SAMPLE_CELL, SAMPLE = 1024, 1_000_000

#: A level that keeps more than this share of its triangles has its cells joined and is done again.
STALLED = 0.85

#: Cells simplified less than this lose their topology instead.
RELAXED = 0.75


@dataclass(frozen=True)
class Settings:
    """What the loop needs to know."""

    cell_triangles: int
    root_triangles: int
    normal_bits: int
    has_colours: bool
    has_normals: bool
    ahead: int


@dataclass(frozen=True)
class Grid:
    """The grid of a file, in units of the door's."""

    ratio: float
    offset: float


@dataclass(slots=True)
class Node:
    """A cell, and where its patches are kept."""

    patches: list[int]
    finer: list[int]
    error: float
    low: NDArray[np.int32]
    high: NDArray[np.int32]


@dataclass
class Level:
    """What one level came to."""

    triangles: int
    cells: int
    left: int
    vertices: int
    locked: int
    error: float
    relaxed_cells: int
    stalled_cells: int
    joined: int = 1
    moved: float = 0.0
    nodes: list[Node] = field(default_factory=list)
    normal_ids: NDArray[np.int32] = field(default_factory=lambda: np.empty(0, np.int32))
    normal_values: NDArray[np.int16] = field(default_factory=lambda: np.empty((0, 2), np.int16))

    def row(self) -> dict[str, int | float]:
        """For the header: the figures that tell whether the graph is sound."""
        return {
            "triangles": self.triangles,
            "cells": self.cells,
            "left": self.left,
            "locked_share": round(self.locked / max(1, self.vertices), 4),
            "relaxed_cells": self.relaxed_cells,
            "stalled_cells": self.stalled_cells,
            "joined": self.joined,
        }


class Levels:
    """Runs the loop; afterwards `levels` has the nodes from fine to coarse and `patches` their content."""

    def __init__(self, intake: Intake, room: Room, settings: Settings, executor: Executor) -> None:
        self.intake = intake
        self.room = room
        self.settings = settings
        self.executor = executor
        self.patches = Store(room)
        self.levels: list[Level] = []
        self.root: Piece | None = None
        self._owner = np.empty(0, np.int32)

    def run(self, choose_grid: Callable[[Partition, "Cells"], Grid], progress: Progress) -> Grid:
        """Build all levels. `choose_grid` is called once the first partition has its triangles."""
        triangles = self.intake.triangles
        settings = self.settings
        grid: Grid | None = None
        pieces: Store | None = None
        count = 0
        with progress.stage("Simplifying", 2.0 * triangles) as stage:
            while True:
                level = len(self.levels)
                limit = settings.cell_triangles
                while True:
                    cells = self._distribute(pieces, count, triangles, limit, level)
                    if grid is None:
                        grid = choose_grid(cells.partition, cells)
                    row, made = self._simplify(cells, grid, level, stage.advance)
                    cells.store.close()
                    if row.left <= STALLED * row.triangles or row.cells == 1:
                        break
                    # Everything is locked: cells swapped together have their common border free.
                    made.close()
                    self._forget(row)
                    limit *= 4
                row.joined = limit // settings.cell_triangles
                self.levels.append(row)
                if pieces is not None:
                    pieces.close()
                else:
                    self.intake.close()
                pieces, count, triangles = made, row.cells, row.left
                # No progress in a single cell: the root is larger than wished, and the notes say so.
                if row.cells == 1 and (
                    triangles <= settings.root_triangles or row.left > STALLED * row.triangles
                ):
                    break
        self.root = Piece.of(pieces.get(0))
        pieces.close()
        return grid

    def _forget(self, row: Level) -> None:
        """Patches of a level that is done again stay in the store, unused: it happens to soups only."""
        row.nodes.clear()

    def _distribute(
        self, pieces: Store | None, count: int, triangles: int, limit: int, level: int
    ) -> "Cells":
        """Make the level's partition and bring all triangles to their cells."""
        stride = max(1, limit // SAMPLE_CELL, math.ceil(triangles / SAMPLE))
        if pieces is None:
            points = self.intake.centroids(stride)
        else:
            stored = pieces
            points = np.concatenate([_centroids(stored.get(i), stride, i) for i in range(count)])
        tree = partition(points, limit=limit * len(points) / max(1, triangles), level=level)
        del points
        cells = Cells(tree, Store(self.room))
        if len(self._owner) == 0:
            self._owner = np.empty(self.intake.vertices_read, np.int32)
        self._owner[:] = -1
        source: Iterable[Piece]
        source = self.intake.pieces() if pieces is None else (Piece.of(stored.get(i)) for i in range(count))
        items = ((piece, tree) for piece in source)
        parts = ordered_map(self.executor, _split, items, ahead=self.settings.ahead)
        for maker, found in enumerate(parts):
            for cell, piece in found:
                kernels.claim(piece.ids, cell, self._owner)
                cells.put(cell, maker, piece)
        # A cell of the tree may stay empty, since the tree was made from a sample.
        cells.content = [content for content in cells.content if content]
        if self.intake.repairs.degenerate == triangles and pieces is None:
            raise FovealError(
                f"{self.intake.name}: each of its triangles has two corners in one point, so there is "
                "nothing to see. Export the model again."
            )
        return cells

    def _simplify(
        self, cells: "Cells", grid: Grid, level: int, advance: Callable[[float], None]
    ) -> tuple[Level, Store]:
        made = Store(self.room)
        results = ordered_map(self.executor, work, self._tasks(cells, grid, level), ahead=self.settings.ahead)
        row = Level(0, len(cells.content), 0, 0, 0, 0.0, 0, 0)
        sums: list[SharedNormals] = []
        tally = _Tally() if level == 0 else None
        for content, result in zip(cells.content, results, strict=True):
            row.nodes.append(self._keep(content, result, level))
            made.put(result.coarse.arrays())
            left = len(result.coarse.faces)
            row.triangles += result.triangles
            row.left += left
            row.vertices += result.vertices
            row.locked += result.locked
            row.error = max(row.error, result.error)
            row.moved = max(row.moved, result.moved)
            row.relaxed_cells += result.is_relaxed
            row.stalled_cells += left > max(
                RELAXED * result.triangles, self.settings.root_triangles // row.cells
            )
            if result.shared is not None:
                sums.append(result.shared)
            if tally is not None:
                tally.add(result)
            advance(result.triangles)
        if tally is not None:
            tally.finish(self.intake, int((self._owner == -2).sum()))
        if sums:
            row.normal_ids, row.normal_values = _whole_normals(sums, self.settings.normal_bits)
        return row, made

    def _tasks(self, cells: "Cells", grid: Grid, level: int) -> Iterator[CellTask]:
        settings = self.settings
        is_last = len(cells.content) == 1
        for content in cells.content:
            pieces = [Piece.of(cells.store.get(ref)) for _, ref in content]
            size = sum(len(p.faces) for p in pieces)
            shared = []
            for piece in pieces:
                flags = np.empty(len(piece.ids), np.bool_)
                kernels.is_shared(piece.ids, self._owner, flags)
                shared.append(flags)
            target = min(size // 2, settings.root_triangles) if is_last else size // 2
            yield CellTask(
                pieces,
                shared,
                grid.ratio if level == 0 else 1.0,
                grid.offset,
                target,
                max(target, settings.root_triangles) if is_last else int(RELAXED * size),
                settings.normal_bits,
                settings.has_colours,
                settings.has_normals,
                level == 0,
                settings.cell_triangles,
            )

    def _keep(self, content: list[tuple[int, int]], result: CellResult, level: int) -> Node:
        refs = []
        for patch, waiting in zip(result.patches, result.open_normals, strict=True):
            refs.append(self.patches.put(_patch_arrays(patch, waiting)))
        finer = [-1] * len(refs) if level == 0 else [maker for maker, _ in content]
        return Node(refs, finer, result.error, result.low, result.high)

    def patch(self, level: Level, ref: int) -> Patch:
        """A patch that was kept, with the normals of its border completed."""
        positions, faces, normals, colours, where, ids = self.patches.get(ref)
        if len(where):
            normals = normals.copy()
            normals[where] = level.normal_values[np.searchsorted(level.normal_ids, ids)]
        return Patch(positions, faces, normals if len(normals) else None, colours if len(colours) else None)


class Cells:
    """A level's triangles by cell: for each cell (cell of the finer level, place in the store)."""

    def __init__(self, tree: Partition, store: Store) -> None:
        self.partition = tree
        self.store = store
        self.content: list[list[tuple[int, int]]] = [[] for _ in range(tree.cells)]

    def put(self, cell: int, maker: int, piece: Piece) -> None:
        """Add a piece to a cell."""
        self.content[cell].append((maker, self.store.put(piece.arrays())))


class _Tally:
    """Counts what is odd about the input, over the borders of cells."""

    def __init__(self) -> None:
        self.triangles = self.vertices = self.duplicate = self.boundary = self.nonmanifold = 0
        self.open: list[NDArray[np.int32]] = []

    def add(self, result: CellResult) -> None:
        self.triangles += result.triangles
        self.vertices += result.own_vertices
        self.duplicate += result.duplicate
        self.boundary += result.edges[0]
        self.nonmanifold += result.edges[1]
        self.open.append(result.open_edges)

    def finish(self, intake: Intake, shared_vertices: int) -> None:
        repairs = intake.repairs
        edges = np.concatenate(self.open)
        if len(edges):
            order = np.lexsort((edges[:, 1], edges[:, 0]))
            edges = edges[order]
            is_new = np.append(True, (np.diff(edges[:, :2], axis=0) != 0).any(axis=1))
            uses = np.add.reduceat(edges[:, 2], np.flatnonzero(is_new))
            self.boundary += int((uses == 1).sum())
            self.nonmanifold += int((uses > 2).sum())
        repairs.triangles, repairs.duplicate = self.triangles, self.duplicate
        repairs.boundary_edges, repairs.nonmanifold_edges = self.boundary, self.nonmanifold
        repairs.vertices = self.vertices + shared_vertices
        repairs.unused = intake.vertices_read - repairs.welded - repairs.vertices


def _split(item: tuple[Piece, Partition]) -> list[tuple[int, Piece]]:
    piece, tree = item
    return split(piece, tree)


def _centroids(arrays: tuple[NDArray[np.int32], ...], stride: int, first: int) -> NDArray[np.float64]:
    _, positions, faces = arrays[:3]
    return corner_sums(positions, faces, first=first % stride, stride=stride)


def _whole_normals(sums: list[SharedNormals], bits: int) -> tuple[NDArray[np.int32], NDArray[np.int16]]:
    ids = np.concatenate([s.ids for s in sums])
    if len(ids) == 0:
        return ids, np.empty((0, 2), np.int16)
    local, first = local_numbers(ids)
    total = np.zeros((len(first), 3))
    np.add.at(total, local, np.concatenate([s.sums for s in sums]))
    order = np.argsort(ids[first])
    return ids[first][order], quantise_normals(total, bits=bits)[order]


def _patch_arrays(
    patch: Patch, waiting: tuple[NDArray[np.int32], NDArray[np.int32]]
) -> tuple[NDArray[np.generic], ...]:
    normals = np.empty((0, 2), np.int16) if patch.normals is None else patch.normals
    colours = np.empty((0, 3), np.uint8) if patch.colours is None else patch.colours
    return (patch.positions, patch.faces, normals, colours, *waiting)
