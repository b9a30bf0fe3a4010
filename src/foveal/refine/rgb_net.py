"""The flat arrays of an RGB triangulation."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh

from ._kernels_rgb_layout import WORDS
from .cage import Cage
from .lines import in_lines

__all__ = ["BASE", "FACE", "MAX_BASE", "VERTEX", "RgbNet", "check_base"]

#: A face, in a cache line. `beside[k]` is the face beyond the edge from corner k to k + 1, `base` the control
#: mesh's triangle it lies in, `code` its colour and level, `until[k]` the word of drift (`_kernels_drift.py`)
#: up to which edge k is known not to be wanted split, or NEVER for an edge that this face need not ask,
#: `next` what follows in the queue. Of a free slot `beside[0]` is the next free one.
FACE = np.dtype(
    [
        ("until", np.int64, 3),
        ("corners", np.int32, 3),
        ("beside", np.int32, 3),
        ("base", np.int32),
        ("next", np.int32),
        ("code", np.uint8),
        ("is_queued", np.bool_),
    ],
    align=True,
)

#: A vertex, in the mesh or only computed, in two cache lines: where it was born, its limit; up to which word
#: of drift it is known whether the edge it splits meets the criteria; how far the normals are from its own of
#: the triangles it was born between; the level it was born on, FREE for slots not in use; how many splits
#: take it, and how many wanted ones of half edges; how much nearer to its limit it comes with each level; its
#: address, its normal, the ends and apexes of the edge it splits, one of its faces, when it was last used,
#: the next that may have to go, if it may. Of a free slot `diamond[0]` is the next one.
VERTEX = np.dtype(
    [
        ("born", np.float64, 3),
        ("limit", np.float64, 3),
        ("until", np.int64),
        ("spread", np.float32),
        ("birth", np.int8),
        ("flags", np.uint8),
        ("needed", np.uint8),
        ("halves", np.uint8),
        ("shrink", np.float64),
        ("key", np.int64),
        ("normal", np.float32, 3),
        ("diamond", np.int32, 4),
        ("around", np.int32),
        ("stamp", np.uint32),
        ("next", np.int32),
        ("is_doubtful", np.bool_),
    ],
    align=True,
)

#: A triangle of the control mesh; `mates[k]` is 3 g + h for the edge beyond edge k, which is h of triangle g,
#: NONE at the border.
BASE = np.dtype([("corners", np.int32, 3), ("mates", np.int32, 3)])

#: Triangles of a control mesh at most: addresses have 21 bits for them.
MAX_BASE = 1 << 21


class RgbNet(NamedTuple):
    """Faces of three vertices and three neighbours with a byte of colour and level; vertices by address.

    Slots are reused, so that what did not change stays where it is. The first slots are the control mesh's
    vertices and faces; its vertices stay there. `_kernels_rgb_layout.py` knows the packed words. What belongs
    together lies together: each array makes each call longer.

    Attributes
    ----------
    faces : (F,) FACE
    vertices : (V,) VERTEX
    table : (2^n,) int32
        Vertex slots by hashed address, EMPTY where there is none.
    base : (m,) BASE
    counts : (WORDS,) int64
    """

    faces: NDArray[Any]
    vertices: NDArray[Any]
    table: NDArray[np.int32]
    base: NDArray[Any]
    counts: NDArray[np.int64]

    @classmethod
    def empty(cls, faces: int, vertices: int, cage: Cage, /) -> "RgbNet":
        """Room for so many faces and vertices over a control mesh."""
        base = np.zeros(len(cage.faces), BASE)
        base["corners"], base["mates"] = cage.faces, _mates(cage)
        return cls(
            in_lines(faces, FACE),
            in_lines(vertices, VERTEX),
            _empty_table(vertices),
            base,
            np.zeros(WORDS, np.int64),
        )

    def grown(self, faces: int, vertices: int, /) -> "RgbNet":
        """The same with more room; the table is to be filled."""
        larger = self._replace(
            faces=in_lines(faces, FACE),
            vertices=in_lines(vertices, VERTEX),
            table=_empty_table(vertices),
        )
        for name in ("faces", "vertices"):
            old: NDArray[Any] = getattr(self, name)
            getattr(larger, name)[: len(old)] = old
        return larger


def _empty_table(vertices: int) -> NDArray[np.int32]:
    return np.full(1 << (2 * vertices - 1).bit_length(), -1, np.int32)


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
