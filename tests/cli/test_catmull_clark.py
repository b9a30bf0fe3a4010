"""Catmull-Clark cages at the command line: polygons and creases kept, depths chosen, wrong input told."""

import json

import numpy as np
import pytest
import trimesh

from cli.stand_in import Server
from cli.test_refine import result
from foveal.mesh.io import read_mesh, write_ply
from foveal.mesh.shapes import icosphere
from foveal.refine.slates import Slates
from foveal.refine.slates_depth import Depths
from foveal.scene import read_scene
from foveal.scene.cage_file import read_cage

CUBE = """\
v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 -1\nv 1 -1 -1
f 1 2 4 3\nf 3 4 6 5\nf 5 6 8 7\nf 7 8 2 1\nf 2 8 6 4\nf 7 1 3 5
"""
CREASES = "t crease 2/1/0 0 1 10\nt crease 2/1/0 1 3 10\nt crease 2/1/0 3 2 10\nt crease 2/1/0 2 0 1.5\n"
TOWN = """\
#usda 1.0
def Mesh "house"
{
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 2, 0)]
    int[] faceVertexCounts = [4, 3]
    int[] faceVertexIndices = [0, 1, 2, 3, 3, 2, 4]
}
def Mesh "shed"
{
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
}
"""
SCHEME = ("--scheme", "catmull-clark")


@pytest.fixture
def cage(tmp_path):
    path = tmp_path / "cube.obj"
    path.write_text(CUBE + CREASES + "t corner 1/1/0 6 10\n")
    return path


@pytest.fixture
def viewer(tmp_path, monkeypatch):
    folder = tmp_path / "viewer"
    folder.mkdir()
    (folder / "index.html").write_text("<!doctype html>")
    monkeypatch.setattr("foveal.scene.viewer_files._BUILT", folder)


def test_refine_for_a_camera(run, cage, tmp_path):
    camera = tmp_path / "cam.json"
    counts = []
    for away in (4, 40):
        camera.write_text(json.dumps({"position": [0, 0, away], "target": [0, 0, 0], "size": [1000, 1000]}))
        words = ("--camera", camera, "--json", "--force")
        answer = run("refine", cage, "-o", tmp_path / "a.ply", *SCHEME, *words)
        counts.append(result(answer)["triangles"])
        assert "6 quads, 4 creases (1 semi-sharp), 1 sharp corner." in answer.stderr
    assert counts[0] > 2 * counts[1] > 0


def test_refine_everywhere_is_uniform(run, cage, tmp_path):
    out = tmp_path / "a.ply"
    words = ("--everywhere", "--iterations", "3", "--json")
    assert result(run("refine", cage, "-o", out, *SCHEME, *words))["triangles"] == 6 * 2 * 4**3
    surface = Slates(read_cage(built(run, cage, tmp_path)).polygons)
    surface.show(3)
    expected, found = surface.mesh(), read_mesh(out)
    assert np.abs(found.positions - expected.positions).max() < 1e-6
    assert np.abs(found.normals - expected.normals).max() < 1e-6
    assert len(found.positions) > 6 * 64 + 2  # creases have two normals, and so vertices
    budget = result(run("refine", cage, "-o", out, *SCHEME, *words, "--budget", "500", "--force"))
    assert 250 < budget["triangles"] <= 500
    answer = run("refine", cage, "-o", out, *SCHEME, "--everywhere", "--iterations", "9", "--force")
    assert answer.exit_code == 2
    assert "--iterations" in answer.stderr
    assert "catmull-clark knows 8 at most, got 9" in answer.stderr
    fov = built(run, cage, tmp_path)
    answer = run("refine", fov, "-o", out, "--everywhere", "--iterations", "9", "--force")
    assert answer.exit_code == 1
    assert "catmull-clark knows 0 to 8 iterations, got 9" in answer.stderr


def test_what_memory_holds_is_told(run, cage, tmp_path, monkeypatch):
    monkeypatch.setattr("foveal.scene.patched.most_triangles", lambda scheme: 700)
    words = ("refine", cage, "-o", tmp_path / "a.ply", *SCHEME, "--force", "--json")
    answer = run(*words)
    assert 350 < result(answer)["triangles"] <= 700
    assert "coarser than the rules have it, within the 700 triangles that would do here" in answer.stderr
    for more in (("--budget", "600"), ("--iterations", "1")):
        assert "coarser than" not in run(*words, *more).stderr


def test_triangles_are_paired(run, tmp_path):
    write_ply(icosphere(2), tmp_path / "ball.ply")
    answer = run("refine", tmp_path / "ball.ply", "-o", tmp_path / "a.ply", *SCHEME, "--pair-triangles")
    assert answer.exit_code == 0
    assert "160 quads." in answer.stderr
    out = tmp_path / "ball.fov"
    assert run("build", tmp_path / "ball.ply", "-o", out, *SCHEME, "--pair-triangles").exit_code == 0
    assert read_cage(out).polygons.faces == 160
    assert "would change nothing" in run("view", out, "--pair-triangles", "--no-browser").stderr


def test_one_cage_in_many_places(run, cage, tmp_path):
    places = np.tile(np.eye(4), (3, 1, 1))
    places[:, 0, 3] = [0, 3, 6]
    (tmp_path / "places.json").write_text(json.dumps(places.tolist()))
    words = (*SCHEME, "--placements", tmp_path / "places.json")
    fov = built(run, cage, tmp_path, *words[2:])
    assert "placements   3" in run("info", fov).stdout
    answer = run("refine", cage, "-o", tmp_path / "a.ply", *words, "--everywhere", "--iterations", "1")
    assert "1 sharp corner, in 3 places." in answer.stderr
    assert len(read_mesh(tmp_path / "a.ply").faces) == 3 * 48
    assert run("render", cage, "-o", tmp_path / "a.png", *words, "--size", "64x48").exit_code == 0
    (tmp_path / "places.json").write_text(json.dumps([*places.tolist(), np.zeros((4, 4)).tolist()]))
    for verb in ("build", "view", "render", "refine", "publish"):
        answer = run(verb, cage, *(() if verb == "view" else ("-o", tmp_path / "b")), *words)
        assert answer.exit_code == 1
        assert "places.json: placement 3, counted from 0, has a last row" in answer.stderr


def test_a_mesh_of_a_usd_file_is_chosen(run, tmp_path):
    pytest.importorskip("pxr", reason="reading USD needs usd-core")
    (tmp_path / "town.usda").write_text(TOWN)
    words = ("build", tmp_path / "town.usda", "-o", tmp_path / "a.fov", *SCHEME, "--force")
    answer = run(*words)
    assert "it has 2 meshes, of which /house is taken. --prim names another" in answer.stderr
    assert read_cage(tmp_path / "a.fov").polygons.faces == 2
    answer = run(*words, "--prim", "/shed")
    assert "meshes" not in answer.stderr
    assert read_cage(tmp_path / "a.fov").polygons.faces == 1
    answer = run(*words, "--prim", "/inn")
    assert answer.exit_code == 1
    assert "Choose one by --prim: /house, /shed." in answer.stderr


@pytest.mark.parametrize("suffix", [".ply", ".glb"])
def test_texture_coordinates_and_colours_are_written(run, tmp_path, suffix):
    corners = np.array([[x, y] for y in (0.0, 1.0, 2.0) for x in (0.0, 1.0, 2.0)])
    lines = [f"v {x} {y} 0 {x / 2} {y / 2} 0" for x, y in corners] + [
        f"vt {x / 4} {y / 4}" for x, y in corners
    ]
    lines += [f"f {a}/{a} {a + 1}/{a + 1} {a + 4}/{a + 4} {a + 3}/{a + 3}" for a in (1, 2, 4, 5)]
    (tmp_path / "sheet.obj").write_text("\n".join(lines) + "\n")
    out = tmp_path / f"a{suffix}"
    assert run("refine", tmp_path / "sheet.obj", "-o", out, *SCHEME, "--everywhere").exit_code == 0
    there = trimesh.load(out, process=False)
    there = there if suffix == ".ply" else there.geometry.popitem()[1]
    assert np.ptp(there.visual.uv) > 0.4
    assert abs(there.visual.uv - read_mesh(out).positions[:, :2] / 4).max() < 1e-6
    expected = np.rint(255 * read_mesh(out).positions[:, :2] / 2)
    assert abs(read_mesh(out).colours[:, :2].astype(float) - expected).max() <= 1


def built(run, cage, tmp_path, *words):
    path = tmp_path / "cube.fov"
    answer = run("build", cage, "-o", path, "--force", *SCHEME, *words)
    assert answer.exit_code == 0, answer.stderr
    return path


def test_too_much_everywhere_is_said_before(run, tmp_path):
    write_ply(icosphere(4), tmp_path / "ball.ply")
    words = ("--everywhere", "--iterations", "8")
    answer = run("refine", tmp_path / "ball.ply", "-o", tmp_path / "a.ply", *SCHEME, *words)
    assert answer.exit_code == 1
    assert "2,013,265,920 triangles" in answer.stderr.replace("\n", " ")
    assert not (tmp_path / "a.ply").exists()


def test_each_rule_has_its_option(run, cage, tmp_path):
    fov = built(run, cage, tmp_path, "--iterations", "6", "--bend", "3", "--radius-px", "2", "8.5")
    found = read_cage(fov).refinement.depths
    assert (found.most, found.size_px) == (6, (2.0, 8.5))
    assert np.degrees(found.cone) == pytest.approx(3)
    for rule, rules in (
        ("curvature", {"cone": None}),
        ("BACKS", {"backs": False}),
        ("silhouettes", {"silhouettes": False}),
        ("size", {"size_px": None}),
    ):
        there = read_cage(built(run, cage, tmp_path, "--without", rule)).refinement.depths
        assert there == Depths(**rules)
    fov = built(run, cage, tmp_path, "--without", "size", "--without", "backs", "--iterations", "1")
    assert read_cage(fov).refinement.depths == Depths(1, backs=False, size_px=None)


def test_build_info_check_export_render_publish(run, cage, tmp_path, viewer):
    fov = built(run, cage, tmp_path)
    facts = result(run("build", cage, "-o", fov, "--force", *SCHEME, "--json"))
    assert (facts["polygons"]["quads"], facts["polygons"]["creases"]) == (6, 4)
    text = run("info", fov).stdout
    for words in ("6 quads, 4 creases (1 semi-sharp), 1 sharp corner", "catmull-clark", "radius 3 to 24 px"):
        assert words in text
    assert result(run("info", fov, "--json"))["polygons"]["corners"] == 1
    assert result(run("check", fov, "--json"))["is_closed"]
    assert run("export", fov, "-o", tmp_path / "a.ply").exit_code == 0
    assert len(read_mesh(tmp_path / "a.ply").faces) == 12
    assert run("render", fov, "-o", tmp_path / "a.png").exit_code == 0
    answer = run("publish", fov, "-o", tmp_path / "site", "--iterations", "2")
    assert answer.exit_code == 0
    assert "needs" not in answer.stderr  # a page tessellates by itself
    layer = read_scene(tmp_path / "site" / "scene.json").layers[0]
    assert layer.refinement.depths == Depths(most=2)
    assert run("info", tmp_path / "site" / "scene.json").exit_code == 0


def test_view_takes_it(run, cage, monkeypatch, viewer):
    served = []
    monkeypatch.setattr("foveal.server.view.start", lambda scene, **_: served.append(scene) or Server())
    words = (*SCHEME, "--rate", "25", "--budget", "700", "--radius-px", "1", "5", "--no-browser")
    assert run("view", cage, *words).exit_code == 0
    layer = served[0].layers[0]
    assert (layer.refinement.rate, layer.refinement.budget) == (25, 700)
    assert layer.refinement.depths.size_px == (1, 5)
    assert len(read_cage(layer.path).polygons.crease_edges) == 4


def test_other_schemes_leave_polygons_out_and_say_so(run, cage, tmp_path):
    fov = built(run, cage, tmp_path)
    answer = run("build", fov, "-o", tmp_path / "b.fov", "--scheme", "sqrt3")
    assert answer.exit_code == 0
    assert "Kept as plain triangles" in answer.stderr
    assert read_cage(tmp_path / "b.fov").polygons is None
    back = run("refine", tmp_path / "b.fov", "-o", tmp_path / "b.ply", *SCHEME)
    assert "12 triangles." in back.stderr


@pytest.mark.parametrize(
    ("words", "code", "part"),
    [
        ((*SCHEME, "--radius-px", "4", "5"), 2, "at least twice"),
        ((*SCHEME, "--radius-px", "-1", "5"), 2, "--radius-px"),
        ((*SCHEME, "--radius-px", "4"), 2, "--radius-px"),
        ((*SCHEME, "--radius-px", "1", "5", "--without", "size"), 2, "--radius-px"),
        ((*SCHEME, "--without", "colour"), 2, "--without"),
        ((*SCHEME, "--edge-px", "4"), 1, "no length of edges"),
        ((*SCHEME, "--silhouette-bend", "4"), 1, "no numbers apart"),
        ((*SCHEME, "--positions", "control"), 1, "limit surface only"),
        ((*SCHEME, "--sharp-edges", "20"), 1, "keeps the creases of the file"),
        ((*SCHEME, "--visible-only"), 1, "by sqrt3 only"),
        ((*SCHEME, "--mode", "filter"), 1, "one of sqrt3"),
        (("--without", "size"), 1, "sqrt3 has no rules of depth"),
        (("--pair-triangles",), 1, "sqrt3 refines triangles as they are"),
        ((*SCHEME, "--pair-triangles"), 1, "no two triangles side by side"),
        ((*SCHEME, "--prim", "/a"), 1, "cube.obj: only a USD file has prims"),
    ],
)
def test_what_does_not_fit_is_said(run, cage, tmp_path, words, code, part):
    answer = run("refine", cage, "-o", tmp_path / "a.ply", *words)
    assert answer.exit_code == code
    assert part in answer.stderr
    assert not (tmp_path / "a.ply").exists()


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n", "more than two faces"),
        (CUBE.replace("f 1 2 4 3", "f 1 2 4 2"), "has vertex 1 twice"),
        (CUBE + "t crease 2/1/0 0 3 2\n", "no edge between vertices 0 and 3"),
        (CUBE + "t crease 2/1/0 0 1 -2\n", "sharpness"),
        (CUBE.replace("v 1 -1 1", "v 1 nan 1"), "cube.obj"),
        ("", "cube.obj"),
    ],
)
def test_bad_cages_are_refused_in_a_sentence(run, cage, tmp_path, viewer, text, part):
    cage.write_text(text)
    for words in (
        ("refine", cage, "-o", tmp_path / "a.ply"),
        ("build", cage),
        ("view", cage, "--no-browser"),
    ):
        answer = run(*words, *SCHEME)
        assert answer.exit_code == 1, words
        assert part in answer.stderr
        assert "fault in foveal" not in answer.stderr
    assert not (tmp_path / "a.ply").exists()
