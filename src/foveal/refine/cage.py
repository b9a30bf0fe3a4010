"""The control mesh of a refinement: an oriented surface with its border, cut open along sharp edges."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh

__all__ = ["Cage"]


@dataclass(frozen=True, slots=True)
class Cage:
    """A triangle mesh on which each edge has one or two faces and each vertex one fan.

    Along sharp edges it is cut open: each sector of a vertex's fan between them has a vertex of its own. A
    vertex on two of them (a border edge counts as one) is on a crease; on one, where a crease ends, and on
    more it is a corner.

    Attributes
    ----------
    positions : (n, 3) float64
        Of the mesh's vertices, then of the further ones that sharp edges ask for.
    faces : (m, 3) int32
        Oriented alike.
    beside : (m, 3) int32
        The face beyond the edge from corner k to k + 1, -1 at the border, -2 - (3 g + j) at a sharp edge
        beyond which is edge j of face g.
    starts, ring : (n + 1,) int32, (3 m + border vertices,) int32
        ring[starts[v]:starts[v + 1]] are the neighbours of v, counter-clockwise: of an inner vertex beginning
        with the least, of a border vertex from its next to its previous border vertex.
    is_border, is_corner : (n,) bool
        Sharp edges are borders.
    origins : (n,) int32
        Which vertex of the mesh it is.
    twins : (n,) int32
        The vertex on the other side of a crease, or -1.
    """

    positions: NDArray[np.float64]
    faces: NDArray[np.int32]
    beside: NDArray[np.int32]
    starts: NDArray[np.int32]
    ring: NDArray[np.int32]
    is_border: NDArray[np.bool_]
    is_corner: NDArray[np.bool_]
    origins: NDArray[np.int32]
    twins: NDArray[np.int32]

    @classmethod
    def of(cls, mesh: TriMesh, /, *, sharp: ArrayLike | None = None, name: str = "mesh") -> "Cage":
        """Check that a mesh is a surface, and cut it open along its sharp edges.

        Parameters
        ----------
        mesh : TriMesh
        sharp : (k, 2) int, optional
            The vertices of the sharp edges, in any order. One on the border changes nothing.
        name : str
            What errors call the mesh.

        Raises
        ------
        FovealError
            In a sentence that names the edge or vertex: a triangle with a repeated corner, an edge of three
            triangles or of two that run the same way, a vertex at which two fans touch, a sharp edge that is
            none.
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
        mates = np.full(3 * len(faces), -1, np.int32)
        first, second = order[:-1][same], order[1:][same]
        mates[first], mates[second] = second, first
        beside = (mates // 3).reshape(-1, 3)  # -1 // 3 is -1
        starts, ring, is_border = _rings(name, faces, beside, count)
        if sharp is not None:
            is_seam = _seams(name, np.asarray(sharp), lower, upper, count) & (mates >= 0)
            if is_seam.any():
                beside = np.where(is_seam, -2 - mates, mates // 3).reshape(-1, 3).astype(np.int32)
                return _cut_open(mesh, beside, name)
        no_twins = np.full(count, -1, np.int32)
        origins = np.arange(count, dtype=np.int32)
        is_corner = np.zeros(count, np.bool_)
        return cls(mesh.positions, faces, beside, starts, ring, is_border, is_corner, origins, no_twins)


def _seams(
    name: str, sharp: NDArray[Any], lower: NDArray[np.int64], upper: NDArray[np.int64], count: int
) -> NDArray[np.bool_]:
    """(3 m,): which half-edges are sharp."""
    if sharp.size == 0:
        return np.zeros(len(lower), np.bool_)
    if sharp.ndim != 2 or sharp.shape[1] != 2 or sharp.dtype.kind not in "iu":
        raise ValueError(f"sharp must be pairs of vertices, (k, 2) int, got {sharp.shape} {sharp.dtype}")
    pairs = np.sort(sharp.astype(np.int64), axis=1)
    edges, wanted = lower * count + upper, pairs[:, 0] * count + pairs[:, 1]
    is_edge = np.isin(wanted, edges) & (pairs[:, 0] >= 0) & (pairs[:, 1] < count)
    if not is_edge.all():
        a, b = sharp[int(is_edge.argmin())]
        raise FovealError(
            f"{name}: there is no edge between vertices {a} and {b} that could be sharp. "
            "Name the two vertices of a triangle's edge."
        )
    return np.isin(edges, wanted)


def _cut_open(mesh: TriMesh, beside: NDArray[np.int32], name: str) -> Cage:
    from . import _kernels_cage as kernels

    count = len(mesh.positions)
    origins = np.full(count + 3 * len(mesh.faces), -1, np.int32)
    faces = mesh.faces.copy()
    total = int(kernels.sectors(mesh.faces, beside, count, faces, origins))
    origins[:count] = np.arange(count)
    origins = origins[:total]
    # An edge that ends at a vertex begins there on its other side, but for one on the border.
    begins, is_last = mesh.faces[beside < 0], beside == -1
    ends = np.roll(mesh.faces, -1, axis=1)[is_last]
    edges = np.bincount(begins, minlength=count) + np.bincount(ends, minlength=count)
    is_corner = ((edges != 0) & (edges != 2))[origins]
    twins = np.full(total, -1, np.int32)
    further = np.arange(count, total, dtype=np.int32)
    further = further[~is_corner[count:]]
    twins[further], twins[origins[further]] = origins[further], further
    starts, ring, is_border = _rings(name, faces, beside, total)
    return Cage(mesh.positions[origins], faces, beside, starts, ring, is_border, is_corner, origins, twins)


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
