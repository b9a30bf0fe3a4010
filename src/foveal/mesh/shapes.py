"""Meshes made of formulas: for examples, tests and benchmarks, of any size."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .io.blocks import Blocks, FaceBlock, MeshSource, VertexBlock
from .trimesh import TriMesh

__all__ = [
    "bumpy_sphere",
    "grid_patch",
    "icosphere",
    "stream_terrain",
    "terrain",
    "tetrahedron",
    "torus",
]


def tetrahedron() -> TriMesh:
    """The regular tetrahedron with corners on the unit sphere: 4 vertices, 4 triangles, closed."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=np.float64) / math.sqrt(3)
    return TriMesh(corners, np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], dtype=np.int32))


def _icosahedron() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    g = (1 + math.sqrt(5)) / 2
    corners = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g]]
    corners += [[0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]]
    faces = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4]]
    faces += [[11, 10, 2], [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9]]
    faces += [[4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1]]
    return np.array(corners, dtype=np.float64), np.array(faces, dtype=np.int64)


def icosphere(level: int, *, radius: float = 1.0) -> TriMesh:
    """An icosahedron split in four `level` times, on a sphere: 20 · 4^level triangles, closed.

    Examples
    --------
    >>> ball = icosphere(2)
    >>> len(ball.positions), len(ball.faces)
    (162, 320)
    """
    points, faces = _icosahedron()
    for _ in range(level):
        edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        keys, index = np.unique(edges[:, 0] * len(points) + edges[:, 1], return_inverse=True)
        middle = index.reshape(-1, 3) + len(points)
        ends = np.stack(np.divmod(keys, len(points)))
        points = np.concatenate([points, points[ends[0]] + points[ends[1]]])
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        a, b, c = faces.T
        ab, bc, ca = middle.T
        corners = [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        faces = np.array(corners, dtype=np.int64).transpose(2, 0, 1).reshape(-1, 3)
    points *= radius / np.linalg.norm(points, axis=1, keepdims=True)
    return TriMesh(points, faces.astype(np.int32))


def bumpy_sphere(level: int, *, seed: int = 0, height: float = 0.05) -> TriMesh:
    """An icosphere whose radius varies smoothly by about `height`: curved everywhere, closed."""
    ball = icosphere(level)
    rng = np.random.default_rng(seed)
    waves = rng.normal(size=(24, 3)) * rng.uniform(1, 12, size=(24, 1))
    phases = rng.uniform(0, 2 * math.pi, 24)
    bumps = np.zeros(len(ball.positions))
    for wave, phase in zip(waves, phases, strict=True):
        bumps += np.cos(ball.positions @ wave + phase) / math.sqrt(len(waves) / 2)
    return TriMesh(ball.positions * (1 + height * bumps)[:, None], ball.faces)


def _grid_faces(rows: int, columns: int) -> NDArray[np.int32]:
    """Two triangles a cell of a grid of `rows` by `columns` cells over (rows + 1)(columns + 1) vertices."""
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    right, up = corner + 1, corner + columns + 1
    return np.stack([corner, right, up + 1, corner, up + 1, up], axis=1).reshape(-1, 3).astype(np.int32)


def grid_patch(columns: int, rows: int | None = None) -> TriMesh:
    """The unit square at z = 0 as `columns` by `rows` cells of two triangles each, seen from +z; open."""
    rows = columns if rows is None else rows
    y, x = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, columns + 1), indexing="ij")
    return TriMesh(np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1), _grid_faces(rows, columns))


def terrain(cells: int, *, seed: int = 0, height: float = 0.1) -> TriMesh:
    """A height field z(x, y) over the unit square, rough at all scales: 2 cells² triangles, open, z up."""
    flat = grid_patch(cells)
    grid = np.zeros((cells + 1, cells + 1))
    rng = np.random.default_rng(seed)
    amplitude, knots = height, 4
    while knots <= cells:  # octaves of smoothed random heights
        grid += amplitude * _smooth_noise(rng.normal(size=(knots + 1, knots + 1)), cells + 1)
        amplitude, knots = amplitude * 0.45, knots * 2
    flat.positions[:, 2] = grid.ravel()
    return flat


def _smooth_noise(knots: NDArray[np.float64], size: int) -> NDArray[np.float64]:
    """The knots' values spread over a square grid of `size` points, blended by 3t² - 2t³."""
    t = np.linspace(0, len(knots) - 1, size)
    cell = np.minimum(t.astype(np.int64), len(knots) - 2)
    t = t - cell
    blend = (t * t * (3 - 2 * t))[:, None]
    rows = knots[cell] * (1 - blend) + knots[cell + 1] * blend
    result: NDArray[np.float64] = rows[:, cell] * (1 - blend.T) + rows[:, cell + 1] * blend.T
    return result


def torus(rings: int, sides: int, *, major: float = 1.0, minor: float = 0.4) -> TriMesh:
    """A torus around z of 2 · rings · sides triangles: closed, genus 1."""
    u = np.arange(rings)[:, None] * (2 * math.pi / rings)
    v = np.arange(sides)[None, :] * (2 * math.pi / sides)
    reach = major + minor * np.cos(v)
    x, y, z = reach * np.cos(u), reach * np.sin(u), np.broadcast_to(minor * np.sin(v), (rings, sides))
    faces = np.concatenate([_ring_faces(i, rings, sides) for i in range(rings)])
    return TriMesh(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), faces.astype(np.int32))


def _ring_faces(ring: int, rings: int, sides: int) -> NDArray[np.int64]:
    """The triangles between `ring` and the next of a torus."""
    here = np.arange(sides) + ring * sides
    there = np.arange(sides) + (ring + 1) % rings * sides
    here_up, there_up = np.roll(here, -1), np.roll(there, -1)
    return np.stack([here, there, there_up, here, there_up, here_up], axis=1).reshape(-1, 3)


def stream_terrain(triangles: int, *, seed: int = 0, has_colours: bool = False) -> MeshSource:
    """A bumpy closed torus of about `triangles` triangles, made while it is read, never held.

    For benchmarks of any size: 100 million triangles take a few seconds to make.

    Examples
    --------
    >>> sum(len(b.faces) for b in stream_terrain(20_000).blocks() if isinstance(b, FaceBlock))
    20022
    """
    sides = max(3, round(math.sqrt(triangles / 4)))
    rings = max(3, round(triangles / (2 * sides)))
    return _BumpyTorus(
        name=f"torus of {2 * rings * sides} triangles",
        up="z",
        has_colours=has_colours,
        size_hint=rings * sides * 12 + 2 * rings * sides * 12,
        rings=rings,
        sides=sides,
        seed=seed,
    )


@dataclass
class _BumpyTorus(MeshSource):
    rings: int = field(kw_only=True)
    sides: int = field(kw_only=True)
    seed: int = field(kw_only=True)

    def __post_init__(self) -> None:
        rng = np.random.default_rng(self.seed)
        waves = 2 ** np.arange(12)
        self._across = (rng.integers(1, 3, 12) * waves, rng.uniform(0, 2 * math.pi, 12))
        self._along = (rng.integers(1, 3, 12) * waves, rng.uniform(0, 2 * math.pi, 12))
        self._heights = 0.12 * 0.55 ** np.arange(12)

    def _rows(self, begin: int, end: int) -> VertexBlock:
        """Vertices of the rings `begin` to `end`. Bumps are sums of products, so cosines stay few."""
        u = np.arange(begin, end) * (2 * math.pi / self.rings)
        v = np.arange(self.sides) * (2 * math.pi / self.sides)
        along = np.cos(np.outer(u, self._along[0]) + self._along[1]) * self._heights
        across = np.cos(np.outer(v, self._across[0]) + self._across[1])
        bumps = along @ across.T
        minor = 0.4 * (1 + bumps)
        reach = 1 + minor * np.cos(v)
        points = np.empty((end - begin, self.sides, 3))
        points[..., 0] = reach * np.cos(u)[:, None]
        points[..., 1] = reach * np.sin(u)[:, None]
        points[..., 2] = minor * np.sin(v)
        colours = None
        if self.has_colours:
            colours = np.clip(128 + 500 * bumps[..., None] * (1, 0.5, -1), 0, 255).astype(np.uint8)
            colours = colours.reshape(-1, 3)
        return VertexBlock(points.reshape(-1, 3), None, colours)

    def blocks(self) -> Blocks:
        self.bytes_read = 0
        step = max(1, 65536 // self.sides)
        done = 0  # rings whose triangles towards the next are out
        for begin in range(0, self.rings, step):
            end = min(begin + step, self.rings)
            yield self._rows(begin, end)
            last = end if end == self.rings else end - 1
            rings = [_ring_faces(ring, self.rings, self.sides) for ring in range(done, last)]
            done = last
            self.bytes_read = self.size_hint * done // self.rings
            if rings:
                yield FaceBlock(np.concatenate(rings))
