"""The flat arrays of a √3 refinement."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._kernels_sqrt3_layout import FIRST, WORDS
from .lines import in_lines

__all__ = ["FACE", "VERTEX", "Net"]

#: A face. `until` is the word of drift (`_kernels_drift.py`) up to which it is known not to be wanted split,
#: `beside[k]` the face beyond the edge from corner k to k + 1, negative at a border or seam. Of a free slot
#: `beside[0]` is the next. (Words of drift in an array of their own: a refinement from nothing took a tenth
#: longer.)
FACE = np.dtype(
    [
        ("until", np.int64),
        ("corners", np.int32, 3),
        ("beside", np.int32, 3),
        ("state", np.int8),
        ("is_queued", np.bool_),
    ],
    align=True,
)

#: A vertex, in two cache lines: where it is at every level (`_kernels_sqrt3_points.py`), up to which word of
#: drift it is known whether its birth face meets the criteria, that face's corners, the other vertex born in
#: the same border edge, the one at the same place beyond a seam, one of its faces; one of those born in a
#: face that it is a parent of, and the next of each of its parents'; the next that may have to go, if it may.
#: Of a free slot `triple[0]` is the next.
VERTEX = np.dtype(
    [
        ("born", np.float64, 3),
        ("limit", np.float64, 3),
        ("third", np.float64, 3),
        ("until", np.int64),
        ("triple", np.int32, 3),
        ("pair", np.int32),
        ("twin", np.int32),
        ("around", np.int32),
        ("child", np.int32),
        ("siblings", np.int32, 3),
        ("next", np.int32),
        ("kind", np.uint8),
        ("is_doubtful", np.bool_),
    ],
    align=True,
)


class Net(NamedTuple):
    """Faces of three vertices and three neighbours, and vertices; no edges, no hierarchy.

    Slots are reused, so that what did not change stays where it is. `_kernels_sqrt3_layout.py` knows the
    packed words. What is read together lies together: one array a field instead took 1.2 times as long.

    Attributes
    ----------
    faces : (F,) FACE
    vertices : (V,) VERTEX
    births, flags : (V,) int8, uint8
        Apart, since every update reads all of them.
    normals : (V, 3) float32
        Of the limit surface.
    shrinks : (n,) float64
        Of the control mesh's vertices: how much nearer to their limit they come with each level.
    queue : (F,) int32
        A ring of faces that have to be asked whether they are wanted split.
    counts : (WORDS,) int64
    """

    faces: NDArray[Any]
    vertices: NDArray[Any]
    births: NDArray[np.int8]
    flags: NDArray[np.uint8]
    normals: NDArray[np.float32]
    shrinks: NDArray[np.float64]
    queue: NDArray[np.int32]
    counts: NDArray[np.int64]

    @classmethod
    def empty(cls, faces: int, vertices: int, base: int, /) -> "Net":
        """Room for so many faces and vertices, of a control mesh with `base` vertices."""
        return cls(
            in_lines(faces, FACE),
            in_lines(vertices, VERTEX),
            np.zeros(vertices, np.int8),
            np.zeros(vertices, np.uint8),
            np.zeros((vertices, 3), np.float32),
            np.zeros(base),
            np.zeros(faces, np.int32),
            np.zeros(WORDS, np.int64),
        )

    def grown(self, faces: int, vertices: int, /) -> "Net":
        """The same with more room; the queue begins at its array's beginning."""
        larger = Net.empty(faces, vertices, len(self.shrinks))
        for name in self._fields:
            old: NDArray[Any] = getattr(self, name)
            getattr(larger, name)[: len(old)] = old
        larger.queue[: len(self.queue)] = np.roll(self.queue, -int(self.counts[FIRST]))
        larger.counts[FIRST] = 0
        return larger
