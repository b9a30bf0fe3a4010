"""One cell of one level: what it shows as patches, and the simplified piece that stands for it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import _kernels_cells as kernels
from .bounds import deviation
from .codec import Patch, quantise_normals
from .partition import partition
from .pieces import Piece, box, corner_sums, is_proper, join, local_numbers, split
from .simplify import incidence, simplify

__all__ = ["CellResult", "CellTask", "SharedNormals", "work"]


@dataclass(frozen=True, slots=True)
class CellTask:
    """All that a worker needs, so that it may be on another machine.

    Attributes
    ----------
    pieces : list of Piece
        The triangles in the cell, one piece for each cell of the finer level that made them.
    is_shared : list of (n,) bool
        For the vertices of each piece whether another cell of this level uses them.
    ratio : float
        What it takes to turn the pieces' positions into steps of the grid; 1 unless they come from the
        door, where the grid is finer.
    offset : float
        How far those positions may be from the original, in steps of the grid.
    target, relaxed_above : int
        Triangles wanted, and above which topology is given up; see `simplify`.
    normal_bits : int
        Of each octahedral coordinate, 0 for no normals.
    has_colours, has_normals : bool
        What the attributes are.
    is_first : bool
        Whether the pieces come from the door.
    patch_triangles : int
        Of which patches of the original resolution have at most twice as many.
    """

    pieces: list[Piece]
    is_shared: list[NDArray[np.bool_]]
    ratio: float
    offset: float
    target: int
    relaxed_above: int
    normal_bits: int
    has_colours: bool
    has_normals: bool
    is_first: bool
    patch_triangles: int


@dataclass(frozen=True, slots=True)
class SharedNormals:
    """Area vectors that a cell adds to vertices which other cells share.

    Attributes
    ----------
    ids : (k,) int32
    sums : (k, 3) float64
    """

    ids: NDArray[np.int32]
    sums: NDArray[np.float64]


@dataclass(slots=True)
class CellResult:
    """A cell's patches and what replaces them.

    Attributes
    ----------
    patches : list of Patch
        In the order of the task's pieces.
    open_normals : list of ((k,) int32, (k,) int32)
        For each patch the vertices whose normal needs other cells' sums, and their ids.
    shared : SharedNormals or None
    coarse : Piece
        The simplified cell.
    error : float
        The largest bound of `coarse`, in steps.
    low, high : (3,) int32
        Box of patches and `coarse`.
    vertices, locked, triangles : int
        Of the cell before; vertices count for the cell where they are first used only if `is_first`.
    is_relaxed : bool
    moved : float
        If `is_first`: how far the patches themselves are from the original, in steps.
    """

    patches: list[Patch]
    open_normals: list[tuple[NDArray[np.int32], NDArray[np.int32]]]
    shared: SharedNormals | None
    coarse: Piece
    error: float
    low: NDArray[np.int32]
    high: NDArray[np.int32]
    vertices: int
    locked: int
    triangles: int
    is_relaxed: bool
    moved: float = 0.0
    own_vertices: int = 0
    duplicate: int = 0
    edges: tuple[int, int] = (0, 0)
    open_edges: NDArray[np.int32] = field(default_factory=lambda: np.empty((0, 3), np.int32))


def work(task: CellTask) -> CellResult:
    """Join the pieces of a cell, make its patches, simplify it and bound the error."""
    pieces = [_on_grid(p, task) for p in task.pieces] if task.is_first else task.pieces
    whole, maps = join(pieces)
    locked = np.zeros(len(whole.ids), np.bool_)
    for shared, where in zip(task.is_shared, maps, strict=True):
        locked[where] = shared
    if task.is_first:
        whole, locked, pieces, maps = _first_patches(whole, locked, task.patch_triangles)
    # Local coordinates: integers in doubles, near zero, so that quadrics do not lose digits.
    low, high = box(whole.positions)
    middle = (low.astype(np.int64) + high) // 2
    local = (whole.positions - middle).astype(np.float64)
    patches, open_normals, shared_normals = _patches(task, whole, pieces, maps, local, locked)
    piece, is_relaxed = _coarse(task, whole, local, middle, locked)
    coarse_low, coarse_high = box(piece.positions)
    result = CellResult(
        patches,
        open_normals,
        shared_normals,
        piece,
        float(piece.errors.max()),
        np.minimum(low, coarse_low),
        np.maximum(high, coarse_high),
        len(whole.ids),
        int(locked.sum()),
        len(whole.faces),
        is_relaxed,
    )
    if task.is_first:
        result.moved = float(whole.errors.max())
        result.own_vertices = int((~locked).sum())
        _count_oddities(whole, locked, result)
    return result


def _coarse(
    task: CellTask,
    whole: Piece,
    local: NDArray[np.float64],
    middle: NDArray[np.int64],
    locked: NDArray[np.bool_],
) -> tuple[Piece, bool]:
    """What stands for the cell on the next level, and whether topology was given up for it.

    Triangles with two corners in one vertex have no area, so there is nothing of them to be near to: they
    end here. Of a cell that has no others one goes up, since a node is reached through its parents' patches.
    """
    proper = np.flatnonzero(is_proper(whole.faces))
    if len(proper) == 0:
        ids, corners = np.unique(whole.faces[0], return_inverse=True)
        face = corners.reshape(1, 3).astype(np.int32)
        most = whole.errors.max(keepdims=True)
        return Piece(whole.ids[ids], whole.positions[ids], face, most, whole.attributes[ids]), False
    faces, errors = whole.faces, whole.errors
    if len(proper) < len(faces):
        faces, errors = faces[proper], errors[proper]
    coarse = simplify(
        local,
        faces,
        locked,
        target=task.target,
        relaxed_above=task.relaxed_above,
        attributes=whole.attributes,
    )
    piece = Piece(
        whole.ids[coarse.kept],
        (coarse.positions + middle).astype(np.int32),
        coarse.faces,
        deviation(local, faces, errors, coarse),
        coarse.attributes,
    )
    return piece, coarse.is_relaxed


def _on_grid(piece: Piece, task: CellTask) -> Piece:
    """From the door's fine grid to the file's, with the distance that each face moved by."""
    positions, errors = np.empty_like(piece.positions), np.empty(len(piece.faces), np.float32)
    moved = np.empty(len(positions))
    kernels.to_grid(piece.positions, piece.faces, task.ratio, task.offset, moved, positions, errors)
    return Piece(piece.ids, positions, piece.faces, errors, piece.attributes)


def _first_patches(
    whole: Piece, locked: NDArray[np.bool_], most: int
) -> tuple[Piece, NDArray[np.bool_], list[Piece], list[NDArray[np.int32]]]:
    """The cell as one patch, however the file was read; as several if cells had to be joined."""
    if len(whole.faces) <= 2 * most:
        return whole, locked, [whole], [np.arange(len(whole.ids), dtype=np.int32)]
    points = corner_sums(whole.positions, whole.faces)
    pieces = [piece for _, piece in split(whole, partition(points, limit=most, level=0))]
    again, maps = join(pieces)
    before, _ = local_numbers(np.concatenate([whole.ids, again.ids]))
    return again, locked[before[len(whole.ids) :]], pieces, maps


def _patches(
    task: CellTask,
    whole: Piece,
    pieces: list[Piece],
    maps: list[NDArray[np.int32]],
    local: NDArray[np.float64],
    locked: NDArray[np.bool_],
) -> tuple[list[Patch], list[tuple[NDArray[np.int32], NDArray[np.int32]]], SharedNormals | None]:
    colours = normals = None
    shared = None
    if task.has_colours:
        colours = np.rint(whole.attributes[:, :3]).clip(0, 255).astype(np.uint8)
    if task.normal_bits and task.has_normals:
        normals = quantise_normals(whole.attributes[:, -3:], bits=task.normal_bits)
    elif task.normal_bits:
        sums = np.empty((len(local), 3))
        kernels.vertex_normals(local, whole.faces, sums)
        normals = quantise_normals(sums, bits=task.normal_bits)
        shared = SharedNormals(whole.ids[locked], sums[locked])
    patches, waiting = [], []
    for piece, where in zip(pieces, maps, strict=True):
        patches.append(
            Patch(
                piece.positions,
                piece.faces,
                None if normals is None else normals[where],
                None if colours is None else colours[where],
            )
        )
        mine = np.flatnonzero(locked[where]).astype(np.int32) if shared is not None else np.empty(0, np.int32)
        waiting.append((mine, piece.ids[mine]))
    return patches, waiting, shared


def _count_oddities(whole: Piece, locked: NDArray[np.bool_], result: CellResult) -> None:
    """Duplicate triangles and odd edges; edges between shared vertices are left to be counted together."""
    faces = whole.faces[is_proper(whole.faces)]
    edges, totals = np.empty((3 * len(faces), 3), np.int32), np.empty(4, np.int64)
    kernels.odd_edges(faces, *incidence(faces, len(whole.ids)), locked, edges, totals)
    result.edges = (int(totals[0]), int(totals[1]))
    result.duplicate = int(totals[2])
    result.open_edges = edges[: totals[3]].copy()
    result.open_edges[:, :2] = np.sort(whole.ids[result.open_edges[:, :2]], axis=1)
