"""Control meshes at the command line: `foveal refine`, and the options that others share with it."""

import json
import math
import signal
import sys
import time
from dataclasses import replace

import pytest

from cli.stand_in import Server
from foveal import TriMesh
from foveal.mesh.io import read_mesh, write_ply
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.refine import Criteria, Region
from foveal.scene import read_scene
from foveal.scene.cage_file import read_cage
from refine.test_sharp import cube


@pytest.fixture
def cage(tmp_path):
    path = tmp_path / "cage.ply"
    write_ply(bumpy_sphere(2), path)
    return path


@pytest.fixture
def viewer(tmp_path, monkeypatch):
    folder = tmp_path / "viewer"
    folder.mkdir()
    (folder / "index.html").write_text("<!doctype html>")
    monkeypatch.setattr("foveal.scene.viewer_files._BUILT", folder)


def result(answer):
    assert answer.exit_code == 0, answer.stderr
    return json.loads(answer.stdout)


def test_refine(run, cage, tmp_path):
    out = tmp_path / "fine.ply"
    facts = result(run("refine", cage, "-o", out, "--json"))
    assert facts["triangles"] == len(read_mesh(out).faces) > 320
    assert facts["bytes"] == out.stat().st_size
    assert run("refine", cage, "-o", out).exit_code == 1  # is there already
    answer = run("refine", cage, "-o", out, "--force", "--up", "z")
    assert "triangles" in answer.stdout
    assert run("refine", cage, "-o", out, "--force", "-q").stdout == ""


def test_refine_for_a_camera(run, cage, tmp_path):
    camera = tmp_path / "cam.json"
    camera.write_text('{"position": [0, 0, 4], "target": [0, 0, 0], "size": [1000, 1000]}')
    near = result(run("refine", cage, "-o", tmp_path / "a.glb", "--camera", camera, "--json"))
    camera.write_text('{"position": [0, 0, 40], "target": [0, 0, 0], "size": [1000, 1000]}')
    far = result(run("refine", cage, "-o", tmp_path / "b.glb", "--camera", camera, "--json"))
    assert near["triangles"] > 2 * far["triangles"]


def test_refine_everywhere(run, cage, tmp_path):
    facts = result(
        run("refine", cage, "-o", tmp_path / "a.ply", "--everywhere", "--iterations", "2", "--json")
    )
    assert facts["triangles"] == 320 * 9
    limit = run(
        "refine", cage, "-o", tmp_path / "b.ply", "--everywhere", "--iterations", "2", "--positions", "limit"
    )
    assert limit.exit_code == 0
    a, b = read_mesh(tmp_path / "a.ply"), read_mesh(tmp_path / "b.ply")
    assert (a.faces == b.faces).all()
    assert (a.positions != b.positions).any()


def test_each_criterion_has_its_option(run, cage, tmp_path):
    words = [
        *("--scheme", "SQRT3", "--iterations", "3", "--edge-px", "2.5", "--bend", "30"),
        *("--silhouette-iterations", "5", "--silhouette-edge-px", "1.5", "--silhouette-bend", "60"),
        *("--back-iterations", "1", "--positions", "limit", "--budget", "5000"),
    ]
    answer = run("build", cage, "-o", tmp_path / "cage.fov", *words)
    assert answer.exit_code == 0, answer.stderr
    assert "a control mesh of 320 triangles" in answer.stdout
    there = read_cage(tmp_path / "cage.fov").refinement
    front, silhouette = Region(3, 2.5, math.radians(30)), Region(5, 1.5, math.radians(60))
    assert there.criteria.front.bend == pytest.approx(front.bend)
    assert there.criteria.front.edge_px == front.edge_px
    assert there.criteria.silhouette.iterations == silhouette.iterations
    assert there.criteria.silhouette.bend == pytest.approx(silhouette.bend)
    assert there.criteria.back.iterations == 1
    assert (there.positions, there.budget) == ("limit", 5000)
    facts = result(run("refine", tmp_path / "cage.fov", "-o", tmp_path / "a.ply", "--json"))
    assert 320 < facts["triangles"] <= 5000


def test_a_criterion_leaves_the_others_as_they_are_by_default(run, cage, tmp_path):
    assert run("build", cage, "-o", tmp_path / "cage.fov", "--scheme", "sqrt3", "--bend", "10").exit_code == 0
    found = read_cage(tmp_path / "cage.fov").refinement.criteria
    usual = Criteria()
    assert (found.front.iterations, found.front.edge_px) == (usual.front.iterations, usual.front.edge_px)
    assert (found.silhouette, found.back) == (usual.silhouette, usual.back)


def test_a_criterion_leaves_the_others_as_the_file_has_them(run, cage, tmp_path, monkeypatch, viewer):
    kept = ("--iterations", "2", "--edge-px", "3", "--silhouette-iterations", "5", "--bend", "4")
    path = tmp_path / "cage.fov"
    assert run("build", cage, "-o", path, "--scheme", "sqrt3", *kept).exit_code == 0
    own = read_cage(path).refinement
    answer = run("publish", path, "-o", tmp_path / "site", "--edge-px", "1", "--back-iterations", "2")
    assert answer.exit_code == 0, answer.stderr
    found = read_scene(tmp_path / "site" / "scene.json").layers[0].refinement
    assert found.criteria.front == replace(own.criteria.front, edge_px=1.0)
    assert found.criteria.silhouette == own.criteria.silhouette
    assert found.criteria.back == replace(own.criteria.back, iterations=2)
    assert (found.positions, found.budget) == (own.positions, own.budget)


def test_what_is_inside_out_is_told_once(run, tmp_path, monkeypatch, viewer):
    ball, path = icosphere(1), tmp_path / "cave.ply"
    write_ply(TriMesh(ball.positions, ball.faces[:, ::-1].copy()), path)
    monkeypatch.setattr("foveal.server.view.start", lambda scene, **_: Server())
    fov = tmp_path / "cave.fov"
    for words in (
        ("build", path, "-o", fov, "--scheme", "sqrt3"),
        ("refine", path, "-o", tmp_path / "a.ply"),
        ("refine", fov, "-o", tmp_path / "b.ply"),
        ("view", path, "--scheme", "sqrt3", "--no-browser"),
        ("view", path, "--scheme", "sqrt3", "--no-browser"),  # from the cache
        ("view", fov, "--no-browser"),
        ("publish", fov, "-o", tmp_path / "site"),
        ("view", tmp_path / "site" / "scene.json", "--no-browser"),
    ):
        answer = run(*words)
        assert answer.exit_code == 0, answer.stderr
        assert answer.stderr.count("inside out") == 1, words
        assert "Reverse the corners" in answer.stderr
    write_ply(ball, path)
    assert "inside out" not in run("refine", path, "-o", tmp_path / "c.ply").stderr


def test_sharp_edges(run, tmp_path, monkeypatch, viewer):
    served = []
    monkeypatch.setattr("foveal.server.view.start", lambda scene, **_: served.append(scene) or Server())
    path, fov = tmp_path / "cube.ply", tmp_path / "cube.fov"
    write_ply(cube()[0], path)
    words = ("--scheme", "sqrt3", "--sharp-edges", "60")
    answer = run("build", path, "-o", fov, *words)
    assert "12 triangles, 8 vertices, 12 sharp edges," in answer.stdout
    assert "sharp edges  12" in run("info", fov).stdout
    assert "whole" in run("check", fov).stdout
    everywhere = ("--everywhere", "--iterations", "3", "--json")
    corners = {(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)}
    for source, more in ((path, words), (fov, ())):
        facts = result(run("refine", source, "-o", tmp_path / "a.ply", "--force", *everywhere, *more))
        assert facts["triangles"] == 12 * 27
        assert corners <= set(map(tuple, read_mesh(tmp_path / "a.ply").positions.tolist()))
    run("refine", fov, "-o", tmp_path / "b.ply", "--sharp-edges", "180", *everywhere)
    assert not corners & set(map(tuple, read_mesh(tmp_path / "b.ply").positions.tolist()))
    assert run("view", path, *words, "--no-browser").exit_code == 0
    assert len(read_cage(served[0].layers[0].path).sharp) == 12
    assert run("publish", path, "-o", tmp_path / "site", *words).exit_code == 0
    assert len(read_cage(next((tmp_path / "site").glob("data/*.fov"))).sharp) == 12


@pytest.mark.parametrize(
    ("words", "code", "part"),
    [
        (("view", "--no-browser", "--scheme", "loop", "--sharp-edges", "30"), 1, "loop knows no sharp edges"),
        (("view", "--no-browser", "--sharp-edges", "30"), 1, "choose a scheme"),
        (("build", "--scheme", "sqrt3", "--sharp-edges", "181"), 2, "--sharp-edges"),
        (("build", "--scheme", "sqrt3", "--sharp-edges", "-1"), 2, "--sharp-edges"),
        (("refine", "-o", "a.ply", "--sharp-edges", "nan"), 2, "--sharp-edges"),
        (("refine", "-o", "a.ply", "--sharp-edges"), 2, "--sharp-edges"),
        (("refine", "-o", "a.ply", "--scheme", "butterfly", "--sharp-edges", "9"), 1, "no sharp edges"),
    ],
)
def test_sharp_edges_that_do_not_fit(run, cage, viewer, tmp_path, monkeypatch, words, code, part):
    monkeypatch.chdir(tmp_path)
    answer = run(words[0], cage, *words[1:])
    assert answer.exit_code == code
    assert part in answer.stderr
    assert {path.suffix for path in tmp_path.glob("*.*")} <= {".ply"}
    assert not (tmp_path / "a.ply").exists()


def test_build_as_json_and_info_and_check(run, cage, tmp_path):
    facts = result(run("build", cage, "--scheme", "sqrt3", "--json"))
    assert (facts["triangles"], facts["scheme"], facts["welded"]) == (320, "sqrt3", 0)
    text = run("info", tmp_path / "cage.fov").stdout
    for word in ("320 triangles", "sqrt3", "silhouette", "degrees"):
        assert word in text
    assert result(run("info", tmp_path / "cage.fov", "--json"))["kind"] == "cage"
    assert "whole" in run("check", tmp_path / "cage.fov").stdout
    assert run("export", tmp_path / "cage.fov", "-o", tmp_path / "a.glb").exit_code == 0


def test_view_and_publish_take_them(run, cage, tmp_path, monkeypatch, viewer):
    served = []

    def start(scene, **_):
        served.append(scene.layers[0].refinement)
        return Server()

    monkeypatch.setattr("foveal.server.view.start", start)
    words = ("--scheme", "sqrt3", "--budget", "700", "--rate", "30", "--no-browser")
    assert run("view", cage, *words).exit_code == 0
    assert (served[0].scheme, served[0].budget, served[0].rate) == ("sqrt3", 700, 30)
    assert run("view", cage, "--budget", "700", "--no-browser").exit_code == 1  # no scheme
    answer = run("publish", cage, "-o", tmp_path / "site", "--scheme", "sqrt3", "--iterations", "2")
    assert answer.exit_code == 0, answer.stderr
    layer = json.loads((tmp_path / "site" / "scene.json").read_text())["layers"][0]
    assert layer["criteria"]["front"]["iterations"] == 2
    assert run("info", tmp_path / "site" / "scene.json").exit_code == 0


def test_a_mesh_that_is_no_surface_is_said_before_it_is_served(run, tmp_path, monkeypatch, viewer):
    path = tmp_path / "wings.off"
    path.write_text("OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 1 0 3\n3 0 1 4\n")
    for words in (
        ("view", path, "--no-browser"),
        ("build", path),
        ("refine", path, "-o", tmp_path / "a.ply"),
    ):
        answer = run(*words, "--scheme", "sqrt3")
        assert answer.exit_code == 1
        assert "the edge between vertices 0 and 1" in answer.stderr
        assert "wings.off" in answer.stderr


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (["--scheme", "catmull"], "--scheme"),
        (["--iterations", "31"], "--iterations"),
        (["--iterations", "2.5"], "--iterations"),
        (["--edge-px", "-1"], "--edge-px"),
        (["--bend", "181"], "--bend"),
        (["--silhouette-bend", "nan"], "--silhouette-bend"),
        (["--edge-px", "nan"], "--edge-px"),
        (["--positions", "best"], "--positions"),
        (["--budget", "-1"], "--budget"),
        (["--everywhere", "--camera", "cam.json"], "--camera"),
        (["--everywhere", "--visible-only"], "--visible-only"),
        (["--everywhere", "--mode", "filter"], "--everywhere"),
        (["--visible-only", "--mode", "filter"], "--visible-only"),
        (["--mode", "published"], "--mode"),
        (["--camera"], "--camera"),
        (["--depth", "3"], "--depth"),
    ],
)
def test_a_wrong_command_line_exits_with_2(run, cage, tmp_path, words, part):
    answer = run("refine", cage, "-o", tmp_path / "a.ply", *words)
    assert answer.exit_code == 2
    assert part in answer.stderr
    assert not (tmp_path / "a.ply").exists()


@pytest.mark.parametrize("scheme", ["loop", "butterfly"])
def test_the_other_schemes_refine_as_well(run, cage, tmp_path, scheme):
    answer = run("refine", cage, "-o", tmp_path / "a.ply", "--scheme", scheme)
    assert answer.exit_code == 0
    assert (tmp_path / "a.ply").stat().st_size > 0


def test_the_paper_has_a_mode_of_its_own(run, cage, tmp_path):
    out = tmp_path / "a.ply"
    exact, published = (
        result(run("refine", cage, "-o", out, "--force", "--json", "--mode", mode))["triangles"]
        for mode in ("exact", "filter")
    )
    assert 320 < published != exact
    assert (
        result(run("refine", cage, "-o", out, "--force", "--json", "--mode", "FILTER"))["triangles"]
        == published
    )
    budgeted = ("--mode", "filter", "--budget", "900", "--json", "--force")
    assert result(run("refine", cage, "-o", out, *budgeted))["triangles"] <= 900
    for words, part in (
        (("--scheme", "loop"), "one of sqrt3"),
        (("--sharp-edges", "1"), "sharp edges, which the mode filter does not know"),
    ):
        answer = run("refine", cage, "-o", tmp_path / "b.ply", "--mode", "filter", *words)
        assert answer.exit_code == 1
        assert part in answer.stderr
    assert not (tmp_path / "b.ply").exists()


def test_what_does_not_go_together_is_said(run, cage, tmp_path, monkeypatch):
    answer = run("build", cage, "-o", tmp_path / "a.fov", "--scheme", "sqrt3", "--bits", "12")
    assert answer.exit_code == 1
    assert "bits would change nothing" in answer.stderr
    answer = run("refine", cage, "-o", cage, "--force")
    assert answer.exit_code == 1
    assert "the input itself" in answer.stderr
    assert run("refine", cage, "-o", tmp_path / "a.stl").exit_code == 2
    assert run("refine", tmp_path / "none.obj", "-o", tmp_path / "a.ply").exit_code == 1


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one child alone")
def test_ctrl_c_ends_a_huge_refinement_at_once(spawn, cage, tmp_path):
    child = spawn("refine", cage, "-o", tmp_path / "out" / "a.ply", "--iterations", "12", "--edge-px", "0")
    assert child.stderr.readline() == "Refining ...\n"
    time.sleep(1.0)  # to be within the work
    begin = time.monotonic()
    child.send_signal(signal.SIGINT)
    out, _ = child.communicate(timeout=60)
    assert (child.returncode, out) == (130, "")
    assert time.monotonic() - begin < 1.5
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_too_much_everywhere_is_said_before(run, cage, tmp_path):
    answer = run("refine", cage, "-o", tmp_path / "a.ply", "--everywhere", "--iterations", "12")
    assert answer.exit_code == 1
    for word in ("170,061,120 triangles", "--budget", "--iterations", "--everywhere"):
        assert word in answer.stderr
    assert not (tmp_path / "a.ply").exists()
