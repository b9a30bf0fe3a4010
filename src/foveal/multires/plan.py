"""Where everything goes in the file: the order of nodes and patches, the graph's columns, the header."""

import math
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.version import __version__
from foveal.lod.graph import Graph
from foveal.mesh.io.blocks import MeshSource

from . import _kernels_cells as kernels
from . import codec, graph_chunk
from .intake import Intake
from .levels import Level, Levels, Settings

__all__ = ["Plan", "header"]


class Plan:
    """The nodes in the file's order: the root, then level by level from coarse to fine.

    Attributes
    ----------
    errors : list of float
        Of each node, in steps, before nesting.
    sources : list
        Of each patch: its level and its place in the store; None for the root's.
    level_of : list of int
        Of each node, 0 the finest.
    low, high : (nodes, 3) int32
        Box of each node, in steps.
    node_errors : (nodes,) float64
        As stored, once `graph` was called.
    """

    def __init__(self, levels: Levels, step: float) -> None:
        self.levels = levels
        self.step = step
        first_of_level = {}
        at = 1
        for number in range(len(levels.levels) - 1, -1, -1):
            first_of_level[number] = at
            at += len(levels.levels[number].nodes)
        self.first_patch, self.finer = [0, 1], [1]
        root = levels.root
        assert root is not None
        self._root = root
        self.sources: list[tuple[Level, int] | None] = [None]
        self.errors, lows, highs = [math.inf], [root.positions.min(axis=0)], [root.positions.max(axis=0)]
        self.level_of = [len(levels.levels)]
        for number in range(len(levels.levels) - 1, -1, -1):
            level = levels.levels[number]
            for node in level.nodes:
                self.sources += [(level, ref) for ref in node.patches]
                below = first_of_level.get(number - 1, 0)
                self.finer += [-1 if f < 0 else below + f for f in node.finer]
                self.first_patch.append(len(self.sources))
                self.errors.append(node.error)
                lows.append(node.low)
                highs.append(node.high)
                self.level_of.append(number)
        self.low, self.high = np.array(lows), np.array(highs)
        self.counts = [(0, 0)] * len(self.sources)

    @property
    def patches(self) -> list[Callable[[], codec.Patch]]:
        """What loads each patch, in the file's order."""

        def loader(index: int) -> Callable[[], codec.Patch]:
            return lambda: self._load(index)

        return [loader(i) for i in range(len(self.sources))]

    def _load(self, index: int) -> codec.Patch:
        source = self.sources[index]
        patch = self._root_patch() if source is None else self.levels.patch(*source)
        self.counts[index] = (len(patch.faces), len(patch.positions))
        return patch

    def _root_patch(self) -> codec.Patch:
        root, settings = self._root, self.levels.settings
        colours = normals = None
        if settings.has_colours:
            colours = np.rint(root.attributes[:, :3]).clip(0, 255).astype(np.uint8)
        if settings.normal_bits and settings.has_normals:
            normals = codec.quantise_normals(root.attributes[:, -3:], bits=settings.normal_bits)
        elif settings.normal_bits:
            sums = np.empty((len(root.positions), 3))
            local = (root.positions - root.positions[0]).astype(np.float64)
            kernels.vertex_normals(local, root.faces, sums)
            normals = codec.quantise_normals(sums, bits=settings.normal_bits)
        return codec.Patch(root.positions, root.faces, normals, colours)

    def ranges(self) -> list[tuple[int, int]]:
        """First patch of each node, and the one after its last."""
        return list(zip(self.first_patch[:-1], self.first_patch[1:], strict=True))

    def graph(self, patch_bytes: list[int]) -> Graph:
        """All columns, errors and spheres nested from the leaves up; once all patches were loaded."""
        children: list[NDArray[np.int64]] = []
        for a, b in self.ranges():
            below = np.unique(np.array(self.finer[a:b], np.int64))
            children.append(below[below >= 0])
        # Where one cell is coarse another may show its finest patches: no promise is below theirs.
        errors = np.maximum(self.errors, self.levels.levels[0].moved)
        errors = graph_chunk.rounded_up(errors * self.step * (1 + 1e-9))
        for node in range(len(errors) - 1, 0, -1):
            if len(children[node]):
                errors[node] = max(errors[node], errors[children[node]].max())
        centres, radii = graph_chunk.nested_spheres(self.low * self.step, self.high * self.step, children)
        self.node_errors = errors
        counts = np.array(self.counts, np.int64)
        return Graph(
            centres,
            radii,
            errors,
            np.array(self.first_patch, np.int64),
            np.array(self.finer, np.int32),
            counts[:, 0],
            counts[:, 1],
            np.array(patch_bytes, np.int64),
        )


def header(
    source: MeshSource, intake: Intake, levels: Levels, plan: Plan, step: float, settings: Settings
) -> dict[str, Any]:
    """The file's header, as spec/container.md lists its keys; after `plan.graph`."""
    streams: list[dict[str, Any]] = [{"name": "position", "type": "grid3"}]
    if settings.normal_bits:
        streams.append({"name": "normal", "type": "octahedron", "bits": settings.normal_bits})
    if settings.has_colours:
        streams.append({"name": "colour", "type": "srgb8"})
    level_of = np.array(plan.level_of)
    table = []
    for number, level in enumerate(levels.levels):
        row: dict[str, Any] = level.row()
        row["error"] = float(plan.node_errors[level_of == number].max())
        table.append(row)
    return {
        "generator": f"foveal {__version__}",
        "origin": intake.low.tolist(),
        "step": step,
        "box": [plan.low.min(axis=0).tolist(), plan.high.max(axis=0).tolist()],
        "up": source.up,
        "triangles": intake.repairs.triangles,
        "vertices": intake.repairs.vertices,
        "nodes": len(plan.errors),
        "patches": len(plan.sources),
        "levels": len(levels.levels) + 1,
        "streams": streams,
        "codec": "foveal",
        "finest_error": levels.levels[0].moved * step * (1 + 1e-6),
        "input": asdict(intake.repairs),
        "level_table": table,
    }
