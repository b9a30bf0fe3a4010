"""Control meshes, views, and what is compared of refined meshes, for all schemes."""

import math

import numpy as np

import corpus
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, tetrahedron, torus
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region
from foveal.view.camera import Camera

SURFACES = {
    "tetrahedron": tetrahedron,
    "icosphere": lambda: icosphere(1),
    "torus": lambda: torus(7, 5),
    "bumpy": lambda: bumpy_sphere(2, seed=3),
    "terrain": lambda: terrain(5),
    "with_hole": corpus.MESHES["with_hole"],
    "single_triangle": corpus.MESHES["single_triangle"],
    "two_triangles": corpus.MESHES["two_triangles"],
    "two_pieces": lambda: corpus.joined(icosphere(0), TriMesh(terrain(3).positions + 9, terrain(3).faces)),
}


def everywhere(level):
    return Criteria(Region(level), Region(level), Region(level))


def around(mesh, angle=0.0, height=0.3, closeness=1.0):
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    camera = Camera.around(low, high, direction=(math.sin(angle), height, math.cos(angle)))
    eye = camera.target + (camera.position - camera.target) * closeness
    return Camera.of(eye, camera.target)


def turned(faces):
    """The set of triangles, each beginning with its least vertex."""
    return {tuple(np.roll(row, -np.argmin(row))) for row in faces.tolist()}


def canonical(mesh):
    """The triangles' corners, bit for bit, whatever the order of triangles and which corner is first."""
    corners = mesh.positions[mesh.faces]
    keys = np.ascontiguousarray(corners).view("V24").reshape(-1, 3)
    names = np.unique(keys.reshape(-1), return_inverse=True)[1].reshape(-1, 3)
    first = names.argmin(axis=1)
    rows = np.take_along_axis(corners, ((first[:, None] + np.arange(3)) % 3)[..., None], axis=1).reshape(
        -1, 9
    )
    return rows[np.lexsort(rows.T)]


def assert_same(a, b):
    assert len(a.faces) == len(b.faces)
    assert (canonical(a) == canonical(b)).all()


def edges_of(faces):
    """(3 m, 2): the half-edges."""
    return np.concatenate([faces[:, [k, (k + 1) % 3]] for k in range(3)])


def assert_surface(mesh, base):
    """Conforming and oriented, with the border, holes and pieces of the control mesh."""
    halves = edges_of(mesh.faces)
    keys = halves[:, 0].astype(np.int64) * len(mesh.positions) + halves[:, 1]
    assert len(np.unique(keys)) == len(keys)
    assert euler(mesh) == euler(base)


def euler(mesh):
    """Vertices - edges + triangles."""
    edges = len(np.unique(np.sort(edges_of(mesh.faces), axis=1), axis=0))
    return len(mesh.positions) - edges + len(mesh.faces)
