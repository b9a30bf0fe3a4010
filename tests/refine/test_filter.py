"""√3 refinement as published: its history leads back bit for bit; all split it is Kobbelt's surface."""

import numpy as np
import pytest
from scipy.spatial import KDTree

from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region
from foveal.refine import filter as room
from foveal.refine.filter import Sqrt3Filter
from refine import naive_filter as naive
from refine.naive_sqrt3 import subdivided
from refine.test_sqrt3 import SURFACES, around, assert_surface, everywhere, turned

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
        if refined.label:
            refined.rewind()
        assert state(refined) == first
    assert (refined.mesh().positions == mesh.positions).all()
    assert (refined.mesh().faces == mesh.faces).all()


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", SURFACES)
def test_step_by_step_it_is_what_its_slow_twin_does(name, seed):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(seed)
    camera = around(mesh, rng.uniform(0, 6), rng.uniform(-0.5, 0.5), rng.choice([0.4, 0.9]))
    criteria = Criteria(Region(2, 30.0, 0.1), Region(4, 20.0), Region(int(rng.integers(0, 2)), 60.0))
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
