"""A control mesh wherever a `.fov` goes: built, cached, in scenes, told, checked, exported, drawn."""

import json

import numpy as np
import pytest

from foveal import Camera, FovealError, TriMesh
from foveal.container import create, open_container
from foveal.mesh.io import read_mesh, write_ply
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.refine import Criteria, Region, Sqrt3, sharp_edges
from foveal.scene import Layer, Scene, read_scene, scene_of, write_scene
from foveal.scene.build import build
from foveal.scene.cage_file import CageReport, is_cage, read_cage
from foveal.scene.check import check
from foveal.scene.export import export
from foveal.scene.info import info
from foveal.scene.prepare import load, prepare
from foveal.scene.publish import publish
from foveal.scene.read import read
from foveal.scene.refine import refine
from foveal.scene.refinement import Refinement
from foveal.scene.render import draw, frame, render
from refine.test_sharp import cube

BALL = bumpy_sphere(2)
FINE = Criteria(Region(3, 2.0), Region(5, 1.0, 0.25 * np.pi), Region(1))


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setattr("foveal.scene.prepare.cache_folder", lambda: tmp_path / "cache")


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.ply"
    write_ply(BALL, path)
    return path


@pytest.fixture
def cage(tmp_path):
    path = tmp_path / "cage.fov"
    build(BALL, path, scheme="sqrt3", criteria=FINE, positions="limit", budget=9_000, rate=50, up="z")
    return path


def test_build_keeps_the_mesh_and_how(ball, tmp_path, cage):
    report = build(ball, tmp_path / "a.fov", scheme="sqrt3")
    assert isinstance(report, CageReport)
    assert (report.triangles, report.vertices, report.scheme) == (320, 162, "sqrt3")
    assert read_cage(tmp_path / "a.fov").refinement == Refinement("sqrt3", Criteria())
    there = read_cage(cage)
    assert (there.mesh.positions == BALL.positions).all()
    assert there.up == "z"
    assert (there.refinement.positions, there.refinement.budget, there.refinement.rate) == (
        "limit",
        9_000,
        50,
    )


def test_build_anew_with_another_scheme_or_as_patches(cage, tmp_path):
    build(cage, tmp_path / "loop.fov", scheme="loop")
    found = read_cage(tmp_path / "loop.fov")
    assert (found.refinement, found.up) == (Refinement("loop", Criteria()), "z")
    build(cage, tmp_path / "patches.fov")
    facts = info(tmp_path / "patches.fov")
    assert (facts["kind"], facts["triangles"], facts["up"]) == ("multires", 320, "z")
    build(tmp_path / "patches.fov", tmp_path / "again.fov", scheme="sqrt3")
    assert info(tmp_path / "again.fov")["triangles"] == 320


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"scheme": "sqrt3", "bits": 12}, "bits would change nothing"),
        ({"scheme": "sqrt3", "normals": "none", "step": 0.1}, "step and normals"),
        ({"criteria": FINE}, "choose a scheme"),
        ({"budget": 3}, "choose a scheme"),
    ],
)
def test_build_refuses_what_means_nothing(ball, tmp_path, options, sentence):
    with pytest.raises(FovealError, match=sentence):
        build(ball, tmp_path / "a.fov", **options)
    with pytest.raises(FovealError, match=sentence):
        load(ball, **options)


@pytest.mark.parametrize(
    "options",
    [{"scheme": "cubic"}, {"scheme": "sqrt3", "positions": "best"}, {"scheme": "sqrt3", "rate": -1.0}],
)
def test_options_that_do_not_exist_are_a_programmers_fault(ball, tmp_path, options):
    with pytest.raises(ValueError, match="must be"):
        build(ball, tmp_path / "a.fov", **options)


def test_load_keeps_one_file_for_all_criteria(ball, tmp_path):
    first = load(ball, scheme="sqrt3")
    second = load(ball, scheme="sqrt3", criteria=FINE, budget=100)
    assert first.layers[0].path == second.layers[0].path
    assert first.layers[0].refinement == Refinement("sqrt3", Criteria())
    assert second.layers[0].refinement == Refinement("sqrt3", FINE, budget=100)
    assert load(ball, scheme="loop").layers[0].path != first.layers[0].path
    assert load(ball).layers[0].refinement is None
    assert len(list((tmp_path / "cache").glob("*.fov"))) == 3
    mesh = load(TriMesh(BALL.positions, BALL.faces), scheme="sqrt3")
    assert is_cage(mesh.layers[0].path)


def test_what_is_built_may_be_refined_otherwise(cage, fov):
    assert load(cage).layers[0].refinement.budget == 9_000
    changed = load(cage, budget=5, criteria=Criteria()).layers[0].refinement
    assert changed == Refinement("sqrt3", Criteria(), "limit", 5, 50.0)
    assert prepare(cage, scheme="loop") == cage
    with pytest.raises(FovealError, match="bits would change nothing"):
        load(cage, bits=12)
    with pytest.raises(FovealError, match="scheme and budget would change nothing"):
        load(fov, scheme="sqrt3", budget=5)
    with pytest.raises(FovealError, match="rate would change nothing"):
        load(scene_of(cage), rate=30.0)


def test_a_scene_says_how_its_layers_are_refined(cage, fov, tmp_path):
    layers = [
        {"asset": "cage.fov", "criteria": {"back": {"iterations": 2, "bend_degrees": 90}}, "rate": 0},
        {"asset": "statue.fov", "scheme": "ignored"},
        {"asset": "cage.fov", "name": "again", "scheme": "butterfly"},
    ]
    (tmp_path / "scene.json").write_text(json.dumps({"version": 1, "layers": layers}))
    scene = read_scene(tmp_path / "scene.json")
    first, second, third = (layer.refinement for layer in scene.layers)
    assert first.criteria == Criteria(FINE.front, FINE.silhouette, Region(2, 0.0, np.pi / 2))
    assert (first.scheme, first.positions, first.budget, first.rate) == ("sqrt3", "limit", 9_000, 0)
    assert second is None
    assert third.scheme == "butterfly"
    write_scene(scene, tmp_path / "scene2.json")
    assert read_scene(tmp_path / "scene2.json").layers == scene.layers


@pytest.mark.parametrize(
    "layer",
    [
        {"scheme": "cubic"},
        {"scheme": 7},
        {"criteria": []},
        {"criteria": {"front": {"iterations": 99}}},
        {"positions": None},
        {"budget": "many"},
        {"rate": [60]},
    ],
)
def test_a_scene_that_says_it_wrong_is_refused(cage, tmp_path, layer):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps({"version": 1, "layers": [{"asset": "cage.fov", **layer}]}))
    with pytest.raises(FovealError, match=r'layer 1 of "layers": how it is refined is not told'):
        read_scene(path)


def test_a_version_to_come_is_refused(cage, tmp_path):
    from foveal.container import create

    with create(tmp_path / "new.fov", kind="cage", version=3) as writer:
        writer.finish({"generator": "later"}, b"")
    for verb in (scene_of, info, check, read, export, load):
        with pytest.raises(FovealError, match="cage version 3 is not known"):
            verb(tmp_path / "new.fov")


def test_info(cage, tmp_path):
    facts = info(cage)
    assert (facts["kind"], facts["triangles"], facts["vertices"], facts["up"]) == ("cage", 320, 162, "z")
    assert facts["criteria"]["silhouette"]["edge_px"] == 1.0
    assert facts["bytes"] == cage.stat().st_size
    json.dumps(facts, allow_nan=False)
    write_scene(scene_of(cage), tmp_path / "scene.json")
    assert info(tmp_path / "scene.json")["layers"][0]["scheme"] == "sqrt3"


def test_check(cage, tmp_path):
    facts = check(cage)
    assert (facts["is_whole"], facts["triangles"], facts["is_closed"]) == (True, 320, True)
    assert check(cage, deep=True) == facts
    write_scene(scene_of(cage), tmp_path / "scene.json")
    assert check(tmp_path / "scene.json")["layers"] == [facts]
    with pytest.raises(FovealError, match="no errors to be measured"):
        check(cage, deep=True, original=cage)
    cage.write_bytes(cage.read_bytes()[:-1] + b"\x01")
    with pytest.raises(FovealError, match="checksum"):
        check(cage)


def test_read_and_export_give_the_control_mesh(cage, tmp_path):
    for mesh in (read(cage), export(cage, tmp_path / "a.ply"), export(cage, error=0, triangles=None)):
        assert (mesh.faces == BALL.faces).all()
        assert (mesh.positions == BALL.positions).all()
    assert len(read_mesh(tmp_path / "a.ply").faces) == 320
    assert len(export(cage, triangles=320).faces) == 320
    for limit in ({"triangles": 319}, {"error": 0.1}):
        with pytest.raises(FovealError, match="no coarser levels"):
            export(cage, **limit)
    with pytest.raises(FovealError, match="bits would change nothing"):
        export(cage, bits=12)


def test_render_draws_it_refined(cage, fov, tmp_path):
    scene = load(cage)
    eye = frame(scene, size=(160, 120))
    assert eye.to_json() == frame(load(BALL, scheme="sqrt3", up="z"), size=(160, 120)).to_json()
    smooth = render(cage, camera=eye, criteria=FINE, positions="limit")
    rough = render(cage, camera=eye, criteria=Criteria(Region(0), Region(0)), positions="control")
    assert smooth.shape == rough.shape == (120, 160, 3)
    assert (smooth != rough).any()
    assert (draw(scene, eye, triangles=320) == draw(scene, eye, triangles=1)).all()
    assert (draw(scene, eye) == smooth).all()


def test_publish_copies_it_with_how_it_is_refined(cage, tmp_path, viewer):
    site = publish(cage, tmp_path / "site", viewer=viewer, positions="control", budget=4)
    layer = json.loads((site / "scene.json").read_text())["layers"][0]
    assert (site / layer["asset"]).read_bytes() == cage.read_bytes()
    assert (layer["scheme"], layer["positions"], layer["budget"]) == ("sqrt3", "control", 4)
    assert layer["criteria"]["front"] == {"iterations": 3, "edge_px": 2.0, "bend_degrees": 0.0}
    assert "live" not in layer  # there is no server
    assert read_scene(site / "scene.json").layers[0].refinement.budget == 4


def test_layers_of_patches_say_nothing_of_refinement(fov, tmp_path):
    write_scene(Scene("s", (Layer("statue", fov),)), tmp_path / "scene.json")
    assert set(json.loads((tmp_path / "scene.json").read_text())["layers"][0]) == {"name", "asset", "visible"}


def test_a_camera_may_be_inside(cage):
    render(cage, camera=Camera.of([0, 0, 0], [0, 0, 1], up=[0, 1, 0], width=64, height=48))
    assert len(icosphere(0).faces) == 20


@pytest.fixture
def creased(tmp_path):
    """A cube as a file, whose edges are sharp, and the mesh."""
    mesh = cube()[0]
    build(mesh, tmp_path / "cube.fov", scheme="sqrt3", sharp_edges=1.0, criteria=FINE)
    return tmp_path / "cube.fov", mesh


def test_sharp_edges_go_wherever_the_file_goes(creased, tmp_path):
    path, mesh = creased
    live = Sqrt3(mesh, sharp=sharp_edges(mesh, 1.0))
    eye = Camera.of([3, 2, 4], [0.5, 0.5, 0.5], width=320, height=240)
    live.update(eye, criteria=FINE)
    found = refine(path, camera=eye)
    assert (found.positions == live.mesh().positions).all()
    smooth = refine(path, camera=eye, sharp_edges=np.pi)
    assert (smooth.positions.max(axis=0) < 1 - 1e-3).any()
    assert (refine(mesh, camera=eye, scheme="sqrt3", criteria=FINE).faces == smooth.faces).all()
    assert (info(path)["sharp_edges"], check(path)["sharp_edges"]) == (12, 12)
    assert info(path)["triangles"] == check(path)["triangles"] == 12
    assert (draw(scene_of(path), eye) != render(mesh, camera=eye)).any()


def test_sharp_edges_are_another_file_in_the_cache(tmp_path):
    mesh = cube()[0]
    kept = {prepare(mesh, scheme="sqrt3", sharp_edges=angle) for angle in (None, 1.0, 2.0, 1.0)}
    assert len(kept) == 3
    assert sorted(len(found) if (found := read_cage(path).sharp) is not None else 0 for path in kept) == [
        0,
        0,
        12,
    ]


def test_sharp_edges_that_cannot_be_kept_are_said(creased, tmp_path):
    path, mesh = creased
    with pytest.raises(FovealError, match="sharp_edges would change nothing"):
        load(path, sharp_edges=1.0)
    with pytest.raises(FovealError, match=r"cube\.fov: it has sharp edges, which loop does not know"):
        refine(path, scheme="loop")
    with pytest.raises(FovealError, match="butterfly knows no sharp edges"):
        build(mesh, tmp_path / "b.fov", scheme="butterfly", sharp_edges=1.0)
    with pytest.raises(FovealError, match="choose a scheme"):
        build(mesh, tmp_path / "b.fov", sharp_edges=1.0)
    assert not (tmp_path / "b.fov").exists()
    with pytest.raises(FovealError, match="sharp edges, which loop does not know"):
        load(path, scheme="loop")


def test_built_anew_what_is_not_chosen_stays(creased, cage, tmp_path):
    path, mesh = creased
    for source in (path, cage):
        was = read_cage(source)
        build(source, tmp_path / "b.fov", scheme="sqrt3", budget=77)
        found = read_cage(tmp_path / "b.fov")
        assert found.refinement == was.refinement.chosen({"budget": 77})
        assert found.up == was.up
        assert (found.sharp is None) == (was.sharp is None)
    build(path, tmp_path / "b.fov", scheme="sqrt3")
    assert (read_cage(tmp_path / "b.fov").sharp == sharp_edges(mesh, 1.0)).all()
    build(path, tmp_path / "b.fov", scheme="sqrt3", sharp_edges=np.pi)
    assert read_cage(tmp_path / "b.fov").sharp is None
    build(path, tmp_path / "b.fov", scheme="loop")  # which knows none, and says so
    assert read_cage(tmp_path / "b.fov").sharp is None


def test_an_edge_that_is_none_is_said(creased):
    path, _ = creased
    data = path.read_bytes()
    with open_container(path) as file:
        header = {k: v for k, v in file.header.items() if k not in ("kind", "version")}
        chunk = file.chunk(0)
    assert 7 not in read_cage(path).mesh.faces[(read_cage(path).mesh.faces == 0).any(axis=1)]
    with create(path, kind="cage", version=1) as writer:
        writer.finish({**header, "sharp_edges": [0, 7]}, chunk)
    assert path.read_bytes() != data
    for verb in (check, refine):
        with pytest.raises(FovealError, match="no edge between vertices 0 and 7"):
            verb(path)
