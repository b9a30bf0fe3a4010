"""Slates: no gaps at any depths, whatever was shown before, moved, or asked for."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.mesh.poly_shapes import cube, prism, quad_grid, quad_torus
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.shapes import icosphere
from foveal.refine.slates import Slates
from foveal.refine.slates_depth import Depths
from foveal.view.camera import Camera
from refine import naive_catmull_clark as twin
from refine.cages import CAGES, CLOSED, wavy


def merged_edges(points, faces):
    """Directed edges, once bit-equal points are one."""
    _, own = np.unique(points + 0.0, axis=0, return_inverse=True)
    faces = own.reshape(-1)[faces]
    assert (faces != np.roll(faces, 1, axis=1)).all()
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def open_edges(arrays, most=1):
    """How many edges have one face, once each is known to run at most so often in each direction."""
    faces = arrays.faces[arrays.faces.any(axis=1)]
    edges = merged_edges(arrays.positions, faces).astype(np.int64)
    keys, counts = np.unique(edges[:, 0] << 32 | edges[:, 1], return_counts=True)
    assert counts.max() <= most, "an edge runs twice in one direction"
    back = (keys & 0xFFFFFFFF) << 32 | keys >> 32
    at = np.searchsorted(keys, back).clip(max=len(keys) - 1)
    return int((counts - np.where(keys[at] == back, counts[at], 0)).clip(min=0).sum())


@pytest.mark.parametrize("name", CLOSED)
def test_a_closed_mesh_is_closed_at_any_depths(name):
    surface, rng = Slates(CAGES[name]()), np.random.default_rng(5)
    for _ in range(1000 // len(CLOSED) + 1):
        depths = rng.integers(0, rng.integers(1, 5), surface.patches, endpoint=True)
        done = surface.show(depths)
        arrays = surface.arrays()
        assert open_edges(arrays) == 0
        assert done.triangles == arrays.counts.sum() == np.count_nonzero(arrays.faces.any(axis=1))


@pytest.mark.parametrize("name", sorted(set(CAGES) - set(CLOSED)))
def test_an_open_mesh_is_open_at_its_border_alone(name):
    mesh = CAGES[name]()
    surface, rng = Slates(mesh), np.random.default_rng(6)
    net = surface._cage.net
    is_shown = surface._cage.is_shown
    beyond = np.where(net.mates >= 0, is_shown[net.mates // 4], False)
    is_border = np.repeat(is_shown, 4) & ~beyond
    most = (
        2 if name == "valence_two" else 1
    )  # where two quadrangles share two edges they may share a diagonal
    for _ in range(40):
        depths = rng.integers(0, 4, surface.patches, endpoint=True)
        surface.show(depths)
        assert open_edges(surface.arrays(), most) == (1 << np.repeat(depths, 4)[is_border]).sum()


def triangles_of(surface):
    """What is shown: places and normals of all corners, whatever the order."""
    arrays = surface.arrays()
    faces = arrays.faces[arrays.faces.any(axis=1)]
    data = np.concatenate([arrays.positions[faces], arrays.normals[faces]], axis=2).reshape(len(faces), -1)
    return np.unique(data, axis=0)


@pytest.mark.parametrize("name", ["creased_prism", "torus", "creased_grid", "holes"])
def test_what_was_shown_before_changes_no_bit(name):
    mesh, rng = CAGES[name](), np.random.default_rng(7)
    surface = Slates(mesh)
    for _ in range(12):
        depths = rng.integers(0, 5, surface.patches)
        surface.show(depths)
        fresh = Slates(mesh)
        fresh.show(depths)
        np.testing.assert_array_equal(triangles_of(surface), triangles_of(fresh))


@pytest.mark.parametrize("name", ["creased_prism", "valence_two", "creased_torus"])
def test_a_part_that_moves_is_the_same_as_a_fresh_mesh(name):
    mesh, rng = CAGES[name](), np.random.default_rng(8)
    surface, positions = Slates(mesh), mesh.positions.copy()
    for _ in range(10):
        depths = rng.integers(0, 4, surface.patches)
        positions = positions.copy()
        positions[rng.integers(len(positions))] += rng.normal(scale=0.1, size=3)
        surface.show(depths, positions=positions)
        fresh = Slates(PolyMesh(positions, *[getattr(mesh, n) for n in mesh.__slots__[1:]]))
        fresh.show(depths)
        np.testing.assert_array_equal(triangles_of(surface), triangles_of(fresh))


def test_who_copies_what_changed_has_it_all():
    mesh, rng = CAGES["creased_torus"](), np.random.default_rng(9)
    surface = Slates(mesh)
    copies = np.zeros((20_000, 3)), np.zeros((20_000, 3)), np.zeros((40_000, 3), np.int32)
    for turn in range(30):
        positions = mesh.positions * (1 + 0.01 * turn) if turn % 5 == 0 else None
        surface.show(rng.integers(0, 4, surface.patches), positions=positions)
        arrays = surface.arrays()
        rows, faces = surface.changed()
        for copy, now, parts in zip(copies, arrays[:3], (rows, rows, faces), strict=True):
            for begin, end in parts:
                copy[begin:end] = now[begin:end]
        np.testing.assert_array_equal(copies[2][: len(arrays.faces)], arrays.faces)
        used = np.unique(arrays.faces)
        np.testing.assert_array_equal(copies[0][used], arrays.positions[used])
        np.testing.assert_array_equal(copies[1][used], arrays.normals[used])


def test_several_workers_compute_the_same_bits():
    rng = np.random.default_rng(4)
    mesh = PolyMesh.of_triangles(icosphere(3))
    depths = rng.integers(1, 5, 3 * len(icosphere(3).faces))
    one, three = Slates(mesh), Slates(mesh, workers=3)
    for positions in (mesh.positions, wavy(mesh)):
        done = [surface.show(depths, positions=positions) for surface in (one, three)]
        assert done[0] == done[1]
        assert len(one.arrays().positions) > 60_000
        for a, b in zip(one.arrays()[:6], three.arrays()[:6], strict=True):
            assert np.array_equal(a, b)


def test_only_what_is_near_a_moved_vertex_is_computed_anew():
    mesh = quad_torus(12, 10)
    surface = Slates(mesh)
    assert surface.show(2).patches == 120
    positions = mesh.positions.copy()
    positions[37] *= 1.01
    done = surface.show(2, positions=positions)
    assert (done.patches, done.renewed) == (16, 0)  # four by four quadrangles around it
    assert surface.show(1).patches == 0
    assert surface.show(3).patches == 120


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_moving_the_control_mesh_moves_the_surface(seed):
    rng = np.random.default_rng(seed)
    mesh = CAGES["creased_prism"]()
    matrix, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    surface = Slates(mesh)
    depths = rng.integers(0, 4, surface.patches)
    surface.show(depths)
    rows = np.unique(surface.arrays().faces)
    before = surface.arrays().positions[rows]
    surface.show(depths, positions=mesh.positions @ matrix + shift)
    after = surface.arrays().positions[rows]
    np.testing.assert_allclose(after, before @ matrix + shift, rtol=0, atol=1e-12)


def test_quadrangles_beside_a_deeper_patch_are_fans_around_the_next_face_point():
    """A row of two quadrangles, depths 1 and 3: four fans' worth of points on the side between them."""
    mesh = quad_grid(2, 1)
    mesh = PolyMesh.of(wavy(mesh), mesh.corners.reshape(-1, 4))
    surface = Slates(mesh)
    surface.show([1, 3])
    # Two fans of four edges each, with a side of four pieces and the cut between them; two even ones.
    assert surface.arrays().counts.tolist() == [[2 * (3 + 4 + 1) + 2 * 2, 2 * 64]]
    shown = surface.arrays()
    rows = np.unique(shown.faces[shown.first[0, 0] : shown.first[0, 0] + shown.counts[0, 0]])
    finer = Slates(mesh)
    finer.show(3)
    fine = finer.arrays()
    points = np.unique(fine.positions[np.unique(fine.faces)], axis=0)
    own = np.unique(shown.positions[rows], axis=0)
    # 9 of its depth, 8 - 2 more on the side, two hubs and the cut: all are points of the finer surface.
    assert len(own) == 9 + 6 + 3
    is_there = (own[:, None] == points[None]).all(axis=2).any(axis=1)
    assert is_there.all()


def test_single_precision_comes_out_but_is_not_computed_in():
    mesh = CAGES["creased_prism"]()
    surface, exact = Slates(mesh, dtype=np.float32), Slates(mesh)
    depths = np.random.default_rng(1).integers(0, 4, surface.patches)
    surface.show(depths)
    exact.show(depths)
    ours, theirs = surface.arrays(), exact.arrays()
    assert ours.positions.dtype == ours.normals.dtype == np.float32
    np.testing.assert_array_equal(ours.positions, theirs.positions.astype(np.float32))
    np.testing.assert_array_equal(ours.normals, theirs.normals.astype(np.float32))
    assert open_edges(ours) == 0


def test_attributes_go_along():
    mesh = prism(5)
    colours = np.random.default_rng(0).uniform(0, 255, (10, 3)).astype(np.float32)
    uvs = mesh.positions[:, :2] * 2
    mesh = PolyMesh(mesh.positions, mesh.starts, mesh.corners, colours=colours, uvs=uvs.astype(np.float32))
    surface = Slates(mesh)
    surface.show([0, 3, 1, 2] * 7 + [2, 1])
    arrays = surface.arrays()
    rows = np.unique(arrays.faces)
    assert abs(arrays.columns[1][rows, :2] - 2 * arrays.positions[rows, :2]).max() < 1e-6
    assert (arrays.columns[0][rows] >= -1e-4).all()
    assert (arrays.columns[0][rows] <= 255.0001).all()
    whole = surface.mesh()
    assert whole.colours.shape == whole.positions.shape
    assert abs(whole.uvs - 2 * whole.positions[:, :2]).max() < 1e-5
    surface = Slates(PolyMesh(mesh.positions, mesh.starts, mesh.corners, uvs=mesh.uvs))
    surface.show(1)
    assert surface.mesh().colours is None
    assert abs(surface.mesh().uvs - 2 * surface.mesh().positions[:, :2]).max() < 1e-5


def test_a_mesh_shares_vertices_but_on_creases():
    surface = Slates(cube())
    surface.show([0, 3, 1, 2, 2, 1])
    mesh = surface.mesh()
    edges = len(mesh.faces) * 3 // 2
    assert len(mesh.positions) - edges + len(mesh.faces) == 2
    sharp = PolyMesh.of(
        cube().positions, cube().corners.reshape(-1, 4), creases=dict.fromkeys(twin.start(cube()).edges, 10)
    )
    surface = Slates(sharp)
    surface.show(2)
    assert len(surface.mesh().positions) == 6 * 25
    np.testing.assert_allclose(abs(surface.mesh().normals).max(axis=1), 1, atol=1e-6)


def test_triangles_are_a_control_mesh_too():
    surface = Slates(icosphere(1))
    assert surface.patches == 3 * 80
    done = surface.show(1)
    assert done.triangles == 3 * 80 * 8
    radius = np.linalg.norm(surface.mesh().positions, axis=1)
    assert 0.8 < radius.min() < radius.max() < 1


@pytest.mark.parametrize("name", ["prism", "creased_torus", "creased_grid"])
def test_holes_are_left_out_and_bend_the_rest(name):
    mesh = CAGES[name]()
    holes = np.array([0, mesh.faces // 2])
    holed = replace(mesh, holes=holes.astype(np.int32))
    whole, left = Slates(mesh), Slates(holed)
    for surface in (whole, left):
        surface.show(2)
    ours, theirs = left.arrays(), whole.arrays()
    is_hole = np.isin(ours.patch_faces, holes) | (theirs.depths[0] < 0)
    assert (ours.depths[0] == np.where(is_hole, -1, 2)).all()
    for patch in np.flatnonzero(~is_hole).tolist():
        rows = [a.faces[a.first[0, patch] :][: a.counts[0, patch]] for a in (ours, theirs)]
        assert (ours.positions[rows[0]] == theirs.positions[rows[1]]).all()
        assert (ours.normals[rows[0]] == theirs.normals[rows[1]]).all()
    if name == "prism":  # closed but for the holes, through which backs are seen
        camera = Camera.of([0, 0, 5], [0, 0, 0])
        rules = Depths(cone=None, silhouettes=False, size_px=None)
        for surface, has_backs in ((whole, True), (left, False)):
            surface.update(camera, depths=rules)
            assert (surface.arrays().depths[0] == 0).any() == has_backs
    assert len(holed.triangulated().faces) < len(mesh.triangulated().faces)


def test_bad_input_is_refused_in_a_sentence():
    with pytest.raises(FovealError, match=r"wing\.obj: the edge between vertices 0 and 1 has more than two"):
        Slates(
            PolyMesh(
                np.random.default_rng(0).normal(size=(5, 3)),
                np.array([0, 3, 6, 9]),
                np.array([0, 1, 2, 1, 0, 3, 0, 1, 4]),
            ),
            name="wing.obj",
        )
    surface = Slates(cube())
    with pytest.raises(FovealError, match="8 times three finite numbers"):
        surface.show(1, positions=np.full((8, 3), math.nan))
    with pytest.raises(FovealError, match="4 by 4 matrices"):
        Slates(cube(), placements=np.eye(3))
    with pytest.raises(FovealError, match="flattens"):
        Slates(cube(), placements=np.diag([1.0, 1, 0, 1])[None])
    with pytest.raises(ValueError, match="from 0 to 8"):
        surface.show(9)
    with pytest.raises(ValueError, match="dtype"):
        Slates(cube(), dtype=np.int32)
