"""The flat arrays of a √3 refinement."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Net"]


class Net(NamedTuple):
    """Faces of three vertices and three neighbours, and vertices; no edges, no hierarchy.

    Slots are reused, so that what did not change stays where it is. `_kernels_sqrt3_layout.py` knows the
    packed words, `_kernels_sqrt3_points.py` the vectors.

    Attributes
    ----------
    faces : (F, 3) int32
    beside : (F, 3) int32
        The face beyond the edge from corner k to k + 1.
    states : (F,) int8
    face_until : (F,) float64
        Up to which drift of the view a face is known not to be wanted split.
    points : (V, 3, 3) float64
        Where a vertex is at every level.
    normals : (V, 3) float32
        Of the limit surface.
    kinds, births, flags : (V,) uint8, int8, uint8
    triples : (V, 3) int32
        The corners of the face in which a vertex was born.
    pairs : (V,) int32
        The other vertex born in the same border edge.
    around : (V,) int32
        One of the faces at a vertex.
    vertex_until : (V,) float64
        Up to which drift it is known whether a vertex's birth face meets the criteria.
    shrinks : (n,) float64
        Of the control mesh's vertices: how much nearer to their limit they come with each level.
    counts : (4,) int64
        Face slots and vertex slots ever used, and how many of them are free.
    free_faces, free_vertices : (F,), (V,) int32
        Stacks of free slots.
    """

    faces: NDArray[np.int32]
    beside: NDArray[np.int32]
    states: NDArray[np.int8]
    face_until: NDArray[np.float64]
    points: NDArray[np.float64]
    normals: NDArray[np.float32]
    kinds: NDArray[np.uint8]
    births: NDArray[np.int8]
    flags: NDArray[np.uint8]
    triples: NDArray[np.int32]
    pairs: NDArray[np.int32]
    around: NDArray[np.int32]
    vertex_until: NDArray[np.float64]
    shrinks: NDArray[np.float64]
    counts: NDArray[np.int64]
    free_faces: NDArray[np.int32]
    free_vertices: NDArray[np.int32]

    @classmethod
    def empty(cls, faces: int, vertices: int, base: int, /) -> "Net":
        """Room for so many faces and vertices, of a control mesh with `base` vertices."""
        return cls(
            np.zeros((faces, 3), np.int32),
            np.zeros((faces, 3), np.int32),
            np.zeros(faces, np.int8),
            np.zeros(faces),
            np.zeros((vertices, 3, 3)),
            np.zeros((vertices, 3), np.float32),
            np.zeros(vertices, np.uint8),
            np.zeros(vertices, np.int8),
            np.zeros(vertices, np.uint8),
            np.full((vertices, 3), -1, np.int32),
            np.full(vertices, -1, np.int32),
            np.zeros(vertices, np.int32),
            np.zeros(vertices),
            np.zeros(base),
            np.zeros(4, np.int64),
            np.zeros(faces, np.int32),
            np.zeros(vertices, np.int32),
        )

    def grown(self, faces: int, vertices: int, /) -> "Net":
        """The same with more room."""
        larger = Net.empty(faces, vertices, len(self.shrinks))
        for name in self._fields:
            old: NDArray[Any] = getattr(self, name)
            getattr(larger, name)[: len(old)] = old
        return larger
