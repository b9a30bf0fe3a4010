"""RGB triangulations: conforming at every step, a function of mesh, camera and criteria alone.

Based on: E. Puppo. Selectively refinable subdivision meshes. Eurographics Symposium on Geometry Processing
2006. Where ours is another way:

* The mesh is a set of split edges of the infinite Loop hierarchy, closed under what splits require; the
  diagonal of a triangle with two split edges ends at the lower address. As published the order decides.
* Points are closed forms of where a vertex was born and of its limit, and what a stencil takes is computed
  by address, not split into the mesh for a time. That would be 2 % more splits, or 7 % for silhouettes alone
  (medians of five views of two models, 80,000 and 50,000 triangles), each to be merged again: little, but
  they would depend on the order, pass the budget on the way, and be needed anew with every view.
* As the set is unique, Qr and Qc need no priorities: a queue holds the faces whose edges are to be asked, and
  vertices that are not needed are taken out finest first. A budget chooses the threshold.
"""

from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels_rgb_show as show
from . import _kernels_rgb_update as kernels
from ._kernels_rgb_layout import (
    BUTTERFLY,
    FACES,
    FREE_CODE,
    LAST_IN_FIRST,
    LOOP,
    MERGES,
    PRESENT,
    SPLITS,
    VERTICES,
    WAITING,
)
from .cage import Cage
from .criteria import Criteria, view_of
from .drift import Drift
from .pace import coarser, factor
from .rgb_asked import bring_measured
from .rgb_budget import step_within
from .rgb_edges import Measure
from .rgb_net import check_base
from .rgb_state import State
from .slots import Placing, Slots
from .sqrt3 import Update

__all__ = ["Rgb", "rgb"]

RgbScheme = Literal["loop", "butterfly"]

_EVER = np.iinfo(np.int64).max

#: Of codes: green, red with its long or its short edge after the red one, blue.
_COLOURS = np.array([0, 1, 1, 2], np.uint8)


class Rgb:
    """An RGB triangulation that follows a camera, or any criteria for edges.

    An edge is split if it meets the criteria, or if a finer edge beside it needs it to be; a vertex stands
    where uniform subdivision has it on the highest level among it and its neighbours. Nothing reads the mesh
    of the moment, so the result is the same whatever was looked at before.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed.
    scheme : "loop" or "butterfly"
        Loop's masks of 1987 with smooth curves as borders, or the modified butterfly, which goes through the
        control mesh's vertices.
    cached : int
        How many vertices that are not in the mesh are kept with what is known of them, mostly those last
        used.
    name : str
        What errors call the mesh.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface; the sentence names the edge or vertex.
    ValueError
        If there is no such scheme.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> refined = Rgb(icosphere(1))
    >>> done = refined.update(Camera.around([-1, -1, -1], [1, 1, 1]))
    >>> len(refined.mesh().faces) == done.faces > 80
    True
    """

    def __init__(
        self, mesh: TriMesh, /, *, scheme: RgbScheme = "loop", cached: int = 1 << 16, name: str = "mesh"
    ) -> None:
        if scheme not in get_args(RgbScheme):
            raise ValueError(f"scheme must be one of {', '.join(get_args(RgbScheme))}, got {scheme!r}")
        if cached < 0:
            raise ValueError(f"cached must be a number of vertices, got {cached}")
        check_base(mesh, name)
        cage = Cage.of(mesh, name=name)
        self._state = State(cage, LOOP if scheme == "loop" else BUTTERFLY)
        self._cached, self._step = cached, 0
        low, high = self._state.box()[[0, -1]]
        self._drift = Drift(float(np.linalg.norm(high - low)))

    def update(
        self,
        camera: Camera | None = None,
        /,
        *,
        criteria: Criteria | Measure | None = None,
        budget: int | None = None,
        most_splits: int | None = None,
    ) -> Update:
        """Bring the mesh to what `camera` sees, or to what a function of edges asks for, from where it is.

        Parameters
        ----------
        camera : Camera, optional
            In the space of the mesh: of a placed model move the camera, inversely. Needed for `Criteria`.
        criteria : Criteria or function, optional
            Limits in the view; or a function of `Edges`, such as `by_length(0.1)`.
        budget : int, optional
            Triangles at most. If there would be more, all limits of edges in pixels (or 1, for a function's
            numbers) are taken so many eighths of an octave larger as it takes; the control mesh stays whole.
        most_splits : int, optional
            Stop after about so many, with a mesh that is whole but not yet as fine as wanted; for `Criteria`
            without a budget. Further updates go on, and end in the mesh that one without this limit makes.

        Raises
        ------
        ValueError
            If there are `Criteria` but no camera, or a function does not give a number for each edge.
        """
        counts = self._state.net.counts
        splits, merges = int(counts[SPLITS]), int(counts[MERGES])
        if budget is None:
            self._bring(camera, criteria, 0, _EVER, most_splits)
        else:
            self._step = step_within(
                lambda step: self._bring(camera, criteria, step, budget, None), self._step
            )
        show.forget(self._state.net, self._cached)
        counts = self._state.net.counts
        done = (int(counts[SPLITS]) - splits, int(counts[MERGES]) - merges)
        if counts[WAITING] == 0 or budget is not None:
            return Update(self._state.faces, self._state.vertices, *done)
        return Update(self._state.faces, self._state.vertices, *done, is_done=False)

    def _bring(
        self,
        camera: Camera | None,
        criteria: Criteria | Measure | None,
        step: int,
        most_faces: int,
        most_splits: int | None,
    ) -> bool:
        """Bring the mesh to criteria that are some steps coarser; whether it has at most so many faces."""
        if criteria is None or isinstance(criteria, Criteria):
            if camera is None:
                raise ValueError("criteria of a view need a camera")
            limits = coarser(criteria or Criteria(), step).limits()
            self._bring_view(view_of(camera), limits, most_faces, most_splits)
        else:
            self._drift.forget()
            bring_measured(self._state, criteria, factor(step), most_faces)
        return self._state.faces <= most_faces

    def _bring_view(
        self, view: NDArray[np.float64], limits: NDArray[np.float64], most_faces: int, most_splits: int | None
    ) -> None:
        state = self._state
        state.net.counts[LAST_IN_FIRST] = most_splits is None
        # Of the same view the rest is done: what was forced for edges not split yet is not to be undone.
        if not self._drift.is_still(view, limits):
            if not self._drift.move(view, limits, state.box()):
                state.net.faces["until"] = state.net.vertices["until"] = 0
            drift = self._drift.now
            begin = 0
            while (begin := int(kernels.review(state.net, begin, view, limits, drift))) < state.slots:
                state.grow()
            kernels.coarsen(state.net)
            kernels.enqueue_expired(state.net, drift)
        drift = self._drift.now
        most = _EVER if most_splits is None else int(state.net.counts[SPLITS]) + most_splits
        while kernels.refine(state.net, view, limits, drift, most, most_faces) == kernels.NO_ROOM:
            state.grow()

    def mesh(self, *, positions: Placing = "control") -> TriMesh:
        """The mesh as it is: faces in no particular order, counter-clockwise as those of the control mesh."""
        slots, net = self.slots(positions=positions), self._state.net
        is_face = net.faces["code"][: len(slots.faces)] != FREE_CODE
        is_used = net.vertices["flags"][: len(slots.positions)] & PRESENT != 0
        index = np.cumsum(is_used, dtype=np.int32) - 1
        return TriMesh(slots.positions[is_used], index[slots.faces[is_face]].astype(np.int32))

    def slots(self, *, positions: Placing = "control") -> Slots:
        """The mesh as it is, slot by slot: what did not change since the last time is where it was.

        Vertices that are kept but not in the mesh count as free.
        """
        placed = self._state.placed(positions == "limit")
        net = self._state.net
        faces = net.faces[: net.counts[FACES]]
        is_face = faces["code"] != FREE_CODE
        is_used = net.vertices["flags"][: len(placed)] & PRESENT != 0
        return Slots(
            np.ascontiguousarray(faces["corners"]),
            placed,
            np.where(is_used[:, None], net.vertices["born"][: len(placed)], 0.0),
            np.where(is_face, faces["code"] >> 2, 0).astype(np.uint8),
            np.where(is_face, _COLOURS[faces["code"] & 3], 0).astype(np.uint8),
        )

    @property
    def bytes_used(self) -> int:
        """What the arrays take for the slots in use, all told."""
        net = self._state.net
        return (
            int(net.counts[FACES]) * net.faces.itemsize
            + int(net.counts[VERTICES]) * net.vertices.itemsize
            + sum(a.nbytes for a in (net.table, net.base, net.counts))
        )


def rgb(
    mesh: TriMesh,
    camera: Camera | None = None,
    /,
    *,
    scheme: RgbScheme = "loop",
    criteria: Criteria | Measure | None = None,
    budget: int | None = None,
) -> TriMesh:
    """A mesh refined for one view, or by a function of edges; see `Rgb`, which follows a camera.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> from foveal.refine import by_length
    >>> len(rgb(tetrahedron(), criteria=by_length(0.5)).faces)
    16
    """
    refined = Rgb(mesh, scheme=scheme)
    refined.update(camera, criteria=criteria, budget=budget)
    return refined.mesh()
