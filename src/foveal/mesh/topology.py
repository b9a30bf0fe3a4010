"""How a mesh hangs together: what is shared, open, doubled or left over."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from . import _kernels
from .normals import unit_normals
from .trimesh import TriMesh

__all__ = ["Counts", "inspect", "weld"]


@dataclass(frozen=True)
class Counts:
    """What `inspect` finds. Vertices count as the same only if their index is: `weld` a mesh first.

    Attributes
    ----------
    vertices, triangles : int
    unused_vertices : int
        Of no triangle.
    coincident_vertices : int
        How many vertices welding would save.
    degenerate_triangles : int
        Of no area: a repeated corner, or three corners exactly on a line.
    duplicate_triangles : int
        With the same three corners, in any order, as an earlier one.
    boundary_edges, nonmanifold_edges : int
        Edges of one triangle, and of more than two. Triangles with a repeated corner have no edges.
    components : int
        Sets of triangles that hang together by vertices.
    is_closed : bool
        No boundary edge.
    """

    vertices: int
    triangles: int
    unused_vertices: int
    coincident_vertices: int
    degenerate_triangles: int
    duplicate_triangles: int
    boundary_edges: int
    nonmanifold_edges: int
    components: int
    is_closed: bool


def inspect(mesh: TriMesh, /) -> Counts:
    """Count what is unusual in a mesh.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch
    >>> counts = inspect(grid_patch(2))
    >>> counts.boundary_edges, counts.components, counts.is_closed
    (8, 1, False)
    """
    n, faces = len(mesh.positions), mesh.faces.astype(np.int64)
    a, b, c = (mesh.positions[faces[:, i]] for i in range(3))
    degenerate = (np.cross(b - a, c - a) == 0).all(axis=1)
    ordered = np.sort(faces, axis=1)
    is_repeated = (ordered[:, 0] == ordered[:, 1]) | (ordered[:, 1] == ordered[:, 2])
    boundary, nonmanifold = _edge_counts(ordered[~is_repeated], n)
    is_used = np.zeros(n, dtype=bool)
    is_used[faces] = True
    unused = n - int(is_used.sum())
    links = np.concatenate([faces[:, :2], faces[:, 1:]])
    graph = coo_array((np.ones(len(links), dtype=np.int8), (links[:, 0], links[:, 1])), shape=(n, n))
    parts = connected_components(graph, directed=False, return_labels=False)
    return Counts(
        vertices=n,
        triangles=len(faces),
        unused_vertices=unused,
        coincident_vertices=n - _places(mesh.positions)[1],
        degenerate_triangles=int((degenerate | is_repeated).sum()),
        duplicate_triangles=len(faces) - _distinct_rows(ordered, n),
        boundary_edges=boundary,
        nonmanifold_edges=nonmanifold,
        components=int(parts) - unused,
        is_closed=boundary == 0,
    )


def _edge_counts(ordered: NDArray[np.int64], n: int) -> tuple[int, int]:
    """Edges of one triangle and of more than two, given triangles with ascending corners."""
    keys = np.concatenate([ordered[:, i] * n + ordered[:, j] for i, j in ((0, 1), (1, 2), (0, 2))])
    keys.sort()
    starts = np.flatnonzero(np.diff(keys, prepend=-1))
    uses = np.diff(starts, append=len(keys))
    return int((uses == 1).sum()), int((uses > 2).sum())


def _distinct_rows(ordered: NDArray[np.int64], n: int) -> int:
    """How many rows differ. Two keys, since three indices do not fit into one of 64 bits."""
    if n < 1 << 21:
        keys = np.sort((ordered[:, 0] * n + ordered[:, 1]) * n + ordered[:, 2])
        return int(np.count_nonzero(np.diff(keys))) + 1 if len(keys) else 0
    pairs = ordered[:, 0] * n + ordered[:, 1]
    order = np.lexsort((ordered[:, 2], pairs))
    pairs, last = pairs[order], ordered[order, 2]
    return int(np.count_nonzero((np.diff(pairs) != 0) | (np.diff(last) != 0))) + 1


def _places(positions: NDArray[np.float64]) -> tuple[NDArray[np.int32], int]:
    """For each vertex the number of its place, in order of first appearance, and how many places."""
    bits = np.ascontiguousarray(positions + 0.0).view(np.uint64)  # -0.0 + 0.0 is 0.0
    table = np.full(1 << max(4, (2 * len(bits)).bit_length()), -1, dtype=np.int32)
    out = np.empty(len(bits), dtype=np.int32)
    return out, int(_kernels.weld_positions(bits, table, out))


def weld(mesh: TriMesh, /) -> tuple[TriMesh, NDArray[np.int32]]:
    """Merge vertices at exactly the same position, keeping all triangles and their order.

    Returns
    -------
    TriMesh
        Vertices in the order of first appearance; normals and colours are means of those merged.
    (n,) int32
        The new index of each old vertex.

    Examples
    --------
    >>> two = TriMesh.of([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, -0.0]], [[0, 1, 2], [3, 2, 0]])
    >>> weld(two)[1]
    array([0, 1, 2, 1], dtype=int32)
    """
    place, count = _places(mesh.positions)
    if count == len(place):
        return mesh, place
    first = np.empty(count, dtype=np.int64)
    first[place[::-1]] = np.arange(len(place))[::-1]  # the last to write is the first to appear
    normals = colours = None
    if mesh.normals is not None:
        normals = unit_normals(_sums(mesh.normals, place, count))
    if mesh.colours is not None:
        means = _sums(mesh.colours, place, count) / np.bincount(place, minlength=count)[:, None]
        colours = np.rint(means).astype(np.uint8)
    return TriMesh(mesh.positions[first] + 0.0, place[mesh.faces], normals, colours), place


def _sums(
    values: NDArray[np.float32] | NDArray[np.uint8], place: NDArray[np.int32], count: int
) -> NDArray[np.float64]:
    """(count, 3): values added up by place."""
    columns = [np.bincount(place, weights=values[:, k], minlength=count) for k in range(3)]
    return np.stack(columns, axis=1)
