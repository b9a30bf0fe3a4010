"""√3 refinement for a view as published: filtered by the neighbours at hand, rewound by its history.

Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
√3-subdivision; borders by L. Kobbelt. √3-subdivision. SIGGRAPH 2000.
"""

import math

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels_extract as extract
from . import _kernels_filter_relax as relax
from . import _kernels_filter_steps as steps
from . import _kernels_filter_undo as undo
from ._kernels_criteria import BACK, FRONT, ITERATIONS, SILHOUETTE
from ._kernels_filter import FACES, MOVES, SPLITS, SWAPS, VERTICES
from .cage import Cage
from .criteria import Criteria, view_of
from .filter_net import FilterNet
from .slots import Placing, Slots
from .sqrt3 import Update

__all__ = ["Sqrt3Filter"]

#: Kobbelt's weights by valence; the kernels compute those beyond.
_SHARES = np.array([0.0] + [(4 - 2 * math.cos(2 * math.pi / n)) / 9 for n in range(1, 64)])

_NO_FACES, _EVER = np.empty(0, np.int32), int(np.iinfo(np.int32).max)


class Sqrt3Filter:
    """The paper's own √3 refinement; `Sqrt3` is the one to use, this one is to compare with.

    Each view begins with the control mesh, to which a history of actions leads back. An iteration splits the
    faces that the criteria for fronts or silhouettes ask for, relaxes their corners by the neighbours of the
    moment, and swaps their old edges, whatever is beyond: it is Kobbelt's surface only where all is split.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed.
    name : str
        What errors call it.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface; the sentence names the edge or vertex.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> ball = icosphere(1)
    >>> refined = Sqrt3Filter(ball)
    >>> done = refined.update(Camera.around([-1, -1, -1], [1, 1, 1]), budget=500)
    >>> done.faces, done.is_done
    (500, False)
    >>> refined.rewind()
    >>> bool((refined.mesh().positions == ball.positions).all())
    True
    """

    def __init__(self, mesh: TriMesh, /, *, name: str = "mesh") -> None:
        self._net = FilterNet.of(Cage.of(mesh, name=name))
        self._ends: list[int] = []  # of each label: the length of its kind's history after its step
        # What the mesh is refined for, and the rest of the sequence: faces that may be split, of which the
        # first may have a silhouette edge; and whether the budget ended it.
        self._wanted: tuple[bytes, bytes, int] | None = None
        self._thirds, self._seeds, self._is_cut = _NO_FACES, 0, False

    def update(
        self,
        camera: Camera,
        /,
        *,
        criteria: Criteria | None = None,
        most_splits: int | None = None,
        budget: int | None = None,
    ) -> Update:
        """Rewind, then refine for what `camera` sees; for the same view again, go on where it ended.

        Parameters
        ----------
        camera : Camera
            In the space of the mesh: of a placed model move the camera, inversely.
        criteria : Criteria, optional
            An iteration counts for all alike, whatever a face's level. `bend` is the angle between a face's
            normal and those of the faces beside it.
        most_splits : int, optional
            Stop after the iteration with which there are so many. Further updates go on, and end in the very
            mesh that one without this limit makes.
        budget : int, optional
            Triangles at most: the sequence ends where the next split would pass it, silhouettes going first.
            Then `is_done` is false, and stays so.
        """
        view, limits = view_of(camera), (criteria or Criteria()).limits()
        most = max(budget if budget is not None else _EVER, 0)
        wanted = view.tobytes(), limits.tobytes(), most
        undone = 0
        if wanted != self._wanted:
            undone = self._splits
            self.rewind()
            self._wanted, self._seeds = wanted, int(self._net.counts[FACES])
            self._thirds = np.arange(self._seeds, dtype=np.int32)
            self._net.flags[: self._seeds] = extract.AREA
        before, allowed = self._splits, _EVER if most_splits is None else most_splits
        while len(self._thirds) > 0 and self._splits - before < allowed:
            chosen, silhouettes = self._choose(self._thirds, self._seeds, view, limits)
            room = max((most - int(self._net.counts[FACES])) // 2, 0)
            self._is_cut = len(chosen) > room
            thirds = self._iterate(chosen[:room]) if min(len(chosen), room) else _NO_FACES
            self._thirds, self._seeds = _NO_FACES if self._is_cut else thirds, 3 * silhouettes
        faces, vertices = int(self._net.counts[FACES]), int(self._net.counts[VERTICES])
        is_done = len(self._thirds) == 0 and not self._is_cut
        return Update(faces, vertices, self._splits - before, undone, is_done)

    @property
    def _splits(self) -> int:
        return int(self._net.counts[SPLITS])

    def _choose(
        self,
        candidates: NDArray[np.int32],
        seeds: int,
        view: NDArray[np.float64],
        limits: NDArray[np.float64],
    ) -> tuple[NDArray[np.int32], int]:
        """The faces an iteration splits, by index but silhouettes first, and how many these are.

        Silhouette edges are looked for at the first `seeds` of the candidates.
        """
        net, iteration = self._net, self.label // 3
        # The last strips are the longest: to look for them in vain was half of all the search.
        if iteration >= limits[SILHOUETTE, ITERATIONS]:
            seeds = 0
        if iteration >= max(limits[FRONT, ITERATIONS], limits[BACK, ITERATIONS]):
            net.flags[candidates[seeds:]] = 0
            candidates = candidates[:seeds]
        parts = [
            part[: extract.keep_inside(net.positions, net.corners, net.flags, view, part)]
            for part in (candidates[:seeds], candidates[seeds:])
        ]
        candidates = np.concatenate(parts)
        extract.face_the_eye(net.positions, net.corners, net.flags, view, candidates)
        chosen = np.empty(int(net.counts[FACES]), np.int32)
        strips = extract.strips(
            net.positions, net.corners, net.beside, net.flags, net.marks, view, parts[0], chosen
        )
        silhouettes, count = steps.choose(net, candidates, strips, chosen, view, limits, iteration)
        chosen[:silhouettes].sort()
        chosen[silhouettes:count].sort()
        return chosen[:count], int(silhouettes)

    def _iterate(self, chosen: NDArray[np.int32]) -> NDArray[np.int32]:
        """Split, filter, swap; returns the thirds. Where vertices move is read before the split."""
        count, is_odd = len(chosen), self.label // 3 % 2 == 1
        vertices = int(self._net.counts[VERTICES])
        self._net = self._net.with_room((2 * count, 2 * count, count, min(3 * count, vertices), 3 * count))
        net, thirds = self._net, np.empty(3 * count, np.int32)
        moves = relax.prepare_moves(net, chosen, is_odd, _SHARES)
        steps.split_all(net, chosen, is_odd, thirds)
        self._ends.append(int(net.counts[SPLITS]))
        relax.move_all(net, moves)
        self._ends.append(int(net.counts[MOVES]))
        steps.swap_all(net, thirds)
        self._ends.append(int(net.counts[SWAPS]))
        return thirds

    @property
    def label(self) -> int:
        """How many steps were done: of iteration i, from 0, step 3 i splits, 3 i + 1 moves, 3 i + 2 swaps."""
        return len(self._ends)

    def rewind(self, *, to: int = 0) -> None:
        """Undo all steps with this label or a higher one: bit for bit the mesh before the first of them.

        Parameters
        ----------
        to : int
            In [0, `label`]; 0 is the control mesh.
        """
        if not 0 <= to <= self.label:
            raise ValueError(f"to must be a label from 0 to {self.label}, got {to}")
        self._wanted, self._thirds, self._is_cut = None, _NO_FACES, False
        actions = (undo.unsplit_all, undo.unmove_all, undo.unswap_all)
        while self.label > to:
            self._ends.pop()
            begin = self._ends[-3] if self.label >= 3 else 0
            actions[self.label % 3](self._net, begin)

    def mesh(self, *, positions: Placing = "control") -> TriMesh:
        """The mesh as it is: faces in no particular order, counter-clockwise as those of the control mesh."""
        faces, vertices = int(self._net.counts[FACES]), int(self._net.counts[VERTICES])
        return TriMesh(self._positions(positions, vertices), self._net.corners[:faces].copy())

    def slots(self, *, positions: Placing = "control") -> Slots:
        """The mesh as it is, slot by slot: none is free, and another view fills all anew."""
        net = self._net
        faces, vertices = int(net.counts[FACES]), int(net.counts[VERTICES])
        starts, moves = net.positions[:vertices].copy(), int(net.counts[MOVES])
        moved, before = net.moved[:moves], net.before[:moves]
        starts[moved[::-1]] = before[::-1]  # of several the last one written counts: a vertex's first move
        return Slots(
            net.corners[:faces].copy(),
            self._positions(positions, vertices),
            starts,
            net.levels[:faces].copy(),
            np.zeros(faces, np.uint8),
        )

    def _positions(self, placing: Placing, vertices: int) -> NDArray[np.float64]:
        """(vertices, 3). In the limit: by Kobbelt's masks for the neighbours at hand."""
        if placing != "limit":
            return self._net.positions[:vertices].copy()
        positions = np.empty((vertices, 3))
        relax.limits(self._net, _SHARES, positions)
        return positions

    @property
    def bytes_used(self) -> int:
        """What is in use of the arrays, all told, the history with it."""
        return self._net.bytes_used
