"""The polygon mesh of subdivision: faces of any number of corners, and how sharp edges and corners are."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .trimesh import TriMesh

__all__ = ["BOUNDARIES", "INFINITELY_SHARP", "Boundary", "PolyMesh"]

INFINITELY_SHARP = 10.0
"""From here on an edge or a corner never becomes smooth, as OpenSubdiv has it."""

Boundary = Literal["edge_only", "edge_and_corner", "none"]
BOUNDARIES: tuple[Boundary, ...] = ("none", "edge_and_corner", "edge_only")
"""In the order of the numbers that files give them (`t interpolateboundary` of an OBJ): 0, 1, 2."""


def _no_indices(*shape: int) -> NDArray[np.int32]:
    return np.empty(shape, np.int32)


def _no_sharpness() -> NDArray[np.float32]:
    return np.empty(0, np.float32)


@dataclass(frozen=True, eq=False, slots=True)
class PolyMesh:
    """Polygons over shared vertices, with creases and corners: the control mesh of a subdivision surface.

    Use `PolyMesh.of` or `checked` on data from outside; the constructor itself checks nothing.

    Attributes
    ----------
    positions : (n, 3) float64
        In the unit and axes of the file they came from. A vertex may belong to no face.
    starts : (m + 1,) int32
        corners[starts[f]:starts[f + 1]] are the vertices of face f, at least three.
    corners : (starts[m],) int32
        Vertex indices in [0, n), counter-clockwise seen from outside.
    crease_edges : (c, 2) int32
        Each edge once, the lower vertex first, in ascending order.
    crease_sharpness : (c,) float32
        0 is smooth; between, the edge is sharp for so many steps; from 10 on (or inf) for ever.
    corner_vertices, corner_sharpness : (k,) int32, (k,) float32
        The same of vertices, each once, in ascending order.
    boundary : "edge_only", "edge_and_corner" or "none"
        Boundary edges are infinitely sharp in all three. "edge_and_corner" makes each vertex of one face
        an infinitely sharp corner, too; "none" leaves out of the surface all faces that touch a boundary
        vertex of which some boundary edge has no tag of 10 or more.
    colours : (n, 3) float32 or None
        sRGB, 0 to 255; no bytes, since they are subdivided like positions.
    uvs : (n, 2) float32 or None
        Texture coordinates.
    holes : (h,) int32
        Faces that are left out of the surface, each once, in ascending order; the others bend as if they
        were there.

    References
    ----------
    DeRose, T., Kass, M., Truong, T. (1998). Subdivision surfaces in character animation. Proc. SIGGRAPH,
    85-94, section 3 (sharpness). The names of `boundary` are OpenSubdiv's.

    Examples
    --------
    >>> mesh = PolyMesh.of([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 2, 0]], [[0, 1, 2, 3], [3, 2, 4]])
    >>> mesh.faces, mesh.starts, mesh.corners
    (2, array([0, 4, 7], dtype=int32), array([0, 1, 2, 3, 3, 2, 4], dtype=int32))
    """

    positions: NDArray[np.float64]
    starts: NDArray[np.int32]
    corners: NDArray[np.int32]
    crease_edges: NDArray[np.int32] = field(default_factory=lambda: _no_indices(0, 2))
    crease_sharpness: NDArray[np.float32] = field(default_factory=_no_sharpness)
    corner_vertices: NDArray[np.int32] = field(default_factory=lambda: _no_indices(0))
    corner_sharpness: NDArray[np.float32] = field(default_factory=_no_sharpness)
    boundary: Boundary = "edge_only"
    colours: NDArray[np.float32] | None = None
    uvs: NDArray[np.float32] | None = None
    holes: NDArray[np.int32] = field(default_factory=lambda: _no_indices(0))

    @classmethod
    def of(
        cls,
        positions: ArrayLike,
        faces: Sequence[Sequence[int]] | NDArray[np.integer[Any]],
        /,
        *,
        creases: Mapping[tuple[int, int], float] | None = None,
        sharp_corners: Mapping[int, float] | None = None,
        boundary: Boundary = "edge_only",
        colours: ArrayLike | None = None,
        uvs: ArrayLike | None = None,
        holes: ArrayLike = (),
        name: str = "mesh",
    ) -> "PolyMesh":
        """A checked mesh of lists of vertices, one a face, and sharpness by edge and by vertex.

        Raises
        ------
        FovealError
            As `checked`.

        Examples
        --------
        >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> PolyMesh.of(square, [[0, 1, 2, 3]], creases={(1, 0): 2.5}).crease_edges
        array([[0, 1]], dtype=int32)
        """
        from .poly_checks import numbers, whole_numbers

        if isinstance(faces, np.ndarray):
            rows = [*whole_numbers("faces", faces, name, (-1, faces.shape[-1]))]
        else:
            rows = [whole_numbers(f"face {i}", face, name, (-1,)) for i, face in enumerate(faces)]
        edges, sharp = creases or {}, sharp_corners or {}
        parts: list[Any] = [
            numbers("positions", positions, name, (-1, 3)),
            np.cumsum([0, *map(len, rows)], dtype=np.int64),
            np.concatenate([*rows, _no_indices(0)]),
            list(edges),
            list(edges.values()),
            list(sharp),
            list(sharp.values()),
            *(boundary, colours, uvs, holes),
        ]
        return cls(*parts).checked(name)

    @classmethod
    def of_triangles(cls, mesh: TriMesh, /) -> "PolyMesh":
        """A mesh of triangles as polygons, without creases. Normals are left behind; nothing is checked.

        Examples
        --------
        >>> from foveal.mesh.shapes import tetrahedron
        >>> PolyMesh.of_triangles(tetrahedron()).starts
        array([ 0,  3,  6,  9, 12], dtype=int32)
        """
        return cls(
            mesh.positions,
            np.arange(0, 3 * len(mesh.faces) + 1, 3, dtype=np.int32),
            mesh.faces.reshape(-1),
            colours=None if mesh.colours is None else mesh.colours.astype(np.float32),
        )

    @property
    def faces(self) -> int:
        """How many faces there are."""
        return len(self.starts) - 1

    def checked(self, name: str = "mesh", /) -> "PolyMesh":
        """The same mesh as contiguous arrays of the types above, once it is sure to be a surface.

        Creases and corners come ascending, each once; of several for one edge or vertex the last holds, as
        in OpenSubdiv.

        Raises
        ------
        FovealError
            In a sentence that begins with `name` and names the element: an edge of more than two faces, or of
            two that run the same way; a vertex at which several fans of faces touch; a face with a repeated
            vertex or of fewer than three; a coordinate or attribute that is NaN or infinite; an index of no
            vertex; a crease that is no edge; a sharpness that is negative or NaN; shapes and types that do
            not belong together; no face at all.

        Examples
        --------
        >>> PolyMesh.of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], creases={(0, 3): 1}, name="leaf.obj")
        Traceback (most recent call last):
        foveal.base.errors.FovealError: leaf.obj: there is no edge between vertices 0 and 3 ...
        """
        from .poly_checks import checked

        return checked(self, name)

    def triangulated(self) -> TriMesh:
        """The faces but holes as fans around their first corners: right for convex ones; vertices stay.

        Examples
        --------
        >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> PolyMesh.of(square, [[0, 1, 2, 3]]).triangulated().faces
        array([[0, 1, 2],
               [0, 2, 3]], dtype=int32)
        """
        starts = self.starts.astype(np.int64)
        sizes = np.diff(starts)
        is_second = np.ones(len(self.corners), np.bool_)  # corners but the first and the last of each face
        is_second[starts[:-1]] = False
        is_second[starts[1:] - 1] = False
        second = np.flatnonzero(is_second)
        first = np.repeat(starts[:-1], sizes - 2)
        is_shown = np.ones(self.faces, np.bool_)
        is_shown[self.holes] = False
        kept = np.repeat(is_shown, sizes - 2)
        first, second = first[kept], second[kept]
        colours = None if self.colours is None else np.rint(self.colours).clip(0, 255).astype(np.uint8)
        triangles = np.stack([self.corners[first], self.corners[second], self.corners[second + 1]], axis=1)
        return TriMesh(self.positions, triangles, None, colours)
