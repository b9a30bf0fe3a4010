"""The slow twin of Catmull-Clark: what OpenSubdiv makes, and what must hold for every control mesh."""

import functools
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import KDTree

from conftest import find_shared_data
from foveal.mesh.poly_shapes import cube, prism, quad_grid
from foveal.mesh.polymesh import PolyMesh
from refine import naive_catmull_clark as twin
from refine.cages import CAGES, creased, edges_of

PLAIN = [
    *(f"{name}_L{level}" for name in ("cube", "torus8x5_quad", "opengrid_quad") for level in (1, 2, 3)),
    *(f"pent_open_mixed_L{level}" for level in (1, 2)),
    "cheburashka68_L1",
    *(f"corner_opengrid_quad_L{level}" for level in (1, 2, 3)),
    *(f"corner_pent_open_mixed_L{level}" for level in (1, 2)),
]
CREASED = [
    f"crease_{shape}_L{level}"
    for shape in (
        *("cube_creases0", "cube_creases2", "cube_corner1", "cube_corner4", "dart_edgeonly", "inf_crease0"),
        *("pyramid_creases1", "tent_creases1", "torus_creases0", "edgeonly", "edgenone"),
    )
    for level in (1, 2, 3)
]


@functools.cache
def reference(name):
    return np.load(find_shared_data(f"../reference/cc_osd_{name}.npz"), allow_pickle=False)


def control_mesh(data, name):
    corner = "edge_and_corner" if name.startswith("corner") else "edge_only"
    starts = np.concatenate([[0], np.cumsum(data["F0_cnt"])])
    tags = ()
    if "boundary" in data:
        tags = [
            data[key] for key in ("crease_edges", "crease_sharpness", "corner_vertices", "corner_sharpness")
        ]
        corner = str(data["boundary"])
    return PolyMesh(data["V0"], starts, data["F0_idx"], *tags, boundary=corner).checked(name)


def level_of(name):
    return int(name[-1])


def matched(surface, data):
    """The reference's row of each point, once points, faces and holes are found the same."""
    diagonal = np.linalg.norm(np.ptp(data["V"], axis=0))
    distance, row = KDTree(data["V"]).query(surface.points)
    assert (len(surface.points), len(surface.faces)) == data["V"].shape[:1] + data["F"].shape[:1]
    assert len(np.unique(row)) == len(row)
    assert distance.max() <= 4e-16 * diagonal
    holes = data["F_hole"] if "F_hole" in data else np.zeros(len(data["F"]), bool)
    theirs = dict(zip(map(turned, data["F"].tolist()), holes.tolist(), strict=True))
    ours = {turned(row[list(face)].tolist()): f in surface.holes for f, face in enumerate(surface.faces)}
    assert ours == theirs
    return row, diagonal


def turned(face):
    """The corners, beginning with the least."""
    first = face.index(min(face))
    return (*face[first:], *face[:first])


@functools.cache
def refined(name):
    data = reference(name)
    surface = twin.start(control_mesh(data, name))
    points, normals = twin.limits(surface, level_of(name))
    for _ in range(level_of(name)):
        surface = twin.subdivided(surface)
    return surface, points, normals


@pytest.mark.parametrize("name", PLAIN + CREASED)
def test_points_and_faces_are_those_of_opensubdiv(name):
    matched(refined(name)[0], reference(name))


@pytest.mark.parametrize("name", PLAIN + CREASED)
def test_limit_points_are_those_of_opensubdiv(name):
    data, (surface, points, _) = reference(name), refined(name)
    row, diagonal = matched(surface, data)
    truth = data["limit"].copy()
    if "dart_idx" in data:
        truth[data["dart_idx"]] = data["dart_limit"]
    assert abs(points - truth[row]).max() <= 1e-12 * diagonal


@pytest.mark.parametrize("name", PLAIN + CREASED)
def test_limit_normals_are_those_of_opensubdiv(name):
    data, (surface, _, normals) = reference(name), refined(name)
    row, _ = matched(surface, data)
    truth = data["normal"].copy()
    is_defined = data["normal_defined"].copy() if "normal_defined" in data else np.ones(len(truth), bool)
    if "dart_idx" in data:
        truth[data["dart_idx"]], is_defined[data["dart_idx"]] = data["dart_normal"], True
    corners = row[np.concatenate(surface.faces)]
    assert is_defined.any()
    away = abs(normals - truth[corners]).max(axis=1)
    assert away[is_defined[corners]].max() <= 1e-9
    # Of the two normals at a crease the file holds one, whichever side it is.
    nearest = np.full(len(row), np.inf)
    np.minimum.at(nearest, np.concatenate(surface.faces), away)
    is_crease = [surface.kind(v) == "crease" for v in range(len(row))]
    assert nearest[is_crease].max(initial=0) <= 1e-9


def level(surface, steps):
    for _ in range(steps):
        surface = twin.subdivided(surface)
    return surface


@pytest.mark.parametrize("name", CAGES)
def test_limits_do_not_depend_on_the_level_they_are_taken_at(name):
    """Level k's against level k + 1's, both taken far enough that the masks are at different depths."""
    surface = twin.start(CAGES[name]())
    while not surface.is_settled():
        surface = twin.subdivided(surface)
    points, normals = twin.limits(surface)
    finer_points, finer_normals = twin.limits(twin.subdivided(surface))
    np.testing.assert_allclose(finer_points[: len(points)], points, rtol=0, atol=1e-13)
    # Corner 0 of a child is its parent's corner. Creases of five faces a side and more have no tangent
    # plane, yet the mask's vector is the same from every level.
    np.testing.assert_allclose(finer_normals[::4], normals, rtol=0, atol=1e-10)


@pytest.mark.parametrize("name", CAGES)
def test_moving_the_control_mesh_moves_the_surface(name):
    mesh = CAGES[name]()
    rng = np.random.default_rng(1)
    matrix, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    matrix *= np.sign(np.linalg.det(matrix))  # keeping what is outside outside
    there = twin.start(mesh, mesh.positions @ matrix + shift)
    points, normals = twin.limits(twin.start(mesh), 1)
    moved, moved_normals = twin.limits(there, 1)
    np.testing.assert_allclose(moved, points @ matrix + shift, rtol=0, atol=1e-13)
    expected = normals @ np.linalg.inv(matrix).T
    length = np.linalg.norm(expected, axis=1, keepdims=True)
    expected = np.where(length > 0, expected / np.where(length > 0, length, 1), 0)
    np.testing.assert_allclose(moved_normals, expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("boundary", ["edge_only", "edge_and_corner", "none"])
def test_a_flat_grid_stays_flat_and_keeps_its_border(boundary):
    mesh = quad_grid(4, 3)
    creases = dict.fromkeys(edges_of(mesh)[::3], 1.5)
    faces = mesh.corners.reshape(-1, 4)
    surface = twin.start(PolyMesh.of(mesh.positions, faces, creases=creases, boundary=boundary))
    points, normals = twin.limits(surface, 2)
    assert (points[:, 2] == 0).all()
    assert abs(points[:, :2] - 0.5).max() <= 0.5
    np.testing.assert_allclose(normals, np.tile([0.0, 0.0, 1.0], (len(normals), 1)), atol=1e-12)
    if boundary == "edge_and_corner":
        is_square = {(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)} <= set(
            map(tuple, points[:, :2].tolist())
        )
        assert is_square


def test_columns_beside_the_positions_go_along():
    mesh = creased(prism(5), 8)
    surface = twin.start(mesh, np.column_stack([mesh.positions, mesh.positions @ [1, 2, 3], np.ones(10)]))
    points, _ = twin.limits(surface, 1)
    np.testing.assert_allclose(points[:, 3], points[:, :3] @ [1, 2, 3], atol=1e-13)
    np.testing.assert_allclose(points[:, 4], 1, atol=1e-15)


def test_the_vertex_of_a_cube_by_hand():
    """A corner of the cube: n = 3, (n - 2) v + mean of e + mean of F, all over n; then the limit mask."""
    surface = twin.subdivided(twin.start(cube()))
    e, f = np.array([[1, -1, -1], [-1, 1, -1], [-1, -1, 1]]), np.array([[0, 0, -1], [0, -1, 0], [-1, 0, 0]])
    expected = (np.array([-1, -1, -1]) + e.mean(axis=0) + f.mean(axis=0)) / 3
    np.testing.assert_allclose(surface.points[0], expected, atol=1e-15)
    points, normals = twin.limits(twin.start(cube()))
    diagonals = np.array([[1, 1, -1], [1, -1, 1], [-1, 1, 1]])
    expected = (9 * np.array([-1, -1, -1]) + 4 * e.sum(axis=0) + diagonals.sum(axis=0)) / 24
    np.testing.assert_allclose(points[0], expected, atol=1e-15)
    np.testing.assert_allclose(normals[0], -np.ones(3) / math.sqrt(3), atol=1e-15)


def test_an_infinitely_sharp_cube_is_a_cube():
    mesh = cube()
    sharp = PolyMesh.of(
        mesh.positions, mesh.corners.reshape(-1, 4), creases=dict.fromkeys(edges_of(mesh), 10)
    )
    points, normals = twin.limits(twin.start(sharp), 2)
    assert (abs(points).max(axis=1) == 1).all()
    for f, face in enumerate(level(twin.start(sharp), 2).faces):  # a normal is that of its side
        np.testing.assert_allclose(points[list(face)] @ normals[4 * f : 4 * f + 4].T, 1, atol=1e-14)


@pytest.mark.parametrize("valence", range(3, 13))
def test_masks_are_left_eigenvectors_of_their_step(valence):
    for masks, is_dart in ((twin.smooth_weights, False), (twin.dart_weights, True)):
        step = twin.ring_matrix(valence, is_dart)
        for mask, value in zip(masks(valence), (1, None, None), strict=True):
            image = mask @ step
            value = value or (image @ mask) / (mask @ mask)
            np.testing.assert_allclose(image, value * mask, rtol=0, atol=1e-13)
        assert masks(valence)[0].sum() == pytest.approx(1, abs=1e-14)
        assert abs(np.array(masks(valence)[1:]).sum(axis=1)).max() < 1e-13


def test_there_are_references_for_each_rule():
    folder = find_shared_data("../reference")
    names = {Path(path).stem.removeprefix("cc_osd_") for path in folder.glob("cc_osd_*.npz")}
    assert names == {*PLAIN, *CREASED}
