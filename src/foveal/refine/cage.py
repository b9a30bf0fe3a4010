"""The control mesh of a refinement: an oriented surface, with its half-edges and border."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh

__all__ = ["Cage"]


@dataclass(frozen=True, slots=True)
class Cage:
    """A triangle mesh on which each edge has one or two faces and each vertex one fan.

    Attributes
    ----------
    positions : (n, 3) float64
    faces : (m, 3) int32
        Oriented alike.
    beside : (m, 3) int32
        The face beyond the edge from corner k to k + 1, -1 at the border.
    starts, ring : (n + 1,) int32, (3 m + border vertices,) int32
        ring[starts[v]:starts[v + 1]] are the neighbours of v, counter-clockwise: of an inner vertex beginning
        with the least, of a border vertex from its next to its previous border vertex.
    is_border : (n,) bool
    """

    positions: NDArray[np.float64]
    faces: NDArray[np.int32]
    beside: NDArray[np.int32]
    starts: NDArray[np.int32]
    ring: NDArray[np.int32]
    is_border: NDArray[np.bool_]

    @classmethod
    def of(cls, mesh: TriMesh, /, *, name: str = "mesh") -> "Cage":
        """Check that a mesh is a surface.

        Raises
        ------
        FovealError
            In a sentence that names the edge or vertex: a triangle with a repeated corner, an edge of three
            triangles or of two that run the same way, a vertex at which two fans touch.
        """
        faces, count = mesh.faces, len(mesh.positions)
        begin, end = (
            faces.reshape(-1).astype(np.int64),
            np.roll(faces, -1, axis=1).reshape(-1).astype(np.int64),
        )
        if (begin == end).any():
            face = int((begin == end).argmax()) // 3
            raise FovealError(
                f"{name}: triangle {face} has the same vertex twice. Remove it, or `repair` the mesh."
            )
        lower, upper = np.minimum(begin, end), np.maximum(begin, end)
        order = np.lexsort((lower, upper))
        same = (lower[order][1:] == lower[order][:-1]) & (upper[order][1:] == upper[order][:-1])
        _refuse_edges(name, order, same, begin, end)
        flat = np.full(3 * len(faces), -1, np.int32)
        first, second = order[:-1][same], order[1:][same]
        flat[first], flat[second] = second // 3, first // 3
        beside = flat.reshape(-1, 3)
        starts, ring, is_border = _rings(name, faces, beside, count)
        return cls(mesh.positions, faces, beside, starts, ring, is_border)


def _refuse_edges(
    name: str,
    order: NDArray[np.int64],
    same: NDArray[np.bool_],
    begin: NDArray[np.int64],
    end: NDArray[np.int64],
) -> None:
    if (same[1:] & same[:-1]).any():
        i = order[int((same[1:] & same[:-1]).argmax())]
        raise FovealError(
            f"{name}: the edge between vertices {begin[i]} and {end[i]} has more than two triangles, so "
            "there is no surface to refine. Split the mesh there."
        )
    alike = same & (begin[order][1:] == begin[order][:-1])
    if alike.any():
        i = order[int(alike.argmax())]
        raise FovealError(
            f"{name}: the two triangles at the edge between vertices {begin[i]} and {end[i]} face opposite "
            "sides. Orient the mesh's triangles alike."
        )


def _rings(
    name: str, faces: NDArray[np.int32], beside: NDArray[np.int32], count: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.bool_]]:
    from . import _kernels_cage as kernels

    fans = np.bincount(faces.reshape(-1), minlength=count)
    is_border = np.zeros(count, np.bool_)
    starts = np.zeros(count + 1, np.int32)
    first = np.empty(count, np.int32)
    kernels.first_faces(faces, beside, first, is_border)
    np.cumsum(fans + is_border, out=starts[1:])
    ring = np.empty(int(starts[-1]), np.int32)
    wrong = int(kernels.rings(faces, beside, first, is_border, starts, ring))
    if wrong >= 0:
        raise FovealError(
            f"{name}: at vertex {wrong} several fans of triangles touch, so there is no surface to refine. "
            "Give each fan a vertex of its own."
        )
    return starts, ring, is_border
