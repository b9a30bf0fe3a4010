"""A live refinement by √3 or RGB: follows the camera of one page, and says what changed."""

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from foveal.mesh.shapes import tetrahedron
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .criteria import Criteria, Region
from .dialogue import MOST_TRIANGLES, Dialogue, origin_of
from .pace import Pace, coarser, factor
from .scheme import Scheme, refiner
from .wire import Buffers, Ranges, Request, buffers, changes

__all__ = ["MOST_TRIANGLES", "Session", "origin_of", "warm"]

_SLICE_S, _LEAP_S = 0.05, 0.4  # how long finer thresholds are tried before what there is is shown
_SPLITS = 20_000  # between two looks at the clock and at the budget: about 20 ms
_LEAP = 0.25  # of the distance to the target: a camera that moved further is somewhere else


class Session(Dialogue):
    """A refinement of one control mesh for one page.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface.
    scheme : "sqrt3", "loop" or "butterfly"
    sharp : (k, 2) int, optional
        The vertices of edges that stay sharp; for √3.
    name : str
        What errors call the mesh.
    clock : function
        Gives seconds; for tests.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface, or too large for float32.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> session = Session(icosphere(1))
    >>> session.answer() is None  # nobody asked
    True
    """

    def __init__(
        self,
        mesh: TriMesh,
        /,
        *,
        scheme: Scheme = "sqrt3",
        sharp: ArrayLike | None = None,
        name: str = "mesh",
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        super().__init__(clock)
        self.origin = origin_of(mesh, name)
        self._refined = refiner(mesh, scheme=scheme, sharp=sharp, name=name)
        self._pace = Pace(least=len(mesh.faces), budget=MOST_TRIANGLES)
        self._is_whole = True  # whether the last update had nothing left to split
        self._faces = len(mesh.faces)
        self._work = 0  # triangles of all updates for one message
        self._sent = Buffers.empty()

    def _refine(self, request: Request, begin: float, *, is_new: bool) -> None:
        """Bring the mesh to what is wanted, as near as the budget and a slice of time let it come."""
        self._work = 0
        pace = self._pace
        is_leap = is_new and self._is_risky(request) and _is_leap(self._last, request)
        if is_new:
            pace.begin(request.criteria, budget=request.budget, rate=request.rate, is_leap=is_leap)
            self._last = request
        elif self._is_whole:
            pace.finer()
        slice_s = _LEAP_S if is_leap and self._sequence else _SLICE_S
        while True:
            criteria = coarser(request.criteria, pace.step)
            done = self._refined.update(request.camera, criteria=criteria, most_splits=_SPLITS)
            self._triangles, self._is_whole = done.faces, done.is_done
            self._work += done.faces
            is_late = self._clock() - begin > slice_s
            if not done.is_done and done.faces <= pace.budget:
                if is_late:
                    return
                continue
            pace.tell(done.faces)
            if not pace.is_fit:
                continue
            # In motion the step is as the last frame was; whether a finer one fits is tried at rest.
            is_enough = is_new and not (is_leap and pace.is_ample)
            if is_late or pace.is_settled or is_enough:
                return
            pace.finer(is_moving=is_new)

    @property
    def _is_settled(self) -> bool:
        return self._is_whole and self._pace.is_settled

    def _is_risky(self, request: Request) -> bool:
        """Whether a step for another view could give far more than the budget, and take as long."""
        criteria = request.criteria
        most = max(r.iterations for r in (criteria.front, criteria.silhouette, criteria.back))
        allowed = min(request.budget or MOST_TRIANGLES, MOST_TRIANGLES)
        return self._faces << 2 * most > 4 * allowed  # an iteration is at most four triangles for one

    @property
    def _threshold(self) -> float:
        return factor(self._pace.step)

    def _buffers(self, request: Request) -> Buffers:
        return buffers(self._refined.slots(positions=request.positions), self.origin)

    def _changed(self, slots: Buffers) -> list[Ranges] | None:
        before, self._sent = self._sent, slots
        is_shorter = any(len(now) < len(was) for now, was in zip(slots, before, strict=True))
        return None if is_shorter else changes(slots, before)

    def _spent(self, request: Request, milliseconds: float) -> None:
        spent = milliseconds / max(1, self._work)
        self._pace.spent(spent + request.drawn_ms / max(1, self._triangles))


def warm(scheme: Scheme, /) -> None:
    """Compile what a session runs, or load it, so that no page waits for it: 40 s the first time."""
    refined = refiner(tetrahedron(), scheme=scheme)
    camera = Camera.of([3, 4, 5], [0, 0, 0])
    for iterations in (3, 0):
        region = Region(iterations, 1e-3, 1e-3)
        refined.update(camera, criteria=Criteria(region, region, region))
        refined.slots(positions="limit")


def _is_leap(last: Request | None, request: Request) -> bool:
    """Whether what the last view had refined says little of what this one will."""
    if last is None or request.criteria != last.criteria:
        return True
    camera, before = request.camera, last.camera
    away = float(np.linalg.norm(camera.position - camera.target))
    moved = np.linalg.norm(camera.position - before.position) + np.linalg.norm(camera.target - before.target)
    return float(moved) > _LEAP * away
