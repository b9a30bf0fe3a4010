"""Sharp edges in √3 refinement: borders that stay together, splines, corners that stay."""

import itertools
import math

import numpy as np
import pytest
from scipy.spatial import KDTree

from foveal.base.errors import FovealError
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, tetrahedron, torus
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region, Sqrt3
from foveal.refine.sharp import sharp_edges
from foveal.view.camera import Camera
from refine.naive_sqrt3 import subdivided
from refine.surfaces import SURFACES, around, assert_same, assert_surface, everywhere, turned


def edges_of(mesh):
    """(k, 2): all edges, the lesser vertex first."""
    pairs = np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def some(mesh, share, seed):
    """So large a share of the edges."""
    edges = edges_of(mesh)
    return edges[np.random.default_rng(seed).random(len(edges)) < share]


def cube():
    """A unit cube of twelve triangles, and its twelve edges."""
    corners = np.stack(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0], indexing="ij"), axis=-1).reshape(-1, 3)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    mesh = TriMesh.of(corners, faces)
    return mesh, sharp_edges(mesh, 1.0)


def equator(level):
    """A sphere and a closed crease around it."""
    mesh = icosphere(level)
    heights = mesh.positions @ [0.0, 0.0, 1.0]
    faces = heights[mesh.faces].mean(axis=1) > 0.05
    return mesh, between(mesh, faces)


def between(mesh, is_in):
    """The edges between faces of a set and the others."""
    inside, outside = TriMesh(mesh.positions, mesh.faces[is_in]), TriMesh(mesh.positions, mesh.faces[~is_in])
    both = np.concatenate([edges_of(inside), edges_of(outside)])
    pairs, counts = np.unique(both, axis=0, return_counts=True)
    return pairs[counts == 2]


def first_edges(mesh, count):
    """A path of so many edges from vertex 0, which ends in the middle of nowhere."""
    path, edges = [0], edges_of(mesh)
    while len(path) <= count:
        row = edges[(edges == path[-1]).any(axis=1)]
        path.append(next(int(w) for pair in row for w in pair if w not in path))
    return mesh, np.stack([path[:-1], path[1:]], axis=1)


def across():
    """A terrain with a crease from border to border, and one that ends inside."""
    mesh = terrain(5)
    grid = np.arange(36).reshape(6, 6)
    lines = grid[:, 2], grid[3, 2:5]
    return mesh, np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])


def hole():
    """A sphere that is open at the top, with vertices of no face."""
    mesh = icosphere(1)
    return TriMesh(mesh.positions, mesh.faces[mesh.positions[mesh.faces].mean(axis=1)[:, 2] < 0.8])


def pillow(sharp):
    """Two triangles back to back."""
    return TriMesh.of([[0, 0, 0], [1, 0, 0], [0.2, 1, 0.3]], [[0, 1, 2], [0, 2, 1]]), np.array(sharp)


CREASED = {
    "cube": cube,
    "equator": lambda: equator(1),
    "one_edge": lambda: first_edges(icosphere(0), 1),
    "two_edges": lambda: first_edges(torus(7, 5), 2),
    "path": lambda: first_edges(bumpy_sphere(1, seed=3), 5),
    "across": across,
    "sparse": lambda: (torus(7, 5), some(torus(7, 5), 0.15, 0)),
    "half": lambda: (bumpy_sphere(1, seed=3), some(bumpy_sphere(1, seed=3), 0.5, 1)),
    "all": lambda: (torus(5, 4), edges_of(torus(5, 4))),
    "terrain": lambda: (terrain(4), some(terrain(4), 0.3, 2)),
    "with_hole": lambda: (hole(), some(hole(), 0.2, 3)),
    "tetrahedron": lambda: (tetrahedron(), some(tetrahedron(), 0.5, 4)),
}
PILLOWS = {
    f"pillow_{len(sharp)}": (lambda sharp=sharp: pillow(sharp))
    for sharp in ([[0, 1]], [[0, 1], [1, 2]], [[0, 1], [1, 2], [2, 0]])
}


def walk(mesh, seed, steps):
    """(camera, criteria) of a random walk."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, 6)
    for _ in range(steps):
        angle += rng.choice([0.02, 0.3, 3.0])
        px = float(rng.choice([20, 40]))
        yield (
            around(mesh, angle, rng.uniform(-0.5, 0.5), rng.choice([0.3, 0.8, 2.0])),
            Criteria(Region(4, px), Region(7, px / 2, 0.05), Region(int(rng.integers(0, 2)))),
        )


def assert_closes(refined, placing="control"):
    """Wherever the mesh was cut open its sides agree bit for bit: welded by place, it is the mesh."""
    slots, mesh = refined.slots(positions=placing), refined.mesh(positions=placing)
    faces = slots.faces[slots.faces[:, 0] != slots.faces[:, 1]]
    used, index = np.unique(faces, return_inverse=True)
    places, same = np.unique(slots.positions[used], axis=0, return_inverse=True)
    assert len(places) == len(np.unique(mesh.faces))
    assert_same(TriMesh(places, same.reshape(-1)[index].reshape(-1, 3).astype(np.int32)), mesh)


@pytest.mark.parametrize(
    ("name", "level"), [*itertools.product(CREASED, range(5)), ("one_edge", 6), ("tetrahedron", 6)]
)
def test_everywhere_it_is_uniform_subdivision(name, level):
    mesh, sharp = CREASED[name]()
    refined = Sqrt3(mesh, sharp=sharp)
    refined.update(around(mesh), criteria=everywhere(level))
    found = refined.mesh()
    positions, faces = subdivided(mesh.positions, mesh.faces, level, sharp)
    distance, index = KDTree(positions).query(found.positions)
    assert distance.max() <= 1e-13 * np.linalg.norm(np.ptp(mesh.positions, axis=0))
    assert len(np.unique(index)) == len(positions) == len(found.positions)
    assert turned(index[found.faces]) == turned(faces)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", CREASED)
def test_the_mesh_depends_on_the_view_alone_and_conforms(name, seed):
    mesh, sharp = CREASED[name]()
    refined = Sqrt3(mesh, sharp=sharp)
    for camera, criteria in walk(mesh, seed, 8):
        refined.update(camera, criteria=criteria)
        fresh = Sqrt3(mesh, sharp=sharp)
        fresh.update(camera, criteria=criteria)
        assert_same(refined.mesh(), fresh.mesh())
        assert_surface(refined.mesh(), mesh)
        assert_closes(refined)
    assert_closes(refined, "limit")


@pytest.mark.parametrize("name", CREASED)
def test_nothing_is_undone_in_vain(name):
    """What one side of a seam needs of the other is known to be needed, and not split again each time."""
    mesh, sharp = CREASED[name]()
    for camera, criteria in walk(mesh, 0, 6):
        refined = Sqrt3(mesh, sharp=sharp)
        refined.update(camera, criteria=criteria)
        nearly = Camera.of(camera.position * (1 + 1e-14), camera.target)
        assert (nearly.position != camera.position).any()
        again = refined.update(nearly, criteria=criteria)
        assert (again.split, again.undone) == (0, 0)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", PILLOWS)
def test_two_faces_may_share_several_sharp_edges(name, seed):
    mesh, sharp = PILLOWS[name]()
    refined = Sqrt3(mesh, sharp=sharp)
    for camera, criteria in walk(mesh, seed, 8):
        refined.update(camera, criteria=criteria)
        fresh = Sqrt3(mesh, sharp=sharp)
        fresh.update(camera, criteria=criteria)
        found = refined.mesh()
        assert_same(found, fresh.mesh())
        # Several edges may join the same two vertices here; still each has two faces that run opposite ways.
        edges = np.concatenate([found.faces[:, [k, (k + 1) % 3]] for k in range(3)])
        for one, two in zip(
            np.unique(edges, axis=0, return_counts=True),
            np.unique(edges[:, ::-1], axis=0, return_counts=True),
            strict=True,
        ):
            assert (one == two).all()


@pytest.mark.parametrize("name", ["across", "half", "cube"])
def test_work_spread_over_frames_ends_in_the_same_mesh(name):
    mesh, sharp = CREASED[name]()
    rng = np.random.default_rng(0)
    refined = Sqrt3(mesh, sharp=sharp)
    for camera, criteria in walk(mesh, 0, 12):
        refined.update(camera, criteria=criteria, most_splits=int(rng.integers(0, 60)))
        assert_surface(refined.mesh(), mesh)
    while not refined.update(camera, criteria=criteria, most_splits=50).is_done:
        pass
    fresh = Sqrt3(mesh, sharp=sharp)
    fresh.update(camera, criteria=criteria)
    assert_same(refined.mesh(), fresh.mesh())


@pytest.mark.parametrize("name", CREASED | PILLOWS)
def test_coarsened_it_is_the_control_mesh_bit_for_bit(name):
    mesh, sharp = (CREASED | PILLOWS)[name]()
    refined = Sqrt3(mesh, sharp=sharp)
    refined.update(around(mesh), criteria=Criteria(Region(5, 5.0), Region(8, 3.0), Region(1)))
    assert len(refined.mesh().faces) > len(mesh.faces)
    refined.update(around(mesh), criteria=everywhere(0))
    back = refined.mesh()
    assert (back.positions == mesh.positions).all()
    assert_same(back, mesh)


@pytest.mark.parametrize("name", SURFACES)
def test_no_sharp_edges_are_none(name):
    mesh = SURFACES[name]()
    edges, counts = np.unique(
        np.sort(np.concatenate([mesh.faces[:, [k, (k + 1) % 3]] for k in range(3)]), axis=1),
        axis=0,
        return_counts=True,
    )
    plain, same = Sqrt3(mesh), Sqrt3(mesh, sharp=edges[counts == 1])  # a border is sharp already
    for camera, criteria in walk(mesh, 1, 3):
        for refined in (plain, same):
            refined.update(camera, criteria=criteria)
        for one, two in zip(plain.slots(), same.slots(), strict=True):
            assert one.tobytes() == two.tobytes()


def test_a_sharp_cube_stays_a_cube():
    mesh, sharp = cube()
    assert len(sharp) == 12
    refined = Sqrt3(mesh, sharp=sharp)
    for camera, criteria in [*walk(mesh, 0, 6), (around(mesh), everywhere(5))]:
        refined.update(camera, criteria=criteria)
        for placing in ("control", "limit"):
            found = refined.mesh(positions=placing)
            distance = np.minimum(np.abs(found.positions), np.abs(found.positions - 1)).min(axis=1)
            assert distance.max() <= 1e-15
            assert {tuple(p) for p in mesh.positions} <= {tuple(p) for p in found.positions}
            a, b, c = (found.positions[found.faces[:, k]] for k in range(3))
            normals = np.cross(b - a, c - a)
            assert math.isclose((a * normals).sum() / 6, 1.0, rel_tol=1e-13)
            assert math.isclose(np.abs(normals).sum() / 2, 6.0, rel_tol=1e-13)  # nothing folds over


def test_a_crease_is_the_cubic_spline_of_its_vertices():
    mesh, sharp = across()
    refined = Sqrt3(mesh, sharp=sharp)
    refined.update(around(mesh), criteria=everywhere(0))
    side = mesh.positions.reshape(6, 6, 3)[:, 2]
    expected = (side[:-2] + 4 * side[1:-1] + side[2:]) / 6
    found = refined.mesh(positions="limit").positions.reshape(6, 6, 3)[1:-1, 2]
    assert np.allclose(found[[0, 1, 3]], expected[[0, 1, 3]], rtol=0, atol=1e-15)
    assert (found[2] == side[3]).all()  # from where another crease sets out


@pytest.mark.parametrize("name", ["across", "half", "one_edge"])
def test_refining_commutes_with_affine_maps(name):
    mesh, sharp = CREASED[name]()
    rng = np.random.default_rng(5)
    linear, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    mapped = TriMesh(mesh.positions @ linear + shift, mesh.faces)
    found = []
    for one in (mesh, mapped):
        refined = Sqrt3(one, sharp=sharp)
        refined.update(around(one), criteria=everywhere(4))
        found.append(refined.mesh())
    assert (found[0].faces == found[1].faces).all()
    assert np.allclose(found[0].positions @ linear + shift, found[1].positions, rtol=0, atol=1e-13)


def test_normals_of_the_slots_are_sharp():
    mesh, sharp = cube()
    slots = Sqrt3(mesh, sharp=sharp).slots()
    assert len(slots.positions) == 24  # a corner has three sides
    assert len(Sqrt3(mesh, sharp=sharp).mesh().positions) == 8


def test_sharp_edges_are_those_that_bend_more():
    mesh, sharp = cube()
    diagonals = {tuple(e) for e in edges_of(mesh).tolist()} - {tuple(e) for e in sharp.tolist()}
    assert len(diagonals) == 6
    assert all(np.abs(mesh.positions[a] - mesh.positions[b]).sum() == 2 for a, b in diagonals)
    assert len(sharp_edges(mesh, 1.6)) == 0
    assert len(sharp_edges(pillow([])[0], 3.0)) == 3
    flat = TriMesh.of([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0]], [[0, 1, 3], [1, 0, 2]])
    assert len(sharp_edges(flat, 0.0)) == 0  # one has no area
    with pytest.raises(ValueError, match="angle must be from 0 to pi"):
        sharp_edges(mesh, 4.0)


@pytest.mark.parametrize("sharp", [[[0, 1], [0, 3]], [[0, -1]], [[0, 99]], [[2, 2]]])
def test_what_is_no_edge_is_refused_by_name(sharp):
    mesh = terrain(5)
    a, b = sharp[-1]
    assert [0, 3] not in edges_of(mesh).tolist()
    with pytest.raises(FovealError, match=f"cage.obj: there is no edge between vertices {a} and {b}"):
        Sqrt3(mesh, sharp=sharp, name="cage.obj")


def test_sharp_takes_pairs():
    with pytest.raises(ValueError, match="pairs of vertices"):
        Sqrt3(terrain(5), sharp=[0, 1, 2])
