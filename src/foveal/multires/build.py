"""From a mesh of any size to a `.fov` of patches."""

import math
import os
import time
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import psutil

from foveal.base.errors import FovealError
from foveal.base.files import scratch
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import ordered_map, thread_count, threads
from foveal.container import create
from foveal.lod.graph import Graph
from foveal.mesh.io.blocks import MeshSource
from foveal.mesh.io.source import open_source, source_from_mesh
from foveal.mesh.trimesh import TriMesh

from . import codec, graph_chunk
from .intake import FINE_BITS, Intake, Repairs
from .levels import Grid, Level, Levels, Settings
from .plan import Plan
from .plan import header as file_header
from .spool import Room
from .step import choose_step

__all__ = ["CELL_TRIANGLES", "ROOT_TRIANGLES", "BuildReport", "build"]

VERSION = 1

#: Triangles of a cell. The dragon (871 K triangles) at 11 bits without normals, then with the defaults:
#:
#: ======  =================  =====================  ======================
#: cell    file, MB           before the first data  drawn at 1 px
#: ======  =================  =====================  ======================
#: 8 K     1.52    3.07       2.2 %    1.1 %         236 K    77 K
#: 16 K    1.42    2.71       1.3 %    0.7 %         315 K    88 K
#: 24 K    1.39    2.66       0.98 %   0.55 %        357 K    96 K
#: 32 K    1.34    2.57       0.8 %    0.45 %        375 K    101 K
#: ======  =================  =====================  ======================
#:
#: Drawn: 1280 x 720, 40 degrees, the eye at 2.5 radii. Header and index are what everybody waits for, so
#: they may take one part in a hundred; of what keeps that, the smallest cells follow the view most closely.
CELL_TRIANGLES = 24576

#: Triangles of the coarsest mesh: what a page shows first; 4 K triangles are about 6 KB.
ROOT_TRIANGLES = 4096

#: What Python with its libraries and machine code takes before any data.
_BASE_BYTES = 300 << 20

#: Patches that the codec's tables are trained on; more change nothing in the third digit.
_TRAINING = 64


@dataclass(frozen=True)
class BuildReport:
    """What a build did.

    Attributes
    ----------
    repairs : Repairs
        Counts of the input and of what was odd about it.
    levels : list of dict
        From fine to coarse: triangles, cells, left, locked_share, relaxed_cells, stalled_cells, joined,
        and error in the unit of the input.
    nodes, patches, stored_triangles, bytes : int
    step : float
        Of the grid, in the unit of the input.
    seconds : dict
        Of each stage.
    """

    repairs: Repairs
    levels: list[dict[str, Any]]
    nodes: int
    patches: int
    stored_triangles: int
    bytes: int
    step: float
    seconds: dict[str, float]


def build(
    source: MeshSource | TriMesh | str | os.PathLike[str],
    output_path: str | os.PathLike[str],
    /,
    *,
    bits: int | None = None,
    step: float | None = None,
    cell_triangles: int = CELL_TRIANGLES,
    normals: Literal["auto", "none"] = "auto",
    memory_bytes: int | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    progress: Progress = SILENT,
) -> BuildReport:
    """Build a multiresolution file: patches at all resolutions, with true error bounds.

    Parameters
    ----------
    source
        A mesh, a mesh file, or a stream of blocks.
    output_path
        The `.fov` to write; it appears when it is whole.
    bits : int, optional
        Bits of the grid: its step is the largest side of the box / (2^bits - 1).
    step : float, optional
        The step itself, in the unit of the mesh. Without `bits` and `step` it is chosen such that
        quantisation adds little to the error of the first simplification.
    cell_triangles : int
        Triangles of a cell, the unit that is simplified and swapped.
    normals : "auto" or "none"
        "auto" keeps the mesh's normals, or makes them of the faces' where it has none.
    memory_bytes : int, optional
        The process stays below it, whatever the size of the mesh; by default half of what is free.
    executor : Executor, optional
        Where cells are worked on; by default `workers` threads of this process.
    progress : Progress

    Raises
    ------
    FovealError
        If the source cannot be read, holds no proper triangle, or the step does not fit its size.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "ball.fov"
    >>> report = build(icosphere(3), path, bits=12)
    >>> report.repairs.triangles, report.nodes
    (1280, 2)
    """
    if bits is not None and step is not None:
        raise ValueError("give bits or step, not both")
    if cell_triangles < 64:
        raise ValueError(f"cell_triangles must be at least 64, got {cell_triangles}")
    if normals not in ("auto", "none"):
        raise ValueError(f'normals must be "auto" or "none", got {normals!r}')
    if bits is not None and (int(bits) != bits or not 1 <= bits <= FINE_BITS - 1):
        raise ValueError(f"bits must be a whole number from 1 to {FINE_BITS - 1}, got {bits}")
    if step is not None and not (math.isfinite(step) and step > 0):
        raise ValueError(f"step must be a positive length, got {step}")
    if memory_bytes is not None and memory_bytes < 1:
        raise ValueError(f"memory_bytes must be positive, got {memory_bytes}")
    if memory_bytes is not None and memory_bytes < _BASE_BYTES:
        progress.note(
            f"Python and its libraries take about {_BASE_BYTES >> 20} MB: less cannot be kept within."
        )
    source = _source(source)
    clock = _Clock()
    with ExitStack() as stack:
        folder = stack.enter_context(scratch())
        pool = executor if executor is not None else stack.enter_context(threads(workers))
        ahead = 2 * thread_count(workers)
        room = Room(_room_bytes(memory_bytes), folder)
        intake = Intake(room, source.has_normals and normals != "none", source.has_colours, name=source.name)
        stack.callback(intake.close)
        intake.read(source, progress)
        clock.lap("read")
        settings = Settings(
            cell_triangles,
            ROOT_TRIANGLES,
            10 if normals == "auto" else 0,
            source.has_colours,
            intake.has_normals,
            ahead,
        )
        levels = Levels(intake, room, settings, pool)
        stack.callback(levels.patches.close)
        chosen = _given_step(intake, bits, step, source.name)

        def choose_grid(_: Any, cells: Any) -> Grid:
            nonlocal chosen
            if chosen is None:
                chosen = choose_step(cells, intake.fine_step, pool)
            return _grid(intake, chosen)

        levels.run(choose_grid, progress)
        assert chosen is not None
        clock.lap("simplify")
        for sentence in intake.repairs.sentences():
            progress.note(sentence)
        _note_trouble(levels.levels, progress)
        graph, header = _write(
            Path(output_path), source, intake, levels, chosen, settings, pool, progress, clock
        )
    return BuildReport(
        intake.repairs,
        header["level_table"],
        len(graph.errors),
        len(graph.finer),
        int(graph.triangles.sum()),
        Path(output_path).stat().st_size,
        chosen,
        clock.laps,
    )


class _Clock:
    def __init__(self) -> None:
        self._last = time.perf_counter()
        self.laps: dict[str, float] = {}

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.laps[name] = round(now - self._last, 4)
        self._last = now


def _source(source: MeshSource | TriMesh | str | os.PathLike[str]) -> MeshSource:
    if isinstance(source, TriMesh):
        return source_from_mesh(source)
    if isinstance(source, MeshSource):
        return source
    return open_source(source)


def _room_bytes(memory_bytes: int | None) -> int:
    """What stores may hold: half of what the base leaves, since cells in work take the rest."""
    if memory_bytes is None:
        memory_bytes = psutil.virtual_memory().available // 2
    return max(16 << 20, (memory_bytes - _BASE_BYTES) // 2)


def _given_step(intake: Intake, bits: int | None, step: float | None, name: str) -> float | None:
    extent = intake.extent or 1.0
    if bits is not None:
        return extent / ((1 << bits) - 1)
    if step is not None and not 2 * intake.fine_step < step <= extent:
        fault = "too large" if step > extent else "too small"
        raise FovealError(
            f"{name}: a step of {step} is {fault} for a model of size {extent:.6g}. "
            f"Give at least {4 * intake.fine_step:.2g} and at most that size."
        )
    return step


def _grid(intake: Intake, step: float) -> Grid:
    # Rounding to the door's grid moved each point by half a diagonal at most; doubles of large
    # coordinates are coarser than that grid sometimes.
    largest = float(np.abs(np.concatenate([intake.low, intake.high])).max())
    offset = math.sqrt(3) / 2 * intake.fine_step + 8 * np.finfo(np.float64).eps * largest
    return Grid(intake.fine_step / step, offset / step)


def _note_trouble(levels: list[Level], progress: Progress) -> None:
    for number, level in enumerate(levels):
        if level.stalled_cells:
            progress.note(
                f"Level {number}: {level.stalled_cells} of {level.cells} cells could not be brought to "
                "three quarters of their triangles."
            )
        if level.relaxed_cells:
            progress.note(
                f"Level {number}: in {level.relaxed_cells} of {level.cells} cells small pieces or holes "
                "were given up to get smaller."
            )
        if level.joined > 1:
            progress.note(
                f"Level {number}: cells were made {level.joined} times larger, since nearly all vertices "
                "lay on their borders."
            )


def _write(
    path: Path,
    source: MeshSource,
    intake: Intake,
    levels: Levels,
    step: float,
    settings: Settings,
    pool: Executor,
    progress: Progress,
    clock: _Clock,
) -> tuple[Graph, dict[str, Any]]:
    plan = Plan(levels, step)
    patches = plan.patches
    every = max(1, len(patches) // _TRAINING)
    bits = settings.normal_bits or 10
    tables = codec.train([p() for p in patches[::every]], normal_bits=bits, executor=pool)
    clock.lap("train")
    with create(path, kind="multires", version=VERSION) as writer:
        items = (([patches[i]() for i in range(a, b)], tables) for a, b in plan.ranges())
        sizes: list[int] = []
        with progress.stage("Compressing", float(len(plan.errors))) as stage:
            for encoded in ordered_map(pool, _encode, items, ahead=settings.ahead):
                sizes += [len(e) for e in encoded]
                writer.add_chunk(b"".join(encoded))
                stage.advance()
        graph = plan.graph(sizes)
        header = file_header(source, intake, levels, plan, step, settings)
        writer.finish(header, graph_chunk.pack(graph, tables.to_bytes()))
    clock.lap("encode")
    return graph, header


def _encode(item: tuple[list[codec.Patch], codec.Tables]) -> list[bytes]:
    patches, tables = item
    return [codec.encode(patch, tables) for patch in patches]
