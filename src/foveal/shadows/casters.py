"""What casts: triangles of all meshes over shared corners, and which of them close a solid."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from foveal.mesh.trimesh import TriMesh

__all__ = ["Casters", "casters_of", "winding_number"]


class Casters(NamedTuple):
    """Triangles that cast, whatever the light.

    Attributes
    ----------
    positions : (n, 3) float64
        No two alike.
    faces : (m, 3) int32
        Of three corners each.
    edges : (m, 3) int32
        Number of the edge after each corner, from 1; negative where the face runs it from the higher to the
        lower corner.
    is_closed : (m,) bool
        Whether the face is of a part that encloses: along each of its edges as many faces run one way as the
        other, so every line enters it as often as it leaves. A face that is there from both sides is a sheet:
        without both, edges are as even as before.
    edge_count : int
        The largest number of an edge.
    """

    positions: NDArray[np.float64]
    faces: NDArray[np.int32]
    edges: NDArray[np.int32]
    is_closed: NDArray[np.bool_]
    edge_count: int


def casters_of(meshes: list[TriMesh], /) -> Casters:
    """Join meshes, make corners at one place one, and find the parts that are closed.

    Parts are what hangs together by edges; a mesh of thousands of pieces has closed ones beside open ones.
    """
    positions, faces = _welded(meshes)
    is_face = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    faces = np.ascontiguousarray(faces[is_face])
    edges = _numbered_edges(faces, len(positions))
    number = np.abs(edges).astype(np.int64) - 1
    count = int(number.max(initial=-1)) + 1
    is_even = np.bincount(number.ravel(), np.sign(edges).ravel(), count) == 0
    is_closed = _closed_parts(number, is_even)
    same, is_from_both_sides = _alike(faces)
    is_closed &= ~is_from_both_sides
    # One of a sheet's faces is enough: as two layers they would be looked at pixel by pixel.
    kept = is_closed.copy()
    sheets = np.flatnonzero(~is_closed)
    kept[sheets[np.unique(same[sheets], return_index=True)[1]]] = True
    return Casters(
        positions,
        np.ascontiguousarray(faces[kept]),
        np.ascontiguousarray(edges[kept]),
        is_closed[kept],
        count,
    )


def _numbered_edges(faces: NDArray[np.int32], corners: int) -> NDArray[np.int32]:
    after = np.roll(faces, -1, axis=1)
    keys = np.minimum(faces, after).astype(np.int64) * corners + np.maximum(faces, after)
    _, number = np.unique(keys.ravel(), return_inverse=True)
    return ((number.reshape(-1, 3) + 1) * np.where(faces < after, 1, -1)).astype(np.int32)


def winding_number(casters: Casters, point: NDArray[np.float64], /) -> float:
    """How many closed parts a point is inside of: a whole number but for rounding.

    The sum of the solid angles of their faces over that of the sphere (Van Oosterom and Strackee 1983).
    """
    a, b, c = (casters.positions[casters.faces[casters.is_closed, k]] - point for k in range(3))
    lengths = [np.linalg.norm(v, axis=1) for v in (a, b, c)]
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    la, lb, lc = lengths
    angles = np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    return float(angles.sum() / (2 * np.pi))


def _welded(meshes: list[TriMesh]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    positions = np.concatenate([mesh.positions for mesh in meshes]) + 0.0  # minus zero is zero
    faces = np.concatenate([m.faces + start for m, start in zip(meshes, starts, strict=False)])
    order = np.lexsort(positions.T)
    ordered = positions[order]
    is_new = np.ones(len(order), bool)
    is_new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    place = np.empty(len(order), np.int32)
    place[order] = np.cumsum(is_new) - 1
    return ordered[is_new], place[faces]


def _alike(faces: NDArray[np.int32]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """A number for each face, the same for those of the same corners; whether they face both ways."""
    first = faces.argmin(axis=1)
    rows = np.arange(len(faces))
    a, b, c = (faces[rows, (first + k) % 3].astype(np.int64) for k in range(3))
    count = int(faces.max(initial=0)) + 1
    is_turned = b > c
    _, number = np.unique(a * count + np.minimum(b, c), return_inverse=True)
    _, number = np.unique(number * np.int64(count) + np.maximum(b, c), return_inverse=True)
    from_one = np.bincount(number, ~is_turned) > 0
    from_other = np.bincount(number, is_turned) > 0
    return number.astype(np.int64), (from_one & from_other)[number]


def _closed_parts(edges: NDArray[np.int64], is_even: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Of each face, whether all edges of its part are even; faces that share an edge are of one part."""
    faces = len(edges)
    rows = np.repeat(np.arange(faces), 3)
    link = coo_array(
        (np.ones(3 * faces, np.int8), (rows, faces + edges.ravel())), shape=(faces + len(is_even),) * 2
    )
    count, part = connected_components(link, directed=False)
    is_closed = np.ones(count, bool)
    is_closed[part[faces:][~is_even]] = False
    mine: NDArray[np.bool_] = is_closed[part[:faces]]
    return mine
