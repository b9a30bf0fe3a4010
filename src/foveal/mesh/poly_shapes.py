"""Polygon meshes made of formulas, as control meshes for examples, tests and benchmarks."""

import math

import numpy as np

from . import shapes
from .polymesh import PolyMesh
from .trimesh import TriMesh

__all__ = ["cube", "prism", "quad_grid", "quad_torus"]


def cube() -> PolyMesh:
    """The cube from -1 to 1 of 8 vertices and 6 quadrangles, closed. Vertex 4 z + 2 y + x, each 0 or 1."""
    z, y, x = np.indices((2, 2, 2)).reshape(3, -1)
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return PolyMesh.of(np.stack([x, y, z], axis=1) * 2 - 1, faces)


def quad_grid(columns: int, rows: int | None = None) -> PolyMesh:
    """The unit square at z = 0 as `columns` by `rows` quadrangles, seen from +z; open.

    Examples
    --------
    >>> quad_grid(3, 2).faces
    6
    """
    return _paired(shapes.grid_patch(columns, rows))


def quad_torus(rings: int, sides: int, *, major: float = 1.0, minor: float = 0.4) -> PolyMesh:
    """A torus around z of rings · sides quadrangles, all vertices of valence 4: closed, genus 1."""
    return _paired(shapes.torus(rings, sides, major=major, minor=minor))


def _paired(mesh: TriMesh) -> PolyMesh:
    """Triangles 2 k and 2 k + 1, which are corners 0, 1, 2 and 0, 2, 3 of a quadrangle, as that."""
    quads = np.column_stack([mesh.faces[0::2], mesh.faces[1::2, 2]])
    return PolyMesh.of(mesh.positions, quads)


def prism(sides: int, *, height: float = 1.0) -> PolyMesh:
    """An upright prism of radius 1 around z: `sides` quadrangles between two polygons; closed.

    Examples
    --------
    >>> np.diff(prism(5).starts)
    array([5, 5, 4, 4, 4, 4, 4], dtype=int32)
    """
    ring = range(sides)
    angles = np.arange(sides) * (2 * math.pi / sides)
    flat = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    low, high = (np.column_stack([flat, np.full(sides, z)]) for z in (-height / 2, height / 2))
    walls = [[i, (i + 1) % sides, sides + (i + 1) % sides, sides + i] for i in ring]
    caps = [[*reversed(ring)], [sides + i for i in ring]]
    return PolyMesh.of(np.concatenate([low, high]), [*caps, *walls])
