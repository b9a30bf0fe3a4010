"""What the overlay says of the faces that it does not leave open is true, wherever the places are."""

import numpy as np
import pytest

import corpus
import naive
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, torus
from foveal.mesh.trimesh import TriMesh
from foveal.multires._kernels_surface import spread
from foveal.multires.overlay import Surface, overlay
from foveal.multires.simplify import simplify, twins

INSIDE = np.array(
    [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 1, 0],
        [0, 1, 1],
        [1, 0, 1],
        [1, 1, 1],
        [8, 1, 1],
        [1, 8, 1],
        [1, 1, 8],
    ],
    float,
)
INSIDE /= INSIDE.sum(axis=1, keepdims=True)


def surface(positions, faces):
    positions, faces = np.asarray(positions, float), np.asarray(faces, np.int32)
    return Surface(positions, faces, twins(faces, len(positions)))


def halved(mesh, scale=2000, locked=None, share=2):
    """A mesh on a grid, what simplification makes of it, which vertices stayed, and where faces went."""
    faces = mesh.faces[(mesh.faces != np.roll(mesh.faces, 1, axis=1)).all(axis=1)]
    extent = np.ptp(mesh.positions, axis=0).max()
    positions = np.round((mesh.positions - mesh.positions[0]) * (scale / extent))
    locked = np.zeros(len(positions), bool) if locked is None else locked
    size = len(faces)
    coarse = simplify(positions, faces, locked, target=size // share, relaxed_above=size)
    start = np.full(size, -1, np.int32)
    start[coarse.origin] = np.arange(len(coarse.faces))
    fine = surface(positions, faces)
    spread(start, fine.twins, np.empty(size, np.int32))
    start[start < 0] = 0
    return fine, surface(coarse.positions, coarse.faces), coarse.kept, start


def assert_true(fine, coarse, errors, is_open, is_open_onto):
    """Each point of a face that is not open has a point of the other surface within the bound."""
    ours, theirs = fine.positions[fine.faces], coarse.positions[coarse.faces]
    for g in np.flatnonzero(~is_open_onto):
        assert naive.all_distances(INSIDE @ theirs[g], ours).min(axis=1).max() <= errors[g] + 1e-6
    for f in np.flatnonzero(~is_open):
        assert (naive.all_distances(INSIDE @ ours[f], theirs) <= errors + 1e-6).any(axis=1).all()


def measured(fine, coarse, kept, start, suspicious=np.inf):
    errors = np.zeros(len(coarse.faces))
    carried = np.zeros(len(fine.faces))
    return errors, *overlay(fine, coarse, kept, start, carried, suspicious, errors)


@pytest.mark.parametrize("name", sorted(corpus.MESHES))
def test_bounds_are_true_for_any_mesh(name):
    mesh = corpus.MESHES[name]()
    mesh = TriMesh(mesh.positions, mesh.faces[:400])
    fine, coarse, kept, start = halved(mesh)
    assert_true(fine, coarse, *measured(fine, coarse, kept, start))


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("make", [lambda: icosphere(2), lambda: terrain(9), lambda: torus(12, 8)])
def test_bounds_are_true_wherever_the_places_are(make, seed):
    """The coarse vertices thrown about, searches begun anywhere: bounds become large, never wrong."""
    rng = np.random.default_rng(seed)
    fine, coarse, kept, start = halved(make())
    wild = coarse.positions + rng.normal(0, 15 * (1 + seed), coarse.positions.shape)
    stays = rng.random(len(wild)) < 0.3  # so that some borders are matched
    wild[stays] = coarse.positions[stays]
    coarse = Surface(wild, coarse.faces, coarse.twins)
    start = rng.integers(0, len(coarse.faces), len(start)).astype(np.int32)
    assert_true(fine, coarse, *measured(fine, coarse, kept, start))


@pytest.mark.parametrize("seed", range(12))
def test_bounds_are_true_of_any_two_surfaces(seed):
    """Two triangulations that have nothing to do with each other."""
    rng = np.random.default_rng(seed)

    def random_surface(n, m):
        corners = rng.integers(0, n, (m, 3))
        corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
        return surface(rng.integers(0, 40, (n, 3)), corners)

    fine, coarse = random_surface(30, 60), random_surface(20, 40)
    kept = rng.integers(0, 30, 20).astype(np.int32)
    start = rng.integers(0, len(coarse.faces), len(fine.faces)).astype(np.int32)
    assert_true(fine, coarse, *measured(fine, coarse, kept, start))


@pytest.mark.parametrize("make", [lambda: bumpy_sphere(5), lambda: torus(90, 40), lambda: terrain(60)])
def test_little_is_left_open(make):
    mesh = make()
    edges = naive.edge_uses(mesh.faces)
    locked = np.zeros(len(mesh.positions), bool)
    locked[[v for edge, uses in edges.items() if uses == 1 for v in edge]] = True
    _, is_open, is_open_onto = measured(*halved(mesh, 20_000, locked))
    assert is_open.mean() < 0.05
    assert is_open_onto.mean() < 0.05


def test_what_is_carried_is_added():
    fine, coarse, kept, start = halved(icosphere(3))
    plain = measured(fine, coarse, kept, start)[0]
    loaded = np.zeros(len(coarse.faces))
    overlay(fine, coarse, kept, start, np.full(len(fine.faces), 7.0), np.inf, loaded)
    np.testing.assert_allclose(loaded, plain + 7)


def test_what_is_suspicious_is_left_open():
    fine, coarse, kept, start = halved(icosphere(3))
    errors, is_open, is_open_onto = measured(fine, coarse, kept, start, suspicious=-1.0)
    assert is_open.all()
    assert is_open_onto.all()
    assert not errors.any()
