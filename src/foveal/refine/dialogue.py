"""What a live refinement and its page say to each other, whatever the scheme.

It knows requests and messages, not how they travel: `ask` from anywhere, `answer` in a thread. One message
is on its way at most, and the newest request is the one that counts.
"""

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh

from .wire import Buffers, Head, Ranges, Request, changes, message

__all__ = ["MOST_TRIANGLES", "Dialogue", "origin_of"]

MOST_TRIANGLES = 2_000_000
"""The server's own limit: 400 MB of refinement and 60 MB for a first message."""


def origin_of(mesh: TriMesh | PolyMesh, name: str = "mesh", /) -> NDArray[np.float64]:
    """(3,): the middle of a control mesh's box, to which float32 positions are relative.

    Raises
    ------
    FovealError
        If the box is too large for float32.
    """
    positions = mesh.positions
    low, high = positions.min(axis=0), positions.max(axis=0)
    origin = np.asarray(low * 0.5 + high * 0.5, np.float64)
    if not float(np.abs(positions - origin).max()) < float(np.finfo(np.float32).max):
        raise FovealError(f"{name}: it is too large to be drawn. Scale it down.")
    return origin


class Dialogue(ABC):
    """One page's part and ours. A scheme brings its mesh to what is wanted, and says what there is then."""

    has_normals = False
    has_colours = False

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._newest: Request | None = None
        self._last: Request | None = None  # what the refinement stands at
        self._triangles = 0
        self._sequence = self._base = 0
        self._is_seen = True  # whether the last message was acknowledged

    @property
    @abstractmethod
    def _is_settled(self) -> bool:
        """Whether nothing would change before another request."""

    @property
    def _threshold(self) -> float:
        """By how much edges wanted were multiplied."""
        return 1.0

    @abstractmethod
    def _refine(self, request: Request, begin: float, *, is_new: bool) -> None:
        """Bring the mesh to what is wanted, set what it stands at and how many triangles there are."""

    @abstractmethod
    def _buffers(self, request: Request) -> Buffers:
        """What the page is to have, good until the next update."""

    @abstractmethod
    def _changed(self, slots: Buffers) -> Sequence[Ranges] | None:
        """Where it may differ from what the last message brought; None if that does not lead there."""

    @abstractmethod
    def _spent(self, request: Request, milliseconds: float) -> None:
        """What an answer in a moving view took, beside what the page told."""

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
        begin = self._clock()
        if not is_done:
            self._refine(request, begin, is_new=is_new)
        refined = self._clock()
        sent = self._message(request, 1000 * (refined - begin))
        if is_new and self._sequence > 1:
            self._spent(request, 1000 * (self._clock() - begin))
        return sent

    def _message(self, request: Request, milliseconds: float) -> bytes:
        new = self._buffers(request)
        changed = self._changed(new)
        is_anew = request.seen == 0 or changed is None
        self._base = 0 if is_anew else self._sequence
        head = Head(
            sequence=self._sequence + 1,
            base=self._base,
            is_settled=self._is_settled,
            is_limit=request.positions == "limit" or self.has_normals,
            triangles=self._triangles,
            milliseconds=milliseconds,
            threshold=self._threshold,
            has_normals=self.has_normals,
            has_colours=self.has_colours,
        )
        whole = changes(new, Buffers.empty()) if changed is None or is_anew else changed
        sent = message(head, new, whole)
        with self._lock:
            self._sequence, self._is_seen = head.sequence, False
        return sent
