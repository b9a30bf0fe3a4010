"""The flat arrays of an RGB triangulation."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh

from .cage import Cage

__all__ = ["FACE", "MAX_BASE", "VERTEX", "RgbNet", "check_base"]

#: A face. `beside[k]` is the face beyond the edge from corner k to k + 1, `base` the control mesh's triangle
#: it lies in, `code` its colour and level, `until[k]` the drift of the view up to which edge k is known not
#: to be wanted split, or infinity for an edge that this face need not ask. Of a free slot `beside[0]` is the
#: next one.
FACE = np.dtype(
    [
        ("corners", np.int32, 3),
        ("beside", np.int32, 3),
        ("until", np.float64, 3),
        ("base", np.int32),
        ("code", np.uint8),
        ("is_queued", np.bool_),
    ],
    align=True,
)

#: A vertex, in the mesh or only computed: its address, where it was born, its limit, the normal and spread of
#: the triangles it was born between, the ends and apexes of the edge it splits, one of its faces, up to which
#: drift it is known whether that edge meets the criteria, and when it was last used. Of a free slot
#: `diamond[0]` is the next one.
VERTEX = np.dtype(
    [
        ("born", np.float64, 3),
        ("limit", np.float64, 3),
        ("key", np.int64),
        ("until", np.float64),
        ("diamond", np.int32, 4),
        ("around", np.int32),
        ("stamp", np.uint32),
        ("normal", np.float32, 3),
        ("spread", np.float32),
    ],
    align=True,
)

#: Triangles of a control mesh at most: addresses have 21 bits for them.
MAX_BASE = 1 << 21


class RgbNet(NamedTuple):
    """Faces of three vertices and three neighbours with a byte of colour and level; vertices by address.

    Slots are reused, so that what did not change stays where it is. The first slots are the control mesh's
    vertices and faces; its vertices stay there. `_kernels_rgb_layout.py` knows the packed words.

    Attributes
    ----------
    faces : (F,) FACE
    vertices : (V,) VERTEX
    births : (V,) int8
        The level a vertex was born on; FREE for slots not in use.
    flags : (V,) uint8
    table : (2^n,) int32
        Vertex slots by hashed address, EMPTY where there is none.
    cage : (m, 3) int32
        The control mesh's triangles.
    mates : (m, 3) int32
        3 g + h for the edge beyond edge k: h of triangle g; NONE at the border.
    shrinks : (n,) float64
        How much nearer to their limit the control mesh's vertices come with each level.
    stack : (S,) int64
        What is being computed for something else.
    chain : (C, 2) int32
        Edges being split, each for the one before.
    queue : (F,) int32
        A ring of faces whose edges have to be asked.
    box : (2, 3) float64
        Corners of the least box around all that was computed yet.
    counts : (16,) int64
    """

    faces: NDArray[Any]
    vertices: NDArray[Any]
    births: NDArray[np.int8]
    flags: NDArray[np.uint8]
    table: NDArray[np.int32]
    cage: NDArray[np.int32]
    mates: NDArray[np.int32]
    shrinks: NDArray[np.float64]
    stack: NDArray[np.int64]
    chain: NDArray[np.int32]
    queue: NDArray[np.int32]
    box: NDArray[np.float64]
    counts: NDArray[np.int64]

    @classmethod
    def empty(cls, faces: int, vertices: int, cage: Cage, /) -> "RgbNet":
        """Room for so many faces and vertices over a control mesh."""
        slots = 1 << (2 * vertices - 1).bit_length()
        return cls(
            np.zeros(faces, FACE),
            np.zeros(vertices, VERTEX),
            np.full(vertices, -1, np.int8),
            np.zeros(vertices, np.uint8),
            np.full(slots, -1, np.int32),
            cage.faces,
            _mates(cage),
            np.zeros(len(cage.positions)),
            np.zeros(4096, np.int64),
            np.zeros((256, 2), np.int32),
            np.zeros(faces, np.int32),
            np.stack([cage.positions.min(axis=0), cage.positions.max(axis=0)]),
            np.zeros(16, np.int64),
        )

    def grown(self, faces: int, vertices: int, /) -> "RgbNet":
        """The same with more room; the queue begins at its array's beginning, the table is to be filled."""
        slots = 1 << (2 * vertices - 1).bit_length()
        larger = self._replace(
            faces=np.zeros(faces, FACE),
            vertices=np.zeros(vertices, VERTEX),
            births=np.full(vertices, -1, np.int8),
            flags=np.zeros(vertices, np.uint8),
            table=np.full(slots, -1, np.int32),
            queue=np.zeros(faces, np.int32),
        )
        for name in ("faces", "vertices", "births", "flags"):
            old: NDArray[Any] = getattr(self, name)
            getattr(larger, name)[: len(old)] = old
        larger.queue[: len(self.queue)] = np.roll(self.queue, -int(self.counts[4]))
        larger.counts[4] = 0
        return larger


def _mates(cage: Cage) -> NDArray[np.int32]:
    """Two triangles may share several edges, so an edge's other side is the one with its ends."""
    faces = cage.faces
    mates = np.full((len(faces), 3), -1, np.int32)
    for k in range(3):
        for h in range(3):
            g = cage.beside[:, k]
            is_mate = (
                (g >= 0) & (faces[g, h] == faces[:, (k + 1) % 3]) & (faces[g, (h + 1) % 3] == faces[:, k])
            )
            mates[is_mate, k] = 3 * g[is_mate] + h
    return mates


def check_base(mesh: TriMesh, name: str) -> None:
    """Refuse a control mesh with more triangles than addresses have room for."""
    if len(mesh.faces) > MAX_BASE:
        raise FovealError(
            f"{name}: {len(mesh.faces)} triangles are too many for a control mesh, of which there may be "
            f"{MAX_BASE}. Simplify it first, or `build` it as it is."
        )
