"""`refine`: a control mesh as a camera has it refined."""

import json

import numpy as np
import pytest

import corpus
from foveal import Camera, FovealError, TriMesh
from foveal.mesh.io import read_mesh, write_ply
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain
from foveal.refine import Criteria, Region, Sqrt3Filter, sqrt3
from foveal.scene import refine_size, refined
from foveal.scene.cage_file import write_cage
from foveal.scene.control_mesh import ControlMesh
from foveal.scene.refine import refine
from foveal.scene.refinement import Refinement
from foveal.scene.render import home

BALL = bumpy_sphere(2)
VIEW = Camera.of([3, 1, 2], [0, 0, 0], width=640, height=480)


@pytest.fixture
def cage(tmp_path):
    path = tmp_path / "ball.fov"
    criteria = Criteria(Region(2), Region(3), Region(1))
    write_cage(BALL, path, refinement=Refinement("sqrt3", criteria, "limit"), up="z")
    return path


def assert_same(a, b):
    assert (a.positions == b.positions).all()
    assert (a.faces == b.faces).all()


def test_it_is_the_mesh_of_the_room():
    assert_same(refine(BALL, camera=VIEW), sqrt3(BALL, VIEW))
    criteria = Criteria(Region(2), Region(5, 1.0), Region(0))
    assert_same(refine(BALL, camera=VIEW, criteria=criteria), sqrt3(BALL, VIEW, criteria=criteria))


def test_a_file_a_camera_file_and_an_output(tmp_path):
    write_ply(BALL, tmp_path / "ball.ply")
    (tmp_path / "cam.json").write_text(json.dumps(VIEW.to_json()))
    out = tmp_path / "out" / "fine.ply"
    mesh = refine(tmp_path / "ball.ply", out, camera=tmp_path / "cam.json")
    np.testing.assert_allclose(mesh.positions, sqrt3(BALL, VIEW).positions, atol=1e-6)  # PLY's float32
    np.testing.assert_allclose(read_mesh(out).positions, mesh.positions, atol=1e-6)
    assert (read_mesh(out).faces == mesh.faces).all()
    refine(tmp_path / "ball.ply", out.with_suffix(".glb"), camera=VIEW)
    assert len(read_mesh(out.with_suffix(".glb")).faces) == len(mesh.faces)


def test_by_default_all_is_framed():
    assert_same(refine(BALL), sqrt3(BALL, home([BALL.positions], up="y")))
    assert_same(refine(BALL, up="z"), sqrt3(BALL, home([BALL.positions], up="z")))


@pytest.mark.parametrize("mesh", [BALL, terrain(6), corpus.MESHES["single_triangle"]()])
def test_everywhere_is_uniform(mesh):
    for level in range(4):
        found = refine(mesh, everywhere=True, criteria=Criteria(Region(level, 99.0)))
        region = Region(level)
        far = Camera.around(mesh.positions.min(axis=0) - 1, mesh.positions.max(axis=0) + 1)
        expected = sqrt3(mesh, far, criteria=Criteria(region, region, region))
        assert len(found.faces) == len(expected.faces)
    if mesh is BALL:
        assert len(found.faces) == len(BALL.faces) * 27


def test_a_file_says_how_and_what_is_chosen_goes_before(cage):
    from foveal.refine import Sqrt3

    live = Sqrt3(BALL)
    live.update(VIEW, criteria=Criteria(Region(2), Region(3), Region(1)))
    assert_same(refine(cage, camera=VIEW), live.mesh(positions="limit"))
    assert_same(refine(cage, camera=VIEW, positions="control"), live.mesh())
    finer = refine(cage, camera=VIEW, criteria=Criteria(Region(4), Region(4), Region(0)))
    assert len(finer.faces) > 2 * len(live.mesh().faces)


def test_a_budget_is_kept():
    criteria = Criteria(Region(9, 1.0), Region(12, 0.5), Region(0))
    for budget in (400, 5_000, 50_000):
        mesh = refine(BALL, camera=VIEW, criteria=criteria, budget=budget)
        assert len(mesh.faces) <= budget
        assert len(mesh.faces) > budget / 3
    assert len(refine(BALL, camera=VIEW, criteria=criteria, budget=7).faces) == 320


def test_what_is_hidden_may_be_left_alone():
    shifted = TriMesh(BALL.positions - [0, 0, 3], BALL.faces)
    two = corpus.joined(BALL, shifted)  # one behind the other
    eye = Camera.of([0, 0, 5], [0, 0, 0], width=640, height=480)
    both, seen = refine(two, camera=eye), refine(two, camera=eye, visible_only=True)
    behind = [np.count_nonzero(mesh.positions[:, 2] < -1.5) for mesh in (both, seen)]
    assert behind[1] < behind[0] / 2
    assert np.count_nonzero(seen.positions[:, 2] > -1.5) == len(both.positions) - behind[0]
    assert len(refine(two, camera=eye, visible_only=True, budget=2_000).faces) <= 2_000


def test_vertices_at_one_place_are_one():
    ball = icosphere(1)
    soup = TriMesh(ball.positions[ball.faces].reshape(-1, 3), np.arange(240, dtype=np.int32).reshape(-1, 3))
    assert len(refine(soup, everywhere=True, criteria=Criteria(Region(1))).positions) == 42 + 80


def test_what_cannot_be_refined_is_said(tmp_path, cage):
    with pytest.raises(FovealError, match="no such file"):
        refine(tmp_path / "none.obj")
    with pytest.raises(FovealError, match="one by one"):
        (tmp_path / "scene.json").write_text("{}")
        refine(tmp_path / "scene.json")
    with pytest.raises(FovealError, match="between vertices"):
        refine(corpus.MESHES["nonmanifold_edge"]())
    with pytest.raises(FovealError, match=r"\.ply or \.glb"):
        refine(BALL, tmp_path / "a.stl")
    with pytest.raises(FovealError, match="built already"):
        refine(cage, up="x")
    with pytest.raises(FovealError, match="no such file"):
        refine(BALL, camera=tmp_path / "none.json")
    with pytest.raises(ValueError, match="scheme must be one of"):
        refine(BALL, scheme="catmull")
    assert not list(tmp_path.glob("*.ply"))


@pytest.mark.parametrize("scheme", ["loop", "butterfly"])
def test_the_other_schemes_refine_as_well(scheme):
    assert len(refine(BALL, camera=VIEW, scheme=scheme).faces) > 320


@pytest.mark.parametrize("scheme", ["sqrt3", "loop", "butterfly"])
def test_slices_change_nothing(scheme, monkeypatch):
    whole = refine(BALL, camera=VIEW, scheme=scheme)
    monkeypatch.setattr(refined, "_SPLITS", 37)
    assert_same(refine(BALL, camera=VIEW, scheme=scheme), whole)
    assert_same(refine(BALL, camera=VIEW, visible_only=True), sqrt3(BALL, VIEW))
    monkeypatch.setattr(refined, "_SPLITS", 1 << 40)
    small = refine(BALL, camera=VIEW, scheme=scheme, budget=900)
    monkeypatch.setattr(refined, "_SPLITS", 37)
    assert len(refine(BALL, camera=VIEW, scheme=scheme, budget=900).faces) == len(small.faces) <= 900


def test_too_many_are_refused_before_memory_is_gone(tmp_path, monkeypatch):
    huge = Criteria(Region(30, 0.0), Region(30, 0.0), Region(30, 0.0))
    monkeypatch.setattr(refine_size, "MOST_TRIANGLES", 20_000)
    for scheme in ("sqrt3", "loop"):
        with pytest.raises(FovealError, match=r"more than 20,000 .* --budget, .* --iterations, .* --edge-px"):
            refine(BALL, tmp_path / "a.ply", camera=VIEW, scheme=scheme, criteria=huge)
        with pytest.raises(FovealError, match=r"triangles, more than the 20,000 .* --budget"):
            refine(BALL, tmp_path / "a.ply", everywhere=True, scheme=scheme, criteria=huge)
        budgeted = {"camera": VIEW, "scheme": scheme, "criteria": huge}
        assert len(refine(BALL, **budgeted, budget=15_000).faces) <= 15_000
        with pytest.raises(FovealError, match="more than 20,000"):
            refine(BALL, **budgeted, budget=4_000_000)
    assert not list(tmp_path.iterdir())


def test_with_less_memory_fewer_are_allowed(monkeypatch):
    class Memory:
        available = 1_100_000_000

    monkeypatch.setattr("psutil.virtual_memory", Memory)
    assert refine_size.most_triangles("sqrt3") == 4_000_000
    assert refine_size.most_triangles("loop") < 3_000_000
    Memory.available = 1 << 50
    assert refine_size.most_triangles("sqrt3") == refine_size.MOST_TRIANGLES == 50_000_000


@pytest.mark.parametrize("mesh", [BALL, terrain(6)])
@pytest.mark.parametrize("scheme", ["sqrt3", "loop"])
def test_what_is_everywhere_is_known_before(mesh, scheme):
    for level in range(4):
        found = refine(mesh, everywhere=True, scheme=scheme, criteria=Criteria(Region(level)))
        assert len(found.faces) == refine_size.everywhere(len(mesh.faces), scheme, level)


@pytest.mark.parametrize("edge_px", [16.0, 4.0])
@pytest.mark.parametrize("scheme", ["sqrt3", "loop"])
def test_what_is_expected_is_about_what_comes(scheme, edge_px):
    criteria = Criteria(Region(12, edge_px), Region(14, edge_px / 2), Region(0))
    cage = ControlMesh(BALL, Refinement(scheme, criteria), "y")
    ratio = refine_size.expected(cage, VIEW) / len(refined.refined(cage, VIEW).faces)
    assert 0.5 < ratio < 3.0


def test_progress_tells_of_triangles():
    class Told:
        total = advanced = 0.0

        def stage(self, what, total):
            self.total = total
            return self

        def advance(self, amount=1.0):
            self.advanced += amount

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

    told = Told()
    mesh = refine(BALL, camera=VIEW, budget=700, progress=told)
    assert told.total == 700
    assert told.advanced >= len(mesh.faces)


@pytest.mark.parametrize("positions", ["control", "limit"])
def test_the_mode_filter_is_that_of_the_room(positions):
    published = Sqrt3Filter(BALL)
    criteria = Criteria(Region(3, 6.0), Region(5, 3.0), Region(0))
    published.update(VIEW, criteria=criteria)
    found = refine(BALL, camera=VIEW, criteria=criteria, positions=positions, mode="filter")
    assert_same(found, published.mesh(positions=positions))
    if positions == "control":
        assert_same(found, sqrt3(BALL, VIEW, criteria=criteria, mode="filter"))


def test_the_mode_filter_keeps_to_a_budget_and_to_memory(monkeypatch):
    huge = {"camera": VIEW, "mode": "filter", "criteria": Criteria(Region(20), Region(20), Region(0))}
    published = Sqrt3Filter(BALL)
    published.update(VIEW, criteria=huge["criteria"], budget=5_000)
    assert_same(refine(BALL, **huge, budget=5_000), published.mesh())
    monkeypatch.setattr(refine_size, "MOST_TRIANGLES", 20_000)
    for budget in (None, 20_001):
        with pytest.raises(FovealError, match=r"more than 20,000 .* --budget"):
            refine(BALL, **huge, budget=budget)
    assert len(refine(BALL, **huge, budget=20_000).faces) <= 20_000


def test_what_the_mode_filter_does_not_know_is_said():
    for options, part in (
        ({"everywhere": True}, "no everywhere"),
        ({"visible_only": True}, "no visible_only"),
        ({"scheme": "loop"}, "one of sqrt3"),
        ({"sharp_edges": 0.01}, "sharp edges"),
    ):
        with pytest.raises(FovealError, match=part):
            refine(BALL, mode="filter", **options)
    with pytest.raises(ValueError, match="exact or filter"):
        refine(BALL, mode="published")
