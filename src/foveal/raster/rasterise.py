"""Which triangle each pixel sees, how deep, and where on it.

Bands of rows are drawn on their own, each by one thread, so the result has the same bits whatever the
number of threads. Neighbouring triangles share every sample of their edge in the sense that exactly one
of them covers it: no gaps, no overlaps.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.base.tasks import Executor, ordered_map, threads_unless
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels as kernels
from . import _kernels_clip as clipping
from . import _kernels_shade as shading

__all__ = ["AHEAD", "BAND_ROWS", "MOST_PIXELS", "GBuffer", "Screen", "rasterise", "run_all"]

BAND_ROWS = 64
"""Rows drawn at a time: at 1280 columns their depths fit a processor's second cache."""
MOST_PIXELS = 1 << 15
"""Of a picture's width or height, after supersampling."""
AHEAD = 64
"""Tasks in flight at once: more than there are processors, and memory for few."""
_CHUNK = 1 << 17  # vertices or faces a task
_GUARD = kernels.LIMIT / kernels.STEPS / 2  # pixels from the middle beyond which triangles are clipped

R = TypeVar("R")


@dataclass(frozen=True)
class GBuffer:
    """What each pixel sees, row by row from the top.

    Later kinds of result (layers of depth, lists of fragments) will be classes beside this one, made
    from the same `Screen`.

    Attributes
    ----------
    depth : (height, width) float32
        Distance from the eye along the viewing direction, in the unit of the scene; infinite where
        nothing is seen.
    face_ids : (height, width) int32
        The visible face, -1 where there is none. Of equally deep ones the lowest.
    weights : (height, width, 3) float32
        How much each corner of the face counts, perspective-correct: from 0, sum 1; all 0 where there
        is no face.
    """

    depth: NDArray[np.float32]
    face_ids: NDArray[np.int32]
    weights: NDArray[np.float32]


class Screen:
    """Triangles placed on a camera's picture and sorted into bands of rows, ready to be drawn.

    Parameters
    ----------
    positions, faces : (n, 3) float64, (m, 3) int32
        Contiguous; not copied.
    camera : Camera
        Faces are drawn from both sides, where they are between its near and far distance.
    executor : Executor
        Runs the tasks; what it gives does not depend on how many at once.

    Raises
    ------
    FovealError
        If the picture is wider or higher than `MOST_PIXELS`.
    """

    def __init__(
        self,
        positions: NDArray[np.float64],
        faces: NDArray[np.int32],
        camera: Camera,
        /,
        *,
        executor: Executor,
    ) -> None:
        if max(camera.width, camera.height) > MOST_PIXELS:
            raise FovealError(
                f"camera: a picture of {camera.width} x {camera.height} samples is too large; "
                f"stay within {MOST_PIXELS} either way."
            )
        # One signature of the kernels only: arrays from a file may be read-only.
        positions = np.require(positions, np.float64, ["C_CONTIGUOUS", "WRITEABLE"])
        self.camera, self.faces = camera, np.require(faces, np.int32, ["C_CONTIGUOUS", "WRITEABLE"])
        self.lens = (camera.pixels_per_radian(), camera.width, camera.height, float(camera.near))
        self._slope = _GUARD / self.lens[0]
        count = len(positions)
        self.seen = np.empty((count, 3))
        self._places, self._nearness = np.zeros((count, 2), dtype=np.int32), np.empty(count)
        eye, basis = camera.position, camera.basis()
        placed = (self.seen, self._places, self._nearness)

        def project(part: tuple[int, int]) -> None:
            kernels.project(positions, eye, basis, self.lens, self._slope, *part, *placed)

        def find_bands(part: tuple[int, int]) -> None:
            kernels.find_bands(self.faces, *placed, self.lens, BAND_ROWS, *part, bands)

        run_all(executor, project, _chunks(count))
        bands = np.empty((len(faces), 2), dtype=np.int32)
        run_all(executor, find_bands, _chunks(len(faces)))
        self._first, self._entries, clipped = _listed(bands, self.bands)
        self._cut(clipped)

    @property
    def bands(self) -> int:
        """How many bands the picture has; band i begins at row `i * BAND_ROWS`."""
        return -(-self.camera.height // BAND_ROWS)

    def draw(self, band: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        """1 / depth and face of each pixel of a band; 1 / far and -1 where nothing is seen."""
        top = band * BAND_ROWS
        shape = (min(BAND_ROWS, self.camera.height - top), self.camera.width)
        nearest = np.full(shape, 1 / self.camera.far)
        face_ids = np.full(shape, -1, dtype=np.int32)
        target = (self.camera.width, top, nearest, face_ids)
        whole = self._entries[self._first[band] : self._first[band + 1]]
        no_names = np.empty(0, dtype=np.int32)
        kernels.fill(whole, self.faces, no_names, self._places, self._nearness, *target)
        kernels.fill(
            np.arange(len(self._pieces), dtype=np.int32),
            *(self._pieces, self._piece_names, self._piece_places, self._piece_nearness, *target),
        )
        return nearest, face_ids

    def weigh(self, band: int, face_ids: NDArray[np.int32], /) -> NDArray[np.float32]:
        """Weights of the corners at each pixel of a band, as in `GBuffer`."""
        weights = np.empty((*face_ids.shape, 3), dtype=np.float32)
        shading.weigh(face_ids, band * BAND_ROWS, self.faces, self.seen, self.lens, weights)
        return weights

    def _cut(self, clipped: NDArray[np.int32]) -> None:
        most = clipping.MOST_CORNERS * len(clipped)
        self._piece_places, self._piece_nearness = np.zeros((most, 2), dtype=np.int32), np.empty(most)
        pieces, names = np.empty((most, 3), dtype=np.int32), np.empty(most, dtype=np.int32)
        found = clipping.clip(
            *(clipped, self.faces, self.seen, self.lens, self._slope),
            *(self._piece_places, self._piece_nearness, pieces, names),
        )
        self._pieces, self._piece_names = pieces[:found], names[:found]


def _listed(
    bands: NDArray[np.int32], count: int
) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32]]:
    """Where each band's faces begin, the faces, and those to be clipped."""
    counts = np.zeros(count + 1, dtype=np.int64)
    clipped = np.empty(kernels.count_bands(bands, counts), dtype=np.int32)
    first = np.cumsum(counts)
    entries = np.empty(first[-1], dtype=np.int32)
    kernels.list_bands(bands, first[:-1].copy(), entries, clipped)
    return first, entries, clipped


def _chunks(count: int) -> list[tuple[int, int]]:
    return [(start, min(start + _CHUNK, count)) for start in range(0, count, _CHUNK)]


def run_all(executor: Executor, task: Callable[[Any], R], items: Iterable[Any], /) -> list[R]:
    """`task` of each item, in order."""
    return list(ordered_map(executor, task, items, ahead=AHEAD))


def rasterise(
    positions: ArrayLike, faces: ArrayLike, camera: Camera, /, *, executor: Executor | None = None
) -> GBuffer:
    """Draw triangles into a G-buffer.

    Parameters
    ----------
    positions : (n, 3) float
        In the unit and axes of the camera. Large coordinates do not jitter: the eye is subtracted first.
    faces : (m, 3) int
        Indices in [0, n), drawn from both sides. Any triangles: degenerate, huge, behind the eye.
    camera : Camera
        Its size is the picture's. The sample of a pixel is its middle.
    executor : Executor, optional
        Local threads by default. The result does not depend on it.

    Returns
    -------
    GBuffer

    Raises
    ------
    FovealError
        If the arrays are no mesh, or the picture is larger than `MOST_PIXELS` either way.

    References
    ----------
    Pineda, J. (1988). A parallel algorithm for polygon rasterization. SIGGRAPH, 17-20.

    Examples
    --------
    >>> camera = Camera.of([0, 0, 2], [0, 0, 0], field_of_view=np.pi / 2, width=4, height=4)
    >>> square = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    >>> rasterise(square, [[0, 1, 3], [1, 2, 3]], camera).face_ids  # samples on the diagonal count once
    array([[-1, -1, -1, -1],
           [-1,  1,  1, -1],
           [-1,  0,  1, -1],
           [-1, -1, -1, -1]], dtype=int32)
    """
    mesh = TriMesh.of(positions, faces)
    shape = (camera.height, camera.width)
    depth, face_ids = np.empty(shape, dtype=np.float32), np.empty(shape, dtype=np.int32)
    weights = np.empty((*shape, 3), dtype=np.float32)

    def draw(band: int) -> None:
        rows = slice(band * BAND_ROWS, (band + 1) * BAND_ROWS)
        nearest, face_ids[rows] = screen.draw(band)
        depth[rows] = np.where(face_ids[rows] >= 0, 1 / nearest, np.inf)
        weights[rows] = screen.weigh(band, face_ids[rows])

    with threads_unless(executor) as pool:
        screen = Screen(mesh.positions, mesh.faces, camera, executor=pool)
        run_all(pool, draw, range(screen.bands))
    return GBuffer(depth, face_ids, weights)
