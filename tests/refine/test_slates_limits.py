"""Slates: limit points and normals as the slow twin and OpenSubdiv have them."""

import functools

import numpy as np
import pytest
from scipy.spatial import KDTree

from foveal.mesh.poly_shapes import cube, prism, quad_grid, quad_torus
from foveal.mesh.polymesh import BOUNDARIES
from foveal.refine.slates import Slates
from refine import naive_catmull_clark as twin
from refine.cages import CAGES, creased
from refine.test_catmull_clark_twin import CREASED, PLAIN, control_mesh, level_of, reference


def grid_of(depth):
    """(4^depth, 4, 2): row and column of the corners of a patch's faces in the order of the twin's."""
    quads = np.array([[(0, 0), (0, 1), (1, 1), (1, 0)]])
    for _ in range(depth):
        corner = quads.transpose(1, 0, 2)
        children = [
            np.stack([corner[k] + corner[i] for i in (k, (k + 1) % 4, (k + 2) % 4, k - 1)]) for k in range(4)
        ]
        quads = np.stack(children).transpose(2, 0, 1, 3).reshape(-1, 4, 2)
    return quads


def blocks_of(surface, depth):
    """(m 4^depth, 4): the row of each corner of each face of the uniform surface, in the twin's order."""
    places, size = surface._blocks.places, (1 << depth) + 1
    assert (places.depths == depth).all()
    grid = grid_of(depth)
    return (places.places[:, None, None] + grid[..., 0] * size + grid[..., 1]).reshape(-1, 4)


@functools.cache
def truth(name, depth):
    """The twin's surface at a depth, limit points and normals."""
    mesh = CAGES[name]()
    s = twin.start(mesh)
    if any(len(face) != 4 for face in s.faces):
        s = twin.subdivided(s)
    points, normals = twin.limits(s, depth)
    for _ in range(depth):
        s = twin.subdivided(s)
    return np.array(s.faces), points, normals, s.holes


@pytest.mark.parametrize("depth", range(4))
@pytest.mark.parametrize("name", CAGES)
def test_limit_points_and_normals_are_those_of_the_slow_twin(name, depth):
    mesh = CAGES[name]()
    surface = Slates(mesh)
    surface._blocks.ensure(
        np.full(surface.patches, depth, np.int8), np.full(4 * surface.patches, -1, np.int8)
    )
    faces, points, normals, _ = truth(name, depth)
    rows = blocks_of(surface, depth)
    arrays = surface.arrays()
    diagonal = np.linalg.norm(np.ptp(mesh.positions, axis=0))
    assert abs(arrays.positions[rows] - points[faces]).max() <= 1e-14 * diagonal
    assert abs(arrays.normals[rows].reshape(-1, 3) - normals).max() <= 1e-11


@pytest.mark.parametrize("name", PLAIN + CREASED)
def test_limits_are_those_of_opensubdiv(name):
    data = reference(name)
    mesh = control_mesh(data, name)
    level = level_of(name) - int((np.diff(mesh.starts) != 4).any())
    surface = Slates(mesh)
    surface.show(level)
    arrays = surface.arrays()
    rows = np.unique(arrays.faces[arrays.faces.any(axis=1)])
    truth_at, normal = data["limit"].copy(), data["normal"].copy()
    is_defined = data["normal_defined"].copy() if "normal_defined" in data else np.ones(len(normal), bool)
    if "dart_idx" in data:
        dart = data["dart_idx"]
        truth_at[dart], normal[dart], is_defined[dart] = data["dart_limit"], data["dart_normal"], True
    is_face = ~data["F_hole"] if "F_hole" in data else np.ones(len(data["F"]), bool)
    on_surface = np.unique(data["F"][is_face])
    diagonal = np.linalg.norm(np.ptp(data["V"], axis=0))
    away, row = KDTree(truth_at[on_surface]).query(arrays.positions[rows])
    assert away.max() <= 1e-12 * diagonal
    assert len(np.unique(row)) == len(on_surface)
    row = on_surface[row]
    kept = is_defined[row]
    assert abs(arrays.normals[rows][kept] - normal[row][kept]).max() <= 1e-9


@pytest.mark.parametrize("seed", range(24))
def test_tags_of_all_kinds_at_any_place(seed):
    rng = np.random.default_rng(seed)
    make = [cube, lambda: prism(13), lambda: quad_torus(3, 3), lambda: quad_grid(3, 2), lambda: quad_grid(1)]
    mesh = creased(make[seed % 5](), seed, BOUNDARIES[seed % 3])
    s, depth = twin.start(mesh), int(rng.integers(0, 3))
    if any(len(face) != 4 for face in s.faces):
        s = twin.subdivided(s)
    points, normals = twin.limits(s, depth)
    for _ in range(depth):
        s = twin.subdivided(s)
    surface = Slates(mesh)
    surface._blocks.ensure(
        np.full(surface.patches, depth, np.int8), np.full(4 * surface.patches, -1, np.int8)
    )
    rows, arrays = blocks_of(surface, depth), surface.arrays()
    assert abs(arrays.positions[rows] - points[np.array(s.faces)]).max() <= 1e-13
    assert abs(arrays.normals[rows].reshape(-1, 3) - normals).max() <= 1e-10
