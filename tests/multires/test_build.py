"""Whole builds: laws of the graph and its cuts, errors against samples, odd inputs, determinism, refusals."""

import numpy as np
import pytest

from foveal import multires
from foveal.base.errors import FovealError
from foveal.mesh.distance import sampled_hausdorff
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, torus
from foveal.mesh.trimesh import TriMesh
from foveal.multires.build import ROOT_TRIANGLES
from foveal.multires.check import boundary_edges


def soup(count, *, size=0.02, seed=1):
    rng = np.random.default_rng(seed)
    corners = rng.random((count, 1, 3)) + size * rng.standard_normal((count, 3, 3))
    return TriMesh.of(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


def tangle(count, vertices, *, seed=1):
    rng = np.random.default_rng(seed)
    return TriMesh.of(rng.random((vertices, 3)), rng.integers(0, vertices, (count, 3)))


def thrice(mesh):
    return TriMesh.of(mesh.positions, np.concatenate([mesh.faces] * 3))


def with_degenerate(mesh):
    """As many triangles without area again: on edges, on far vertices, in one point; and a heap far away."""
    rng = np.random.default_rng(7)
    count, n = len(mesh.faces), len(mesh.positions)
    flat = rng.integers(0, n, (count, 3))
    flat[: count // 2, :2] = mesh.faces[: count // 2, :2]
    flat[:, 2] = flat[:, 0]
    flat[::10] = flat[::10, :1]
    heap = n + rng.integers(0, 50, (count, 3))
    heap[:, 1] = heap[:, 2]
    points = np.concatenate([mesh.positions, 8 + rng.random((50, 3))])
    return TriMesh.of(points, np.concatenate([mesh.faces, flat, heap]))


def proper(mesh):
    a, b, c = mesh.faces.T
    return TriMesh(mesh.positions, mesh.faces[(a != b) & (b != c) & (c != a)])


SHAPES = {
    "bumpy sphere": lambda: bumpy_sphere(5, seed=1),
    "torus": lambda: torus(160, 60),
    "terrain": lambda: terrain(90, seed=2),
    "soup": lambda: soup(3000),
    "tangle": lambda: tangle(1500, 500),
    "each triangle thrice": lambda: thrice(icosphere(3)),
    "half of them degenerate": lambda: with_degenerate(bumpy_sphere(4, seed=4)),
    "one triangle": lambda: TriMesh.of([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
}


@pytest.fixture(scope="module", params=SHAPES)
def built(request, tmp_path_factory):
    mesh = SHAPES[request.param]()
    path = tmp_path_factory.mktemp("built") / "it.fov"
    report = multires.build(mesh, path, cell_triangles=1024)
    with multires.open(path) as asset:
        yield mesh, asset, report


def random_cuts(graph, count, seed=0):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        chance = rng.random() ** 0.3
        expanded = np.zeros(len(graph.errors), bool)
        expanded[0] = True
        for node in range(1, len(expanded)):
            expanded[node] = expanded[graph.parents[node]].all() and rng.random() < chance
        yield expanded


def test_every_triangle_comes_back(built):
    mesh, asset, report = built
    full = asset.mesh_of(np.ones(len(asset.graph.errors), bool))
    assert int(asset.graph.triangles[asset.graph.finer < 0].sum()) == report.repairs.triangles
    assert asset.header["triangles"] == report.repairs.triangles == len(full.faces) == len(mesh.faces)
    a, b, c = mesh.faces.T
    assert report.repairs.degenerate == ((a == b) | (b == c) | (c == a)).sum()
    # The same middles of triangles, as far as the grid allows.
    ours = np.sort(full.positions[full.faces].mean(axis=1), axis=0)
    given = np.sort(mesh.positions[mesh.faces].mean(axis=1), axis=0)
    np.testing.assert_allclose(ours, given, atol=report.step)


def test_bounds_and_spheres_are_nested(built):
    _, asset, _ = built
    graph = asset.graph
    assert graph.errors[0] == np.inf
    for node, parents in enumerate(graph.parents):
        assert node == 0 or len(parents)
        for parent in parents:
            assert parent < node
            assert graph.errors[parent] >= graph.errors[node]
            apart = np.linalg.norm(graph.centres[parent] - graph.centres[node])
            assert apart + graph.radii[node] <= graph.radii[parent] * (1 + 1e-6)


def test_a_cut_has_boundary_edges_only_where_the_mesh_has_some(built):
    mesh, asset, _ = built
    is_open = boundary_edges(mesh.faces) > 0
    for expanded in random_cuts(asset.graph, 40):
        assert (boundary_edges(asset.mesh_of(expanded).faces) > 0) == is_open


def test_no_cut_is_farther_from_the_original_than_its_nodes_promise(built):
    mesh, asset, _ = built
    graph = asset.graph
    for error in np.unique(graph.errors[1:])[:: max(1, len(graph.errors) // 6)]:
        expanded = graph.errors > error
        found = max(sampled_hausdorff(proper(asset.mesh_of(expanded)), proper(mesh), samples=20_000))
        assert found <= graph.errors[~expanded].max()


def test_the_root_is_small(built):
    _, asset, _ = built
    assert asset.graph.triangles[0] <= ROOT_TRIANGLES


def test_check_agrees(built, tmp_path):
    mesh, asset, _ = built
    report = multires.check(asset.name, deep=True, original=mesh)
    assert report.nodes == len(asset.graph.errors)
    assert min(report.looseness, default=1.0) >= 1.0


@pytest.mark.parametrize("options", [{"workers": 1}, {"workers": 3}, {"memory_bytes": 1 << 20}])
def test_the_bytes_depend_on_nothing_but_input_and_options(options, tmp_path):
    mesh = bumpy_sphere(5, seed=3)
    multires.build(mesh, tmp_path / "a.fov", cell_triangles=1024)
    multires.build(mesh, tmp_path / "b.fov", cell_triangles=1024, **options)
    assert (tmp_path / "a.fov").read_bytes() == (tmp_path / "b.fov").read_bytes()


def test_attributes_are_carried_to_the_root(tmp_path):
    ball = icosphere(5)
    colours = np.where(ball.positions[:, :1] > 0, [[250, 20, 20]], [[20, 20, 250]]).astype(np.uint8)
    mesh = TriMesh.of(ball.positions, ball.faces, normals=-ball.positions, colours=colours)
    multires.build(mesh, tmp_path / "c.fov", cell_triangles=2048)
    with multires.open(tmp_path / "c.fov") as asset:
        for error in (np.inf, 0.0):
            cut = asset.mesh_of(asset.graph.errors >= error)
            outward = cut.positions / np.linalg.norm(cut.positions, axis=1, keepdims=True)
            assert (np.einsum("ij,ij->i", cut.normals, -outward) > 0.97).all()
            far = np.abs(cut.positions[:, 0]) > 0.2
            red = cut.colours[:, 0] > 128
            assert (red[far] == (cut.positions[far, 0] > 0)).all()


def test_normals_made_of_faces_have_no_seams(tmp_path):
    multires.build(icosphere(5), tmp_path / "n.fov", cell_triangles=2048)
    with multires.open(tmp_path / "n.fov") as asset:
        full = asset.mesh_of(np.ones(len(asset.graph.errors), bool))
    assert len(full.positions) == 10242  # borders are welded, nothing else
    assert (np.einsum("ij,ij->i", full.normals, full.positions) > 0.99).all()


def test_large_coordinates_do_not_jitter(tmp_path):
    near, far = icosphere(4), icosphere(4)
    far = TriMesh.of(far.positions + np.array([5e5, 5.3e6, 100]), far.faces)
    for mesh, name in ((near, "near"), (far, "far")):
        multires.build(mesh, tmp_path / f"{name}.fov", bits=14)
    with multires.open(tmp_path / "far.fov") as asset:
        full = asset.mesh_of(np.ones(len(asset.graph.errors), bool))
        found = max(sampled_hausdorff(full, far))
        assert found <= asset.header["finest_error"]


def test_coincident_vertices_are_welded_and_counted(tmp_path):
    ball = icosphere(3)
    loose = TriMesh.of(ball.positions[ball.faces].reshape(-1, 3), np.arange(3 * 1280).reshape(-1, 3))
    report = multires.build(loose, tmp_path / "w.fov")
    assert report.repairs.vertices == 642
    assert report.repairs.welded == 3840 - 642
    assert report.repairs.boundary_edges == report.repairs.nonmanifold_edges == 0


def test_oddities_are_counted(tmp_path):
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [9, 9, 9], [0, -1, 0]]
    faces = [[0, 1, 2], [2, 0, 1], [0, 1, 3], [1, 1, 2], [0, 1, 5]]
    repairs = multires.build(TriMesh.of(positions, faces), tmp_path / "o.fov").repairs
    assert (repairs.triangles, repairs.degenerate, repairs.duplicate, repairs.unused) == (5, 1, 1, 1)
    assert repairs.nonmanifold_edges == 1  # 0-1 has four
    assert repairs.boundary_edges == 4  # two each of the triangles that are there once


def test_only_degenerate_triangles_are_refused_and_leave_nothing(tmp_path):
    with pytest.raises(FovealError, match="two corners"):
        multires.build(TriMesh.of([[0, 0, 0], [1, 0, 0]], [[0, 1, 1]]), tmp_path / "d.fov")
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_leaves_nothing(tmp_path):
    class Impatient:
        def stage(self, what, total):
            if what == "Compressing":
                raise KeyboardInterrupt
            from foveal.base.progress import SILENT

            return SILENT.stage(what, total)

        def note(self, sentence):
            pass

    with pytest.raises(KeyboardInterrupt):
        multires.build(icosphere(3), tmp_path / "i.fov", progress=Impatient())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "options",
    [{"bits": 0}, {"bits": 40}, {"bits": 8, "step": 1.0}, {"cell_triangles": 3}, {"normals": "some"}],
)
def test_wrong_options_are_refused(options, tmp_path):
    with pytest.raises(ValueError):
        multires.build(icosphere(1), tmp_path / "x.fov", **options)


def test_a_step_too_small_is_refused(tmp_path):
    with pytest.raises(FovealError, match="too small"):
        multires.build(icosphere(1), tmp_path / "x.fov", step=1e-12)


@pytest.mark.parametrize("size", [1e-300, 1e-35, 1e35, 1e300])
def test_sizes_that_float32_cannot_hold_get_a_sentence(size, tmp_path):
    mesh = icosphere(1)
    mesh = TriMesh.of(mesh.positions * size, mesh.faces)
    with pytest.raises(FovealError, match="Scale the model"):
        multires.build(mesh, tmp_path / "a.fov")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("options", "error", "sentence"),
    [
        ({"step": 100.0}, FovealError, "too large for a model of size"),
        ({"step": 1e-12}, FovealError, "too small for a model of size"),
        ({"step": float("nan")}, ValueError, "positive length"),
        ({"step": -1.0}, ValueError, "positive length"),
        ({"bits": 2.5}, ValueError, "whole number"),
        ({"bits": 0}, ValueError, "whole number"),
        ({"memory_bytes": -1}, ValueError, "must be positive"),
    ],
)
def test_impossible_options_are_refused(options, error, sentence, tmp_path):
    with pytest.raises(error, match=sentence):
        multires.build(icosphere(2), tmp_path / "a.fov", **options)
