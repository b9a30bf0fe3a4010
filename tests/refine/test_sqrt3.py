"""√3 refinement: where it is complete it is Kobbelt's surface, and it depends on nothing but the view."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from foveal.base.errors import FovealError
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region, Sqrt3
from refine.naive_sqrt3 import subdivided
from refine.surfaces import SURFACES, around, assert_same, assert_surface, everywhere, turned


@pytest.mark.parametrize("level", range(5))
@pytest.mark.parametrize("name", SURFACES)
def test_everywhere_it_is_uniform_subdivision(name, level):
    mesh = SURFACES[name]()
    refined = Sqrt3(mesh)
    refined.update(around(mesh), criteria=everywhere(level))
    found = refined.mesh()
    positions, faces = subdivided(mesh.positions, mesh.faces, level)
    size = np.linalg.norm(np.ptp(mesh.positions, axis=0))
    distance, index = KDTree(positions).query(found.positions)
    assert distance.max() <= 1e-13 * size
    assert turned(index[found.faces]) == turned(faces)


@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize(
    "name", ["tetrahedron", "octahedron", "cheburashka68", "cheburashka562", "opengrid_tri"]
)
def test_everywhere_it_is_what_cgal_makes(name, level, shared_data):
    path = shared_data(f"../reference/sqrt3_cgal_{name}_L{level}.npz")
    data = np.load(path, allow_pickle=False)
    mesh = TriMesh.of(data["V0"], data["F0"])
    refined = Sqrt3(mesh)
    refined.update(around(mesh), criteria=everywhere(level))
    found = refined.mesh()
    distance, index = KDTree(data["V"]).query(found.positions)
    assert distance.max() <= 1e-12 * np.linalg.norm(np.ptp(data["V"], axis=0))
    assert turned(index[found.faces]) == turned(data["F"])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", SURFACES)
def test_the_mesh_depends_on_the_view_alone(name, seed):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(seed)
    refined = Sqrt3(mesh)
    angle = rng.uniform(0, 6)
    for _ in range(8):
        angle += rng.choice([0.02, 0.3, 3.0])
        camera = around(mesh, angle, rng.uniform(-0.5, 0.5), rng.choice([0.3, 0.8, 2.0]))
        px = float(rng.choice([20, 40]))
        criteria = Criteria(Region(4, px), Region(7, px / 2, 0.05), Region(int(rng.integers(0, 2))))
        refined.update(camera, criteria=criteria)
        fresh = Sqrt3(mesh)
        fresh.update(camera, criteria=criteria)
        assert_same(refined.mesh(), fresh.mesh())
        assert_surface(refined.mesh(), mesh)


@pytest.mark.parametrize("name", ["tetrahedron", "icosphere", "bumpy"])
def test_no_long_edge_is_left_in_view_beside_backs_that_stay_coarse(name):
    mesh = SURFACES[name]()
    criteria = Criteria(Region(16, 12.0), Region(16, 12.0), Region(0))
    for turn in range(12):
        camera = around(mesh, 0.5 * turn, 0.4 * np.sin(turn), 0.8)
        refined = Sqrt3(mesh)
        refined.update(camera, criteria=criteria)
        found = refined.mesh()
        corners = found.positions[found.faces]
        edges = np.roll(corners, -1, axis=1) - corners
        middle = corners.mean(axis=1)
        sight = camera.position - middle
        is_front = (np.cross(edges[:, 0], edges[:, 1]) * sight).sum(axis=1) > 0
        longest = np.linalg.norm(edges, axis=2).max(axis=1)
        pixels = camera.pixels_per_radian() * longest / np.linalg.norm(sight, axis=1)
        # A quarter: asked is the triangle on its level, shown on the highest of its vertices'.
        assert pixels[is_front].max() <= 1.25 * 12.0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", ["bumpy", "terrain"])
def test_work_spread_over_frames_ends_in_the_same_mesh(name, seed):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(seed)
    refined = Sqrt3(mesh)
    criteria = Criteria(Region(5, 12.0), Region(7, 6.0))
    for frame in range(12):  # it is never done before the camera moves on
        camera = around(mesh, 0.1 * frame, closeness=0.6)
        done = refined.update(camera, criteria=criteria, most_splits=int(rng.integers(0, 60)))
        assert_surface(refined.mesh(), mesh)
    assert not done.is_done
    while not refined.update(camera, criteria=criteria, most_splits=50).is_done:
        pass
    fresh = Sqrt3(mesh)
    fresh.update(camera, criteria=criteria)
    assert_same(refined.mesh(), fresh.mesh())


@pytest.mark.parametrize("name", ["tetrahedron", "icosphere", "torus", "bumpy"])
def test_limits_are_where_two_levels_of_uniform_subdivision_point_to(name):
    mesh = SURFACES[name]()
    before, _ = subdivided(mesh.positions, mesh.faces, 3)
    after, _ = subdivided(mesh.positions, mesh.faces, 4)
    after = after[: len(before)]
    valences = np.full(len(before), 6)
    valences[: len(mesh.positions)] = np.bincount(mesh.faces.reshape(-1))
    shrink = ((2 + 2 * np.cos(2 * np.pi / valences)) / 9)[:, None]  # (2 cos(pi / n) / 3)^2
    limits = (after - shrink * before) / (1 - shrink)
    refined = Sqrt3(mesh)
    refined.update(around(mesh), criteria=everywhere(3))
    found = refined.mesh(positions="limit").positions
    distance, index = KDTree(limits).query(found)
    assert distance.max() <= 1e-13 * np.linalg.norm(np.ptp(mesh.positions, axis=0))
    assert len(np.unique(index)) == len(limits)


@pytest.mark.parametrize("positions", ["control", "limit"])
def test_a_vertex_without_faces_stays(positions):
    ball = icosphere(0)
    mesh = TriMesh(np.concatenate([ball.positions, [[7.0, 8.0, 9.0]]]), ball.faces)
    refined = Sqrt3(mesh)
    refined.update(around(ball), criteria=everywhere(1))
    assert (refined.mesh(positions=positions).positions == [7.0, 8.0, 9.0]).all(axis=1).any()


def test_limits_of_a_border_are_those_of_its_cubic_spline():
    mesh = terrain(4)
    refined = Sqrt3(mesh)
    refined.update(around(mesh), criteria=everywhere(0))
    slots = refined.slots(positions="limit")
    n = 5
    side = mesh.positions.reshape(n, n, 3)[0]
    expected = (side[:-2] + 4 * side[1:-1] + side[2:]) / 6
    assert np.allclose(slots.positions.reshape(n, n, 3)[0, 1:-1], expected, rtol=0, atol=1e-15)


def test_slots_that_did_not_change_stay_where_they_are():
    mesh = bumpy_sphere(2, seed=3)
    refined = Sqrt3(mesh)
    criteria = Criteria(Region(4, 8.0), Region(6, 4.0))
    refined.update(around(mesh, 0.0), criteria=criteria)
    before = refined.slots()
    done = refined.update(around(mesh, 0.02), criteria=criteria)
    after = refined.slots()
    count = min(len(before.faces), len(after.faces))
    changed = (before.faces[:count] != after.faces[:count]).any(axis=1).sum()
    assert 0 < changed <= 6 * (done.split + done.undone)  # the face's thirds and their mates
    is_face = after.faces[:, 0] != after.faces[:, 1]
    assert is_face.sum() == done.faces
    assert after.levels[is_face].max() == 6
    assert not after.levels[~is_face].any()


@pytest.mark.parametrize("name", SURFACES)
def test_coarsened_it_is_the_control_mesh_bit_for_bit(name):
    mesh = SURFACES[name]()
    refined = Sqrt3(mesh)
    refined.update(around(mesh), criteria=Criteria(Region(5, 5.0), Region(8, 3.0), Region(1)))
    assert len(refined.mesh().faces) > len(mesh.faces)
    refined.update(around(mesh), criteria=everywhere(0))
    back = refined.mesh()
    assert (back.positions == mesh.positions).all()
    assert_same(back, mesh)


@pytest.mark.parametrize(
    ("faces", "words"),
    [
        ([[0, 1, 2], [0, 1, 3], [1, 0, 4]], "edge between vertices 0 and 1"),
        ([[0, 1, 2], [0, 1, 3], [2, 3, 4]], "face opposite sides"),
        ([[0, 1, 2], [0, 3, 4]], "at vertex 0 several fans"),
        ([[0, 1, 1], [0, 3, 4]], "triangle 0 has the same vertex twice"),
    ],
)
def test_what_is_no_surface_is_refused_by_name(faces, words):
    positions = np.random.default_rng(0).normal(size=(5, 3))
    with pytest.raises(FovealError, match=words):
        Sqrt3(TriMesh.of(positions, faces), name="cage.obj")


def test_an_update_says_what_it_did_and_memory_is_flat():
    mesh = bumpy_sphere(2)
    refined = Sqrt3(mesh)
    first = refined.update(around(mesh), criteria=everywhere(4))
    found = refined.mesh()
    assert (
        (first.faces, first.vertices) == (len(found.faces), len(found.positions)) == (81 * 320, 81 * 160 + 2)
    )
    assert (first.split, first.undone) == (first.vertices - len(mesh.positions), 0)
    assert refined.bytes_used <= 200 * first.faces
    assert refined.update(around(mesh), criteria=everywhere(4)).split == 0
    assert refined.update(around(mesh), criteria=everywhere(0)).undone == first.split
