"""Uniform subdivision of a control mesh: Loop's scheme and the modified butterfly.

Based on: C. Loop. Smooth subdivision surfaces based on triangles. Master's thesis, Utah 1987; D. Zorin,
P. Schröder, W. Sweldens. Interpolating subdivision for meshes with arbitrary topology. SIGGRAPH 1996.
"""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh

from . import _kernels_uniform as kernels
from . import _kernels_uniform_butterfly as butterfly_kernels
from . import _kernels_uniform_normals as normal_kernels
from .cage import Cage

__all__ = ["Level", "LoopRule", "butterfly", "limit_normals", "loop"]

Positions = NDArray[np.float64]
Boundary = Literal["edge", "corner"]


class Level(NamedTuple):
    """The connectivity of one level; `_kernels_uniform.py` tells how the next follows from it.

    Attributes
    ----------
    faces : (m, 3) int32
    edges : (m, 3) int32
        The edge from corner k to k + 1.
    halves : (e, 2) int32
        The half-edges 3 f + k of each edge; the second is -1 on the border.
    """

    faces: NDArray[np.int32]
    edges: NDArray[np.int32]
    halves: NDArray[np.int32]

    @classmethod
    def of(cls, cage: Cage, /) -> "Level":
        """The control mesh's."""
        count = len(cage.faces)
        edges, halves = np.empty((count, 3), np.int32), np.empty((3 * count, 2), np.int32)
        used = int(kernels.number_edges(cage.faces, cage.beside, edges, halves))
        return cls(cage.faces, edges, halves[:used].copy())

    def rim(self) -> NDArray[np.int32]:
        """The half-edges along the border: each of its vertices begins one."""
        rim: NDArray[np.int32] = self.halves[self.halves[:, 1] < 0, 0]
        return rim

    def is_border(self, vertices: int, /) -> NDArray[np.bool_]:
        """(vertices,): which of this level's vertices lie on the border."""
        flags = np.zeros(vertices, np.bool_)
        flags[self.faces.reshape(-1)[self.rim()]] = True
        return flags

    def split_faces(self, vertices: int, /) -> NDArray[np.int32]:
        """(4 m, 3): the faces of the next level, where this has so many vertices."""
        fine = np.empty((4 * len(self.faces), 3), np.int32)
        kernels.split_faces(self.faces, self.edges, vertices, fine)
        return fine

    def split(self, vertices: int, /) -> "Level":
        """The next level."""
        fine_edges = np.empty((4 * len(self.faces), 3), np.int32)
        fine_halves = np.empty((2 * len(self.halves) + 3 * len(self.faces), 2), np.int32)
        kernels.split_edges(self.edges, self.halves, fine_edges, fine_halves)
        return Level(self.split_faces(vertices), fine_edges, fine_halves)


class LoopRule:
    """Loop's scheme on one control mesh: positions of the next level, or of the limit, from those of one.

    Parameters
    ----------
    cage : Cage
    boundary : "edge" or "corner"
        As in `loop`.
    """

    def __init__(self, cage: Cage, /, *, boundary: Boundary = "edge") -> None:
        faces = np.bincount(cage.faces.reshape(-1), minlength=len(cage.positions))
        self._is_fixed = faces == 0
        if boundary == "corner":
            self._is_fixed |= cage.is_border & (faces == 1)
        valences = np.maximum(np.diff(cage.starts), 1)
        self._share = 5 / 8 - (3 / 8 + np.cos(2 * np.pi / valences) / 4) ** 2
        self._valences = valences

    def next(self, level: Level, positions: Positions, /) -> Positions:
        """(v + e, 3): the positions of the next level: those of this one's vertices, then of its edges."""
        count = len(positions)
        out = np.empty((count + len(level.halves), 3))
        kernels.loop_midpoints(level.faces, level.halves, positions, out[count:])
        self._relax(level, positions, out[:count], self._share, 5 / 8, (3 / 4, 1 / 8))
        return out

    def limit(self, level: Level, positions: Positions, /) -> Positions:
        """(v, 3): where the vertices of a level end up."""
        out = np.empty_like(positions)
        share = 8 * self._share / (3 + 8 * self._share)
        self._relax(level, positions, out, share, 1 / 2, (2 / 3, 1 / 6))
        return out

    def _relax(
        self,
        level: Level,
        positions: Positions,
        out: Positions,
        base_share: NDArray[np.float64],
        keep: float,
        border: tuple[float, float],
    ) -> None:
        """Each vertex by what it keeps of itself and its ring's share.

        `keep` is for vertices born later, which all have valence 6; `border` is (keep, share of a neighbour).
        """
        count, base = len(positions), len(self._valences)
        is_border = level.is_border(count)
        keeps, shares = np.full(count, keep), np.full(count, (1 - keep) / 6)
        keeps[:base], shares[:base] = 1 - base_share, base_share / self._valences
        keeps[is_border], shares[is_border] = border
        keeps[:base][self._is_fixed], shares[:base][self._is_fixed] = 1, 0
        out[:] = 0
        kernels.add_rings(level.faces, level.halves, positions, is_border, out)
        kernels.relax(positions, keeps, shares, out)


def loop(
    mesh: TriMesh,
    levels: int,
    /,
    *,
    boundary: Boundary = "edge",
    positions: Literal["control", "limit"] = "control",
    has_normals: bool = False,
    name: str = "mesh",
) -> TriMesh:
    """Every triangle in four, `levels` times, by Loop's scheme.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed. Normals and colours are not carried over.
    levels : int
        Steps, from 0.
    boundary : "edge" or "corner"
        The border is a cubic B-spline; "corner" keeps those of its vertices that have one triangle.
    positions : "control" or "limit"
        Where subdivision has the vertices on the last level, or where it would take them in the end.
    has_normals : bool
        Whether to give the limit surface's normals, too.
    name : str
        What errors call it.

    Returns
    -------
    TriMesh
        The control mesh's vertices come first, each later level's in order after them; faces 4 f to 4 f + 3
        of a level are parts of face f of the one before.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface; the sentence names the edge or vertex.
    ValueError
        If `levels` is negative or gives more triangles than int32 can count.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> smooth = loop(tetrahedron(), 2, positions="limit")
    >>> len(smooth.positions), len(smooth.faces)
    (34, 64)
    """
    _one_of("boundary", boundary, ("edge", "corner"))
    _one_of("positions", positions, ("control", "limit"))
    cage = _checked(mesh, levels, name)
    rule, level, points = LoopRule(cage, boundary=boundary), Level.of(cage), cage.positions
    is_last_whole = has_normals or positions == "limit"
    for step in range(levels):
        count = len(points)
        points = rule.next(level, points)
        if step + 1 < levels or is_last_whole:
            level = level.split(count)
        else:  # no one asks for its edges, which take longer than all the rest
            return TriMesh(points, level.split_faces(count))
    normals = limit_normals(level, points) if has_normals else None
    return TriMesh(rule.limit(level, points) if positions == "limit" else points, level.faces, normals)


def limit_normals(level: Level, points: Positions, /) -> NDArray[np.float32]:
    """(v, 3): unit normals of Loop's limit surface at a level's vertices; zero where there is none."""
    first = np.empty(len(points), np.int32)
    kernels.first_half_edges(level.faces, level.halves, first)
    most = int(np.bincount(level.faces.reshape(-1)).max()) + 1
    normals = np.empty(points.shape, np.float32)
    size = float(np.ptp(points, axis=0).max(initial=0)) or 1.0  # so that no square under- or overflows
    is_border = level.is_border(len(points))
    ring = np.empty(most, np.int32)
    normal_kernels.limit_normals(*level, points / size, is_border, first, ring, normals)
    return normals


def butterfly(mesh: TriMesh, levels: int, /, *, name: str = "mesh") -> TriMesh:
    """Every triangle in four, `levels` times, by the modified butterfly, which goes through all vertices.

    Tension is w = 0. On the border new vertices follow the four-point rule -1, 9, 9, -1 over 16. The paper
    says nothing of edges that come near it, and no two libraries agree: here an inner edge takes the stencil
    of its inner end of valence other than six (the mean of both ends'), else the regular one, in which a wing
    beyond the border is the reflection of the triangle's third corner: it completes the parallelogram.

    Parameters
    ----------
    mesh, levels, name
        As in `loop`.

    Returns
    -------
    TriMesh
        Ordered as by `loop`.

    Raises
    ------
    FovealError, ValueError
        As `loop`.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> ball = icosphere(1)
    >>> bool((butterfly(ball, 1).positions[:42] == ball.positions).all())
    True
    """
    cage = _checked(mesh, levels, name)
    level, points = Level.of(cage), cage.positions
    base_valences = np.diff(cage.starts)
    for _ in range(levels):
        count = len(points)
        valences = np.full(count, 6, np.int64)
        valences[: len(base_valences)] = base_valences
        is_border = level.is_border(count)
        rim = level.rim()
        begin = level.faces.reshape(-1)[rim]
        end = level.faces.reshape(-1)[rim - rim % 3 + (rim + 1) % 3]
        before, after = np.full(count, -1, np.int32), np.full(count, -1, np.int32)
        before[end], after[begin] = begin, end
        fine = np.empty((count + len(level.halves), 3))
        fine[:count] = points
        butterfly_kernels.butterfly_midpoints(
            *level, points, valences, is_border, before, after, fine[count:]
        )
        level, points = level.split(count), fine
    return TriMesh(points, level.faces)


def _checked(mesh: TriMesh, levels: int, name: str) -> Cage:
    """The mesh as a surface, if so many levels of it can be counted."""
    if int(levels) != levels or levels < 0:
        raise ValueError(f"levels must be a whole number from 0, got {levels}")
    if 3 * len(mesh.faces) * 4 ** min(levels, 16) >= 2**31:
        raise ValueError(
            f"levels: {len(mesh.faces)} triangles split {levels} times are more than int32 can number"
        )
    return Cage.of(mesh, name=name)


def _one_of(name: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise ValueError(f"{name} must be {' or '.join(map(repr, allowed))}, got {value!r}")
