"""A live refinement: follows the camera of one page, and says what changed.

It knows requests and messages, not how they travel: `ask` from anywhere, `answer` in a thread. One message
is on its way at most, and the newest request is the one that counts.
"""

import threading
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.mesh.shapes import tetrahedron
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .criteria import Criteria, Region
from .pace import Pace, coarser, factor
from .scheme import Scheme, refiner
from .wire import Buffers, Head, Request, buffers, message

__all__ = ["MOST_TRIANGLES", "Session", "origin_of", "warm"]

MOST_TRIANGLES = 2_000_000
"""The server's own limit: 400 MB of refinement and 60 MB for a first message."""

_SLICE_S, _LEAP_S = 0.05, 0.4  # how long finer thresholds are tried before what there is is shown
_SPLITS = 20_000  # between two looks at the clock and at the budget: about 20 ms
_LEAP = 0.25  # of the distance to the target: a camera that moved further is somewhere else


def origin_of(mesh: TriMesh, /) -> NDArray[np.float64]:
    """(3,): the middle of a control mesh's box, to which float32 positions are relative."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    return np.asarray(low * 0.5 + high * 0.5, np.float64)


class Session:
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
        self.origin = origin_of(mesh)
        extent = float(np.abs(mesh.positions - self.origin).max())
        if not extent < float(np.finfo(np.float32).max):
            raise FovealError(f"{name}: it is too large to be drawn. Scale it down.")
        self._refined = refiner(mesh, scheme=scheme, sharp=sharp, name=name)
        self._clock = clock
        self._lock = threading.Lock()
        self._newest: Request | None = None
        self._last: Request | None = None  # what the refinement stands at
        self._pace = Pace(least=len(mesh.faces), budget=MOST_TRIANGLES)
        self._is_whole = True  # whether the last update had nothing left to split
        self._faces, self._triangles = len(mesh.faces), 0
        self._work = 0  # triangles of all updates for one message
        self._sent = Buffers.empty()
        self._sequence = self._base = 0
        self._is_seen = True  # whether the last message was acknowledged

    def ask(self, request: Request, /) -> None:
        """Take a request in place of those before it.

        Raises
        ------
        FovealError
            If it acknowledges what was never sent.
        """
        with self._lock:
            if request.seen > self._sequence:
                raise FovealError(f"request: it has seen message {request.seen}, which was not sent.")
            self._newest = request
            self._is_seen |= request.seen == self._sequence

    def answer(self) -> bytes | None:
        """The next message, or None if there is none before another request. One call at a time."""
        with self._lock:
            request, is_seen = self._newest, self._is_seen
        if request is None:
            return None
        # Said before the first message was there, 0 asks for no second one.
        is_lost = request.seen == 0 and self._sequence > 0 and (is_seen or self._base > 0)
        if request.seen != self._sequence and not is_lost:
            return None  # the last message is on its way
        is_new = self._last is None or request.wanted != self._last.wanted
        is_done = not is_new and self._is_settled
        if is_done and not is_lost:
            return None
        begin, self._work = self._clock(), 0
        if not is_done:
            self._refine(request, begin, is_new=is_new)
        refined = self._clock()
        sent = self._message(request, 1000 * (refined - begin))
        if is_new and self._sequence > 1:
            spent = 1000 * (self._clock() - begin) / max(1, self._work)
            self._pace.spent(spent + request.drawn_ms / max(1, self._triangles))
        return sent

    def _refine(self, request: Request, begin: float, *, is_new: bool) -> None:
        """Bring the mesh to what is wanted, as near as the budget and a slice of time let it come."""
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

    def _message(self, request: Request, milliseconds: float) -> bytes:
        new = buffers(self._refined.slots(positions=request.positions), self.origin)
        is_anew = request.seen == 0 or len(new.faces) < len(self._sent.faces)
        self._base = 0 if is_anew else self._sequence
        head = Head(
            sequence=self._sequence + 1,
            base=self._base,
            is_settled=self._is_settled,
            is_limit=request.positions == "limit",
            triangles=self._triangles,
            milliseconds=milliseconds,
            threshold=factor(self._pace.step),
        )
        sent = message(head, new, Buffers.empty() if is_anew else self._sent)
        self._sent = new
        with self._lock:
            self._sequence, self._is_seen = head.sequence, False
        return sent


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
