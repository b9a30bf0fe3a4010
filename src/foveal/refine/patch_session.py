"""A live tessellation of Catmull-Clark patches: follows the camera of one page, and says what changed."""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.poly_shapes import cube
from foveal.mesh.polymesh import PolyMesh
from foveal.view.camera import Camera

from ._kernels_wire import pack_colours
from .dialogue import MOST_TRIANGLES, Dialogue, origin_of
from .slates import Slates
from .slates_arena import ranges
from .slates_depth import Depths
from .slates_rate import FrameRate
from .slates_result import SlateArrays
from .wire import Buffers, Head, Ranges, Request, message

__all__ = ["PatchSession", "changed_words", "patch_buffers", "warm_patches"]

# Points are kept as deep as they were ever wanted, for all that a page ever looked at. From here on they are
# forgotten, and all is sent anew: 72 MB.
_MOST_ROWS = 3_000_000


class PatchSession(Dialogue):
    """A tessellation of one control mesh for one page, at limit points with limit normals.

    Parameters
    ----------
    mesh : PolyMesh
        An oriented surface.
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
    >>> session = PatchSession(cube())
    >>> session.answer() is None  # nobody asked
    True
    """

    has_normals = True

    def __init__(
        self,
        mesh: PolyMesh,
        /,
        *,
        name: str = "mesh",
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        super().__init__(clock)
        checked = mesh.checked(name)
        self.origin = origin_of(checked, name)
        # About its own middle, so that rows are what is sent.
        positions = checked.positions - self.origin
        self._mesh, self._name = replace(checked, positions=positions, uvs=None), name
        self.has_colours = checked.colours is not None
        self._surface = self._begun()
        self._most_rows = 0
        self._rate: tuple[float, FrameRate] | None = None

    def _begun(self) -> Slates:
        self._is_fresh = True
        self._colours = np.zeros(0, np.uint32)
        return Slates(self._mesh, dtype=np.float32, workers=None, name=self._name)

    @property
    def _is_settled(self) -> bool:
        return self._last is not None  # each update brings all

    def _refine(self, request: Request, begin: float, *, is_new: bool) -> None:
        if len(self._surface.arrays().positions) > self._most_rows:
            self._surface = self._begun()
            self._most_rows = 0
        camera = request.camera
        moved = replace(camera, position=camera.position - self.origin, target=camera.target - self.origin)
        done = self._surface.update(moved, depths=request.depths, budget=self._budget(request))
        if self.has_colours:
            self._colours = packed_colours(self._surface, self._colours)
        if self._most_rows == 0:  # what one view needs may be more already
            self._most_rows = max(_MOST_ROWS, 2 * len(self._surface.arrays().positions))
        self._last, self._triangles = request, done.triangles

    def _budget(self, request: Request) -> int:
        """Triangles at most: what was asked for, what we allow, and what keeps to the rate."""
        allowed = min(request.budget or MOST_TRIANGLES, MOST_TRIANGLES)
        if not request.rate:
            self._rate = None
            return allowed
        if self._rate is None or self._rate[0] != request.rate:
            least = 2 * self._surface.patches
            self._rate = request.rate, FrameRate(request.rate, least=least, most=MOST_TRIANGLES)
        return min(allowed, self._rate[1].budget)

    def _spent(self, request: Request, milliseconds: float) -> None:
        if self._rate is not None:
            self._rate[1].tell(milliseconds + request.drawn_ms, self._triangles)

    def _buffers(self, request: Request) -> Buffers:
        return patch_buffers(self._surface.arrays(), self._colours)

    def _changed(self, slots: Buffers) -> list[Ranges] | None:
        is_fresh, self._is_fresh = self._is_fresh, False
        return None if is_fresh else changed_words(self._surface, has_colours=self.has_colours)


def patch_buffers(arrays: SlateArrays, colours: NDArray[np.uint32], /) -> Buffers:
    """What a page is to have, the arrays themselves as words: normals where starts are, depths as levels."""
    faces, positions, normals, levels = (
        values.reshape(-1).view(np.uint32)
        for values in (arrays.faces, arrays.positions, arrays.normals, arrays.levels)
    )
    return Buffers(faces, positions, normals, levels, colours[: len(arrays.positions)])


def changed_words(surface: Slates, /, *, has_colours: bool) -> list[Ranges]:
    """Which words of these its last update wrote."""
    rows, faces = surface.changed()
    levels = ranges(faces[:, 0] // 4, -(-faces[:, 1] // 4) - faces[:, 0] // 4)
    return [3 * faces, 3 * rows, 3 * rows, levels, rows if has_colours else rows[:0]]


def packed_colours(surface: Slates, before: NDArray[np.uint32], /) -> NDArray[np.uint32]:
    """Colours of all rows as words, of those before the last update."""
    colours = surface.arrays().columns[0]
    words = before
    if len(before) < len(colours):  # by a half more, as the rows grow
        words = np.zeros(max(len(colours), len(before) * 3 // 2), np.uint32)
        words[: len(before)] = before
    pack_colours(colours, surface.changed()[0], words)
    return words


def warm_patches() -> None:
    """Compile what a session runs, or load it, so that no page waits for it."""
    mesh = replace(cube(), colours=np.zeros((8, 3), np.float32))
    surface = Slates(mesh, dtype=np.float32)
    camera = Camera.of([3, 4, 5], [0, 0, 0])
    for budget in (200, 2000):
        surface.update(camera, depths=Depths(), budget=budget)
    colours = packed_colours(surface, np.zeros(0, np.uint32))
    head, slots = Head(1, 0, True, True, 0, 0.0, 1.0), patch_buffers(surface.arrays(), colours)
    message(head, slots, changed_words(surface, has_colours=True))
