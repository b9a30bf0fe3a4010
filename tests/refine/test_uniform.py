"""Uniform subdivision: what other libraries make, the plain twins, and what must hold for every surface."""

import numpy as np
import pytest
from scipy.spatial import KDTree

import corpus
from foveal.base.errors import FovealError
from foveal.mesh.shapes import bumpy_sphere, grid_patch, icosphere, terrain, tetrahedron, torus
from foveal.mesh.trimesh import TriMesh
from foveal.refine import butterfly, loop
from refine import naive_uniform as naive

SURFACES = {
    "tetrahedron": tetrahedron,
    "icosphere": lambda: icosphere(1),
    "torus": lambda: torus(7, 5),
    "bumpy": lambda: bumpy_sphere(2, seed=3),
    "terrain": lambda: terrain(5),
    "rough": lambda: jolted(grid_patch(4, 3)),
    **{name: corpus.MESHES[name] for name in ("with_hole", "single_triangle", "two_triangles")},
    "two_pieces": lambda: corpus.joined(icosphere(0), TriMesh(terrain(3).positions + 9, terrain(3).faces)),
    "unused_vertex": lambda: TriMesh.of([[9, 9, 9], [0, 0, 0], [1, 0, 0], [0, 1, 0]], [[1, 2, 3]]),
}
CLOSED = ["tetrahedron", "octahedron", "cheburashka68", "cheburashka562"]


def jolted(mesh, seed=1):
    """The mesh with noise and some corners cut off, so that its border has vertices of many valences."""
    rng = np.random.default_rng(seed)
    return TriMesh(mesh.positions + rng.normal(scale=0.1, size=mesh.positions.shape), mesh.faces[1:-2])


def turned(faces):
    """The set of triangles, each beginning with its least vertex."""
    return {tuple(np.roll(row, -np.argmin(row))) for row in faces.tolist()}


def assert_same(mesh, positions, faces, tolerance):
    """The same surface to a share of the diagonal, in any order; returns the truth's row of each vertex."""
    assert (len(mesh.positions), len(mesh.faces)) == (len(positions), len(faces))
    distance, index = KDTree(positions).query(mesh.positions)
    assert distance.max() <= tolerance * np.linalg.norm(np.ptp(positions, axis=0))
    assert len(np.unique(index)) == len(index)
    assert turned(index[mesh.faces]) == turned(faces)
    return index


def edge_count(faces):
    return len(np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0))


def euler(mesh):
    return len(mesh.positions) - edge_count(mesh.faces) + len(mesh.faces)


def reference(shared_data, name):
    data = np.load(shared_data(f"../reference/{name}.npz"), allow_pickle=False)
    return data, TriMesh.of(data["V0"], data["F0"])


@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize("name", [*CLOSED, "opengrid_tri", "corner_opengrid_tri"])
def test_loop_is_what_opensubdiv_makes(name, level, shared_data):
    data, mesh = reference(shared_data, f"loop_osd_{name}_L{level}")
    boundary = "corner" if name.startswith("corner") else "edge"
    made = loop(mesh, level, boundary=boundary, has_normals=True)
    index = assert_same(made, data["V"], data["F"], 1e-12)
    ends = loop(mesh, level, boundary=boundary, positions="limit").positions
    assert abs(ends - data["limit"][index]).max() <= 1e-12 * np.linalg.norm(np.ptp(data["V"], axis=0))
    halves = made.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges, uses = np.unique(np.sort(halves, axis=1), axis=0, return_counts=True)
    # On borders OpenSubdiv takes the tangents of another edge rule.
    inside = np.setdiff1d(made.faces, edges[uses == 1])
    assert abs(made.normals - data["normal"][index])[inside].max() < 1e-6


@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize("name", CLOSED)
def test_butterfly_is_what_openmesh_makes(name, level, shared_data):
    data, mesh = reference(shared_data, f"butterfly_openmesh_{name}_L{level}")
    assert_same(butterfly(mesh, level), data["V"], data["F"], 1e-7)  # written with seven digits


@pytest.mark.parametrize("levels", range(4))
@pytest.mark.parametrize("name", SURFACES)
def test_both_schemes_agree_with_their_plain_twins(name, levels):
    mesh = SURFACES[name]()
    assert_same(loop(mesh, levels), *naive.loop(mesh.positions, mesh.faces, levels), 1e-13)
    corners = naive.loop(mesh.positions, mesh.faces, levels, corners_stay=True)
    assert_same(loop(mesh, levels, boundary="corner"), *corners, 1e-13)
    assert_same(butterfly(mesh, levels), *naive.butterfly(mesh.positions, mesh.faces, levels), 1e-13)


@pytest.mark.parametrize("make", [loop, butterfly])
@pytest.mark.parametrize("name", SURFACES)
def test_it_commutes_with_affine_maps_and_keeps_the_surface_s_kind(name, make):
    mesh = SURFACES[name]()
    rng = np.random.default_rng(7)
    linear, shift = rng.normal(size=(3, 3)), rng.normal(size=3)
    moved = make(TriMesh(mesh.positions @ linear + shift, mesh.faces), 3)
    made = make(mesh, 3)
    np.testing.assert_allclose(moved.positions, made.positions @ linear + shift, rtol=0, atol=1e-12)
    assert (moved.faces == made.faces).all()
    assert len(made.faces) == 64 * len(mesh.faces)
    halves = made.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    assert len(np.unique(halves, axis=0)) == len(halves)  # oriented alike
    assert euler(made) == euler(mesh)


@pytest.mark.parametrize("boundary", ["edge", "corner"])
@pytest.mark.parametrize("name", SURFACES)
def test_a_vertex_has_one_limit_and_one_normal_whatever_the_level(name, boundary):
    mesh = SURFACES[name]()
    base = loop(mesh, 0, boundary=boundary, positions="limit", has_normals=True)
    for levels in (1, 3):
        later = loop(mesh, levels, boundary=boundary, positions="limit", has_normals=True)
        first = later.positions[: len(mesh.positions)]
        np.testing.assert_allclose(first, base.positions, rtol=0, atol=1e-13)
        normals = later.normals[: len(mesh.positions)]
        np.testing.assert_allclose(normals, base.normals, rtol=0, atol=1e-6)


@pytest.mark.parametrize(("make", "twin"), [(loop, naive.loop), (butterfly, naive.butterfly)])
def test_two_triangles_back_to_back_have_vertices_of_valence_two(make, twin):
    mesh = TriMesh.of([[0, 0, 0], [1, 0, 0], [0, 1, 0.5]], [[0, 1, 2], [0, 2, 1]])
    assert_same(make(mesh, 1), *twin(mesh.positions, mesh.faces, 1), 1e-13)
    # From then on edges share both ends, which only numbered edges can tell apart.
    assert np.isfinite(make(mesh, 4).positions).all()


def test_loop_has_the_mask_of_1987_and_its_limit():
    octahedron = TriMesh.of(
        [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    )
    assert loop(octahedron, 1).positions[0, 0] == 0.515625  # 3 / (8 n) would give 0.625
    # (3 v + 8 α a) / (3 + 8 α) with a = 0 and α = 31 / 64.
    assert loop(octahedron, 0, positions="limit").positions[0, 0] == pytest.approx(
        3 / (3 + 31 / 8), rel=1e-15
    )


def test_butterfly_goes_through_its_vertices_and_reproduces_cubics():
    ball = bumpy_sphere(2)
    assert (butterfly(ball, 2).positions[: len(ball.positions)] == ball.positions).all()
    sheet = grid_patch(8)
    x, y = sheet.positions[:, 0], sheet.positions[:, 1]
    sheet.positions[:, 2] = x**3 - 2 * x * x * y + y**2
    made = butterfly(sheet, 1).positions
    x, y, z = made.T
    inside = (abs(made[:, :2] - 0.5) < 0.3).all(axis=1)  # two cells from the border
    assert inside.sum() > 60
    np.testing.assert_allclose(z[inside], (x**3 - 2 * x * x * y + y**2)[inside], rtol=0, atol=1e-15)


def test_normals_of_a_sphere_are_its_directions_and_of_a_sheet_up():
    ball = loop(icosphere(3), 1, positions="limit", has_normals=True)
    outward = ball.positions / np.linalg.norm(ball.positions, axis=1, keepdims=True)
    assert (ball.normals * outward).sum(axis=1).min() > 0.9999
    sheet = loop(grid_patch(3), 1, has_normals=True)
    np.testing.assert_allclose(sheet.normals, np.tile([0, 0, 1], (len(sheet.normals), 1)), atol=1e-7)


def test_what_cannot_be_subdivided_is_refused():
    with pytest.raises(FovealError, match=r"cage\.obj: the edge between vertices 0 and 1"):
        loop(corpus.MESHES["nonmanifold_edge"](), 1, name="cage.obj")
    with pytest.raises(ValueError, match="levels"):
        butterfly(tetrahedron(), -1)
    with pytest.raises(ValueError, match="int32"):
        loop(tetrahedron(), 15)
    with pytest.raises(ValueError, match="boundary"):
        loop(tetrahedron(), 1, boundary="smooth")
