"""√3 refinement as published: its history leads back bit for bit; all split it is Kobbelt's surface."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from foveal.mesh.shapes import bumpy_sphere, icosphere, tetrahedron
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region, Sqrt3, sqrt3
from foveal.refine import filter as room
from foveal.refine.cage import Cage
from foveal.refine.filter import Sqrt3Filter
from refine import naive_filter as naive
from refine.naive_sqrt3 import subdivided
from refine.surfaces import SURFACES, around, assert_surface, everywhere, turned

FINE = Criteria(Region(4, 20.0), Region(6, 8.0))


def state(refined):
    """All that an action changes, as bytes."""
    net = refined._net
    faces, vertices = net.counts[:2]
    of_faces = (a[:faces].tobytes() for a in (net.corners, net.beside, net.levels))
    return (
        *of_faces,
        net.positions[:vertices].tobytes(),
        net.around[:vertices].tobytes(),
        net.counts.tobytes(),
    )


@pytest.fixture
def states(monkeypatch):
    """The state after each step, as it was on the way there, of the refinement put into it first."""
    seen = []

    def watched(function):
        def run(*arguments):
            result = function(*arguments)
            seen.append(state(seen[0]))
            return result

        return run

    for module, name in (
        (room.steps, "split_all"),
        (room.relax, "move_all"),
        (room.steps, "swap_all"),
    ):
        monkeypatch.setattr(module, name, watched(getattr(module, name)))
    return seen


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", SURFACES)
def test_every_state_back_to_the_control_mesh_is_restored_bit_for_bit(name, seed, states):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(seed)
    refined = Sqrt3Filter(mesh)
    states.append(refined)
    first = state(refined)
    for _ in range(3):
        del states[1:]
        camera = around(mesh, rng.uniform(0, 6), rng.uniform(-0.5, 0.5), rng.choice([0.3, 0.8]))
        refined.update(camera, criteria=Criteria(Region(4, 9.0), Region(6, 5.0, 0.02)))
        assert len(states) == 1 + refined.label
        for label in range(refined.label - 1, 0, -1):
            refined.rewind(to=label)
            assert state(refined) == states[label]
            assert_surface(refined.mesh(), mesh)
            beside = refined._net.beside[: len(refined.mesh().faces)]
            assert (Cage.of(refined.mesh()).beside == beside).all()
        if refined.label:
            refined.rewind()
        assert state(refined) == first
    assert (refined.mesh().positions == mesh.positions).all()
    assert (refined.mesh().faces == mesh.faces).all()


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", SURFACES)
def test_step_by_step_it_is_what_its_slow_twin_does(name, seed):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(seed)
    camera = around(mesh, rng.uniform(0, 6), rng.uniform(-0.5, 0.5), rng.choice([0.4, 0.9]))
    front = Region(3, float(rng.choice([0.0, 80.0])), float(rng.choice([0.0, 0.05])))
    silhouette = Region(int(rng.choice([1, 4])), float(rng.choice([40.0, 150.0])))
    criteria = Criteria(front, silhouette, Region(int(rng.integers(0, 4)), 100.0))
    budget = int(rng.choice([len(mesh.faces) + 7, 300, 2000]))
    refined = Sqrt3Filter(mesh)
    refined.update(camera, criteria=criteria, budget=budget)
    expected = naive.refined(mesh.positions, mesh.faces, camera, criteria, budget)
    assert refined.label == len(expected) - 1
    for label in range(refined.label, -1, -1):
        refined.rewind(to=label)
        positions, faces = expected[label]
        found = refined.mesh()
        assert found.faces.tolist() == faces
        assert np.abs(found.positions - positions).max() <= 1e-13 * np.ptp(mesh.positions)


@pytest.mark.parametrize("level", range(5))
@pytest.mark.parametrize("name", SURFACES)
def test_everywhere_it_is_uniform_subdivision(name, level):
    mesh = SURFACES[name]()
    refined = Sqrt3Filter(mesh)
    refined.update(around(mesh), criteria=everywhere(level))
    found = refined.mesh()
    positions, faces = subdivided(mesh.positions, mesh.faces, level)
    distance, index = KDTree(positions).query(found.positions)
    assert distance.max() <= 1e-13 * np.linalg.norm(np.ptp(mesh.positions, axis=0))
    assert turned(index[found.faces]) == turned(faces)


@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize(
    "name", ["tetrahedron", "octahedron", "cheburashka68", "cheburashka562", "opengrid_tri"]
)
def test_everywhere_it_is_what_cgal_makes(name, level, shared_data):
    path = shared_data(f"../reference/sqrt3_cgal_{name}_L{level}.npz")
    data = np.load(path, allow_pickle=False)
    mesh = TriMesh.of(data["V0"], data["F0"])
    refined = Sqrt3Filter(mesh)
    refined.update(around(mesh), criteria=everywhere(level))
    found = refined.mesh()
    distance, index = KDTree(data["V"]).query(found.positions)
    assert distance.max() <= 1e-12 * np.linalg.norm(np.ptp(data["V"], axis=0))
    assert turned(index[found.faces]) == turned(data["F"])


@pytest.mark.parametrize("name", SURFACES)
def test_the_mesh_does_not_depend_on_earlier_views(name):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(7)
    refined = Sqrt3Filter(mesh)
    for _ in range(4):
        camera = around(mesh, rng.uniform(0, 6), rng.uniform(-0.5, 0.5), rng.choice([0.3, 0.8]))
        refined.update(camera, criteria=FINE)
        fresh = Sqrt3Filter(mesh)
        fresh.update(camera, criteria=FINE)
        assert state(refined) == state(fresh)


@pytest.mark.parametrize("budget", [0, 320, 321, 500, 1501, 4000, 10**6])
def test_the_sequence_ends_where_the_next_split_would_pass_the_budget(budget):
    mesh = bumpy_sphere(2, seed=3)
    refined = Sqrt3Filter(mesh)
    done = refined.update(around(mesh), criteria=FINE, budget=budget)
    assert done.faces == len(refined.mesh().faces)
    assert done.faces <= max(budget, 320)
    assert done.is_done == (budget == 10**6)
    assert done.is_done or done.faces + 2 > budget
    assert_surface(refined.mesh(), mesh)


def test_no_swap_makes_an_edge_twice():
    mesh = tetrahedron()  # swaps around a single split face would leave corners of valence three with two
    refined = Sqrt3Filter(mesh)
    refined.update(around(mesh), criteria=everywhere(1), budget=6)
    assert_surface(refined.mesh(), mesh)
    assert np.bincount(refined.mesh().faces.ravel()).min() == 3


@pytest.mark.parametrize("name", ["tetrahedron", "icosphere", "torus", "bumpy", "terrain", "with_hole"])
def test_everywhere_limits_are_those_of_the_exact_mode(name):
    mesh, level = SURFACES[name](), 2  # after odd iterations vertices beside a border have a ring to come
    found, exact = Sqrt3Filter(mesh), Sqrt3(mesh)
    for refined in (found, exact):
        refined.update(around(mesh), criteria=everywhere(level))
    a, b = found.mesh(positions="limit"), exact.mesh(positions="limit")
    used = np.unique(a.faces)
    distance, index = KDTree(b.positions).query(a.positions[used])
    assert distance.max() <= 1e-12 * np.linalg.norm(np.ptp(mesh.positions, axis=0))
    assert len(np.unique(index)) == len(used)
    alone = np.setdiff1d(np.arange(len(mesh.positions)), used)
    assert (a.positions[alone] == mesh.positions[alone]).all()


def test_slots_say_where_vertices_were_born_and_how_often_faces_were_split():
    mesh = icosphere(1)
    refined = Sqrt3Filter(mesh)
    done = refined.update(around(mesh), criteria=everywhere(3))
    slots, exact = refined.slots(), Sqrt3(mesh)
    exact.update(around(mesh), criteria=everywhere(3))
    assert (slots.faces == refined.mesh().faces).all()
    assert (slots.positions == refined.mesh().positions).all()
    assert (slots.levels == 3).all()
    assert not slots.colours.any()
    assert len(slots.levels) == len(slots.colours) == done.faces
    assert (slots.starts[: len(mesh.positions)] == mesh.positions).all()
    expected = exact.slots()
    _, index = KDTree(expected.positions).query(slots.positions)
    assert np.abs(expected.starts[index] - slots.starts).max() <= 1e-14
    refined.rewind()
    assert (refined.slots().starts == mesh.positions).all()
    assert not refined.slots().levels.any()


def test_an_update_says_what_it_did_and_memory_is_flat():
    mesh = bumpy_sphere(2)
    refined = Sqrt3Filter(mesh)
    first = refined.update(around(mesh), criteria=everywhere(4))
    assert (first.faces, first.vertices) == (81 * 320, 81 * 160 + 2)
    assert (first.split, first.undone) == (first.vertices - len(mesh.positions), 0)
    assert refined.bytes_used <= 70 * first.faces  # measured: 61, the history with it; 200 are allowed
    assert sum(a.nbytes for a in refined._net) <= 200 * first.faces  # and what is held for the next view
    second = refined.update(around(mesh), criteria=everywhere(0))
    assert (second.faces, second.split, second.undone) == (320, 0, first.split)


def test_a_label_that_is_not_there_is_refused():
    refined = Sqrt3Filter(icosphere(0))
    refined.update(around(icosphere(0)), criteria=everywhere(2))
    for label in (-1, 7):
        with pytest.raises(ValueError, match="to must be a label from 0 to 6"):
            refined.rewind(to=label)


def test_it_is_a_mode_of_sqrt3():
    mesh, camera = icosphere(1), around(icosphere(1))
    refined = Sqrt3Filter(mesh)
    refined.update(camera)
    assert (sqrt3(mesh, camera, mode="filter").faces == refined.mesh().faces).all()
    with pytest.raises(ValueError, match="mode must be exact or filter, got 'fast'"):
        sqrt3(mesh, camera, mode="fast")
    with pytest.raises(ValueError, match="no sharp edges"):
        sqrt3(mesh, camera, mode="filter", sharp=[[0, 1]])


@pytest.mark.parametrize("budget", [None, 3000])
def test_work_spread_over_frames_ends_in_the_same_mesh(budget):
    mesh = bumpy_sphere(2, seed=3)
    refined, fresh = Sqrt3Filter(mesh), Sqrt3Filter(mesh)
    refined.update(around(mesh, 1.0), criteria=FINE, most_splits=300)  # it never ends: the camera moves on
    whole = fresh.update(around(mesh), criteria=FINE, budget=budget)
    splits = []
    for _ in range(12):
        done = refined.update(around(mesh), criteria=FINE, most_splits=200, budget=budget)
        assert_surface(refined.mesh(), mesh)
        splits.append(done.split)
        assert done.is_done <= whole.is_done
    assert splits[0] < whole.split == sum(splits)
    assert splits[-1] == 0
    assert done.is_done == whole.is_done == (budget is None)
    assert state(refined) == state(fresh)
