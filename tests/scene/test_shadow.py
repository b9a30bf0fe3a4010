"""The verb: from anything that can be shown to a file of shadows, and what is refused."""

import json

import numpy as np
import pytest

import foveal
from foveal import FovealError
from foveal.mesh.io import write_ply
from foveal.mesh.poly_shapes import cube
from foveal.mesh.shapes import icosphere
from foveal.scene import Layer, Scene, scene_of, write_scene
from foveal.scene.shadow import up_of_source
from foveal.shadows import AreaLight, Directional, Point, Spot, SunPath
from foveal.shadows.counts import counts
from foveal.shadows.tree import Tree
from scene.shadow_scenes import ball_over_slab
from shadows.naive_shadows import tree_of_pixels

DOWN = Directional((0, 0, -1))
UNDER_BALL, BESIDE = [[0, 0, 0.01]], [[1.5, 1.5, 0.01]]


def is_lit(report, points, image=0):
    return bool(report.shadow_map.lookup(points, image=image)[0])


@pytest.fixture
def mesh_file(tmp_path):
    path = tmp_path / "scene.ply"
    write_ply(ball_over_slab(), path)
    return path


@pytest.mark.parametrize(
    ("light", "images", "maps"),
    [
        (DOWN, 1, 1),
        (Spot((0, 0, 6), (0, 0, 0), 1.2), 1, 1),
        (Point((0, 0, 6)), 1, 6),
        (AreaLight(Spot((0, 0, 6), (0, 0, 0), 1.2), radius=0.2, samples=4), 4, 4),
        (SunPath("2026-06-21T10:00", "2026-06-21T13:00", 3, 30.0, 10.0, up="z"), 3, 3),
    ],
    ids=["parallel", "spot", "point", "area", "path"],
)
def test_every_light_casts_and_is_kept(mesh_file, tmp_path, light, images, maps):
    out = tmp_path / "new" / "shadow.fov"
    report = foveal.shadow(mesh_file, out, light=light, resolution=128)
    assert (report.images, report.pixels) == (images, maps * 128 * 128)
    assert report.bytes == out.stat().st_size
    assert report.triangles == len(ball_over_slab().faces)
    for image in range(images):
        assert not is_lit(report, UNDER_BALL, image)
        assert is_lit(report, BESIDE, image)
    facts = foveal.info(out)
    assert facts["kind"] == "shadow"
    assert facts["nodes"] == report.nodes == counts(report.shadow_map.trees)._asdict()
    assert (facts["resolution"], facts["images"], facts["maps"]) == (128, images, maps)
    assert facts["light"] == json.loads(json.dumps(light.to_json()))
    assert foveal.check(out)["is_whole"]
    json.dumps(report.to_json(), allow_nan=False)


def test_any_source_that_can_be_shown_casts(mesh_file, tmp_path):
    mesh = ball_over_slab()
    foveal.build(mesh, tmp_path / "scene.fov", bits=16)
    foveal.build(icosphere(2), tmp_path / "far.fov")
    layers = (
        Layer("scene", tmp_path / "scene.fov"),
        Layer("not shown", tmp_path / "far.fov", is_visible=False),
    )
    write_scene(Scene("both", layers), tmp_path / "scene.json")
    sources = [mesh, mesh_file, tmp_path / "scene.fov", tmp_path / "scene.json", Scene("both", layers)]
    for number, source in enumerate(sources):
        report = foveal.shadow(source, tmp_path / f"{number}_shadow.fov", light=DOWN, resolution=64)
        assert report.triangles == len(mesh.faces)
        assert (is_lit(report, UNDER_BALL), is_lit(report, BESIDE)) == (False, True)


@pytest.mark.parametrize(("scheme", "source"), [("catmull-clark", cube()), ("sqrt3", icosphere(0))])
def test_a_control_mesh_casts_as_it_is_shown(scheme, source, tmp_path, notes, monkeypatch):
    """Refined: the corners of the cage stay in the light."""
    monkeypatch.setattr("foveal.scene.shadow._MOST_ITERATIONS", 4)  # six are up to 3 million triangles
    positions = source.positions
    foveal.build(source, tmp_path / "cage.fov", scheme=scheme)
    report = foveal.shadow(
        tmp_path / "cage.fov", tmp_path / "shadow.fov", light=DOWN, resolution=256, progress=notes
    )
    assert any("refined everywhere" in said for said in notes.said)
    assert report.triangles > 1000
    corner = 0.99 * positions[np.linalg.norm(positions[:, :2], axis=1).argmax()]
    assert is_lit(report, [[corner[0], corner[1], -2]])
    assert not is_lit(report, [[0, 0, -2]])


def test_methods_and_exits_answer_alike(mesh_file, tmp_path):
    points = np.random.default_rng(1).uniform([-2, -2, 0.001], [2, 2, 0.4], (1000, 3))
    answers = [
        foveal.shadow(
            mesh_file, tmp_path / "s.fov", light=DOWN, resolution=64, method=method, exits=exits, workers=1
        ).shadow_map.lookup(points)
        for method in ("optimal", "bottom-up", "top-down")
        for exits in ("surface", "strict")
    ]
    assert 0 < answers[0].mean() < 1
    assert all((answer == answers[0]).all() for answer in answers)


def test_images_at_night_are_told_of(mesh_file, tmp_path, notes):
    path = SunPath("2026-06-21T00:00", "2026-06-21T12:00", 5, 43.7, 10.4, up="z")
    foveal.shadow(mesh_file, tmp_path / "s.fov", light=path, resolution=64, progress=notes)
    assert any("below the horizon, left out: 2 of 5" in said for said in notes.said)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"resolution": 100}, "power of two"),
        ({"method": "best"}, "method must be"),
        ({"exits": "none"}, "exits must be"),
        ({"light": AreaLight(DOWN, radius=0.1, samples=256), "resolution": 64}, "stack of 256 images"),
        ({"light": Point((0, 0, 1.1))}, "inside a closed part"),
        ({"light": Spot((0, 0, 9), (0, 0, 10), 0.1)}, "nothing lies in the light's cone"),
    ],
)
def test_what_cannot_be_is_said_and_nothing_is_written(mesh_file, tmp_path, options, sentence):
    with pytest.raises(FovealError, match=sentence):
        foveal.shadow(mesh_file, tmp_path / "s.fov", **{"light": DOWN, "resolution": 64, **options})
    assert not (tmp_path / "s.fov").exists()


def test_sources_and_outputs_that_will_not_do(mesh_file, tmp_path, fov):
    with pytest.raises(FovealError, match="no such file"):
        foveal.shadow(tmp_path / "none.ply", tmp_path / "s.fov", light=DOWN)
    with pytest.raises(FovealError, match=r"must end in \.fov"):
        foveal.shadow(mesh_file, tmp_path / "s.ply", light=DOWN)
    with pytest.raises(FovealError, match="is the input itself"):
        foveal.shadow(fov, fov, light=DOWN)
    write_scene(Scene("one", (Layer("it", fov),)), tmp_path / "scene.json")
    with pytest.raises(FovealError, match="is the input itself"):
        foveal.shadow(tmp_path / "scene.json", fov, light=DOWN)
    with pytest.raises(FovealError, match="shows no layer"):
        foveal.shadow(Scene("none", (Layer("it", fov, False),)), tmp_path / "s.fov", light=DOWN)
    foveal.shadow(mesh_file, tmp_path / "s.fov", light=DOWN, resolution=64)
    with pytest.raises(FovealError, match="no surface that could cast"):
        foveal.shadow(tmp_path / "s.fov", tmp_path / "t.fov", light=DOWN)
    with pytest.raises(FovealError, match="no surface"):
        scene_of(tmp_path / "s.fov")


def test_which_axis_points_up_a_source_may_say(tmp_path, make_fov):
    fov = make_fov(tmp_path / "a.fov", up="x")
    write_scene(Scene("one", (Layer("it", fov),)), tmp_path / "scene.json")
    assert [up_of_source(path) for path in (fov, tmp_path / "scene.json", "any.ply")] == ["x", "x", "y"]


def test_counts_are_of_a_whole_tree():
    rng = np.random.default_rng(3)
    lower = rng.integers(0, 2**32 - 2, (8, 8))
    tree = tree_of_pixels(lower, lower + rng.integers(0, 2**30, (8, 8)).clip(max=2**32 - 1 - lower))
    kinds = [tree.root, *(int(mask) >> 2 * i & 3 for mask in tree.masks for i in range(4))]
    found = counts(tree)
    assert found == (kinds.count(1), kinds.count(2), kinds.count(3))
    assert found.memory_bytes == 4 * kinds.count(1) + 4 * kinds.count(2) + 8 * kinds.count(3)
    assert counts([tree, tree]) == tuple(2 * number for number in found)
    assert isinstance(tree, Tree)
