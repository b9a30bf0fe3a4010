"""Meshes by property, so that a law can be held for all of them: `corpus.MESHES[name]()`.

The sets below name those with a property: `CLOSED` have no boundary edge, `MANIFOLD` no edge of more
than two triangles and no vertex whose triangles fall into several fans, `ATTRIBUTED` carry normals or
colours. All are small: at most some thousand triangles.
"""

import math

import numpy as np

from foveal.mesh.shapes import bumpy_sphere, grid_patch, icosphere, terrain, tetrahedron, torus
from foveal.mesh.trimesh import TriMesh


def single_triangle():
    return TriMesh.of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def two_triangles():
    return TriMesh.of([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]], [[0, 1, 2], [0, 2, 3]])


def nonmanifold_edge():
    """Three wings on one edge."""
    points = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]]
    return TriMesh.of(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])


def many_wings():
    """A fan of 40 triangles on one edge."""
    angles = np.linspace(0, 2 * math.pi, 40, endpoint=False)
    tips = np.stack([np.cos(angles), np.sin(angles), np.full(40, 0.5)], axis=1)
    faces = [[0, 1, 2 + i] if i % 2 else [1, 0, 2 + i] for i in range(40)]
    return TriMesh.of(np.concatenate([[[0, 0, 0], [0, 0, 1]], tips]), faces)


def nonmanifold_vertex():
    """Two tetrahedra that touch in one vertex: closed, but no surface at the tip."""
    a = tetrahedron()
    b = 2 * a.positions[0] - a.positions  # the mirror image through corner 0
    faces = np.where(a.faces == 0, 0, a.faces + 3)[:, ::-1]
    return TriMesh.of(np.concatenate([a.positions, b[1:]]), np.concatenate([a.faces, faces]))


def joined(*meshes):
    """Several meshes as one, each a component of its own."""
    starts = np.cumsum([0] + [len(m.positions) for m in meshes[:-1]])
    points = np.concatenate([m.positions for m in meshes])
    return TriMesh.of(points, np.concatenate([m.faces + s for m, s in zip(meshes, starts, strict=True)]))


def several_components():
    ball = icosphere(2)
    shifted = [TriMesh(ball.positions * s + [3 * i, 0, 0], ball.faces) for i, s in enumerate((1, 0.5, 0.1))]
    return joined(*shifted, two_triangles())


def many_components():
    """300 separate tetrahedra."""
    rng = np.random.default_rng(5)
    base = tetrahedron()
    return joined(*[TriMesh(base.positions * 0.02 + rng.uniform(size=3), base.faces) for _ in range(300)])


def soup():
    """Triangles that share no vertex, anywhere in the unit cube."""
    rng = np.random.default_rng(1)
    corners = rng.uniform(size=(600, 1, 3)) + 0.05 * rng.normal(size=(600, 3, 3))
    return TriMesh.of(corners.reshape(-1, 3), np.arange(1800).reshape(-1, 3))


def unwelded_sphere():
    """A closed surface once welded, given as triangles with vertices of their own, as in STL."""
    ball = icosphere(2)
    return TriMesh.of(
        ball.positions[ball.faces].reshape(-1, 3), np.arange(3 * len(ball.faces)).reshape(-1, 3)
    )


def tangled():
    """Random indices over few vertices: edges of many triangles, duplicates, degenerates."""
    rng = np.random.default_rng(2)
    return TriMesh.of(rng.uniform(size=(60, 3)), rng.integers(0, 60, size=(500, 3)))


def degenerate_and_duplicate():
    """A sphere with triangles of one and two distinct vertices, slivers of no area, and repeats."""
    ball = icosphere(1)
    middle = ball.positions[[0, 1]].mean(axis=0, keepdims=True)
    points = np.concatenate([ball.positions, middle])
    n = len(ball.positions)
    extra = [[3, 3, 3], [4, 4, 5], [0, n, 1], ball.faces[7], np.roll(ball.faces[8], 1), ball.faces[9][::-1]]
    return TriMesh.of(points, np.concatenate([ball.faces, extra]))


def unused_vertices():
    ball = icosphere(1)
    n = len(ball.positions)
    points = np.full((2 * n + 3, 3), 7.0)
    points[1 : 2 * n : 2] = ball.positions
    return TriMesh.of(points, 2 * ball.faces + 1)


def coincident_vertices():
    """Two squares beside each other with vertices of their own along the shared side, one of them -0."""
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, -0.0, -0.0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]
    return TriMesh.of(points, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])


def flipped():
    """A sphere of which every third triangle is turned over."""
    ball = icosphere(2)
    faces = ball.faces.copy()
    faces[::3] = faces[::3, ::-1]
    return TriMesh.of(ball.positions, faces)


def moebius():
    """A Moebius strip: no orientation fits it; one boundary loop."""
    n = 40
    t = np.arange(n) * (2 * math.pi / n)
    points = []
    for side in (-0.3, 0.3):
        reach = 1 + side * np.cos(t / 2)
        points.append(np.stack([reach * np.cos(t), reach * np.sin(t), side * np.sin(t / 2)], axis=1))
    faces = []
    for i in range(n):
        a, b = i, i + n
        c, d = (i + 1, i + 1 + n) if i + 1 < n else (n, 0)  # the last pair is swapped
        faces += [[a, c, b], [b, c, d]]
    return TriMesh.of(np.concatenate(points), faces)


def utm():
    """A terrain of 50 m at UTM coordinates: float32 would move it by a quarter of a metre."""
    land = terrain(24, seed=3)
    return TriMesh(land.positions * 50 + [585_000.125, 4_840_000.375, 12.5], land.faces)


def tiny():
    ball = bumpy_sphere(2, seed=1)
    return TriMesh(ball.positions * 1e-9, ball.faces)


def huge():
    ball = bumpy_sphere(2, seed=2)
    return TriMesh(ball.positions * 1e12, ball.faces)


def coloured():
    ball = bumpy_sphere(3, seed=4)
    colours = np.clip(128 + 120 * ball.positions, 0, 255).astype(np.uint8)
    return TriMesh.of(ball.positions, ball.faces, colours=colours)


def with_normals():
    ball = icosphere(3)
    return TriMesh.of(ball.positions, ball.faces, normals=ball.positions)


def with_all_attributes():
    land = terrain(20, seed=6)
    rng = np.random.default_rng(6)
    normals = rng.normal(size=(len(land.positions), 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[0] = 0
    colours = rng.integers(0, 256, size=(len(land.positions), 3))
    return TriMesh.of(land.positions, land.faces, normals=normals, colours=colours.astype(np.uint8))


def with_hole():
    ball = icosphere(3)
    keep = ball.positions[ball.faces].mean(axis=1)[:, 2] < 0.8
    return TriMesh.of(ball.positions, ball.faces[keep])


MESHES = {
    "tetrahedron": tetrahedron,
    "icosphere": lambda: icosphere(3),
    "bumpy_sphere": lambda: bumpy_sphere(3),
    "torus": lambda: torus(32, 20),
    "grid": lambda: grid_patch(12, 7),
    "terrain": lambda: terrain(32),
    "single_triangle": single_triangle,
    "two_triangles": two_triangles,
    "nonmanifold_edge": nonmanifold_edge,
    "many_wings": many_wings,
    "nonmanifold_vertex": nonmanifold_vertex,
    "several_components": several_components,
    "many_components": many_components,
    "soup": soup,
    "unwelded_sphere": unwelded_sphere,
    "tangled": tangled,
    "degenerate_and_duplicate": degenerate_and_duplicate,
    "unused_vertices": unused_vertices,
    "coincident_vertices": coincident_vertices,
    "flipped": flipped,
    "moebius": moebius,
    "utm": utm,
    "tiny": tiny,
    "huge": huge,
    "coloured": coloured,
    "with_normals": with_normals,
    "with_all_attributes": with_all_attributes,
    "with_hole": with_hole,
}
"""Name -> function that makes the mesh anew."""

CLOSED = {
    "tetrahedron",
    "icosphere",
    "bumpy_sphere",
    "torus",
    "nonmanifold_vertex",
    "many_components",
    "flipped",
    "tiny",
    "huge",
    "coloured",
    "with_normals",
    "unused_vertices",
}
"""No boundary edge as they are (`unwelded_sphere` is closed once welded)."""

MANIFOLD = {
    *(CLOSED - {"nonmanifold_vertex"}),
    *("grid", "terrain", "single_triangle", "two_triangles", "several_components", "soup"),
    *("unwelded_sphere", "coincident_vertices", "moebius", "utm", "with_all_attributes", "with_hole"),
}
"""No edge of more than two triangles, one fan a vertex."""

ATTRIBUTED = {"coloured", "with_normals", "with_all_attributes"}
"""With normals, colours or both."""
