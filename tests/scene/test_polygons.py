"""Polygons in memory, in all verbs that take a mesh; what is chosen of them when a control mesh is made."""

import numpy as np
import pytest

import foveal
from foveal import FovealError
from foveal.mesh import PolyMesh
from foveal.mesh.poly_shapes import cube
from foveal.mesh.shapes import icosphere
from foveal.refine.slates import Slates
from foveal.refine.slates_pairs import paired
from foveal.scene.cage_file import read_cage
from foveal.scene.prepare import load, prepare
from foveal.scene.refine import refine
from scene.test_cage_polygons import are_equal

SCHEME = "catmull-clark"
CREASED = PolyMesh.of(
    cube().positions, cube().corners.reshape(-1, 4), creases={(0, 1): 10, (1, 3): 2.5}, sharp_corners={6: 10}
)


def test_a_control_mesh_is_built_of_it(tmp_path):
    report = foveal.build(CREASED, tmp_path / "a.fov", scheme=SCHEME)
    assert report.polygons.creases == 2
    assert are_equal(read_cage(tmp_path / "a.fov").polygons, CREASED)


def test_without_a_scheme_or_by_another_it_is_triangles(tmp_path, notes):
    foveal.build(CREASED, tmp_path / "a.fov")
    assert foveal.info(tmp_path / "a.fov")["triangles"] == 12
    foveal.build(CREASED, tmp_path / "b.fov", scheme="sqrt3", progress=notes)
    assert read_cage(tmp_path / "b.fov").polygons is None
    assert "Kept as plain triangles, since sqrt3 knows nothing else: 6 quads, 2 creases" in " ".join(
        notes.said
    )
    assert len(foveal.export(CREASED).faces) == 12


def test_it_is_refined_with_its_creases():
    found = refine(CREASED, everywhere=True, depths={"most": 3})
    surface = Slates(CREASED)
    surface.show(3)
    assert (found.positions == surface.mesh().positions).all()
    assert len(refine(CREASED, everywhere=True, scheme="sqrt3").faces) == 12 * 3**4


def test_it_is_shown_drawn_and_published(tmp_path):
    scene = load(CREASED, scheme=SCHEME)
    assert are_equal(read_cage(scene.layers[0].path).polygons, CREASED)
    (tmp_path / "viewer").mkdir()
    (tmp_path / "viewer" / "index.html").write_text("<!doctype html>")
    with foveal.view(CREASED, scheme=SCHEME, viewer=tmp_path / "viewer", open_browser=False, port=0) as shown:
        assert shown.url
    foveal.publish(CREASED, tmp_path / "site", scheme=SCHEME, viewer=tmp_path / "viewer")
    assert are_equal(read_cage(tmp_path / "site" / "data" / "mesh.fov").polygons, CREASED)
    flat = foveal.render(CREASED, size=(32, 24))
    round_ = foveal.render(CREASED, size=(32, 24), scheme=SCHEME)
    assert flat.shape == round_.shape == (24, 32, 3)
    assert (np.asarray(flat) != np.asarray(round_)).any()


def test_its_tags_name_the_file_in_the_cache(tmp_path):
    other = PolyMesh.of(cube().positions, cube().corners.reshape(-1, 4), boundary="none")
    paths = [prepare(mesh, folder=tmp_path, scheme=SCHEME) for mesh in (CREASED, cube(), other, CREASED)]
    assert len(set(paths)) == 3
    assert paths[0] == paths[3]


def test_info_counts_it():
    facts = foveal.info(CREASED)
    assert (facts["triangles"], facts["polygons"]["quads"], facts["polygons"]["semi_sharp"]) == (12, 6, 1)


def test_broken_ones_are_refused_in_a_sentence(tmp_path):
    torn = PolyMesh(CREASED.positions, CREASED.starts, CREASED.corners * 0)
    for verb in (foveal.render, foveal.info, lambda mesh: foveal.build(mesh, tmp_path / "a.fov")):
        with pytest.raises(FovealError, match="mesh: face 0 has vertex 0 twice"):
            verb(torn)
    with pytest.raises(TypeError, match=r"TriMesh\.of.*PolyMesh\.of; got int"):
        foveal.render(3)


def test_triangles_are_paired_when_the_control_mesh_is_made(tmp_path):
    ball = icosphere(2)
    foveal.build(ball, tmp_path / "a.fov", scheme=SCHEME, pair_triangles=True)
    found = read_cage(tmp_path / "a.fov").polygons
    assert are_equal(found, paired(ball).checked())
    foveal.build(ball, tmp_path / "b.fov", scheme=SCHEME, pair_triangles=False)
    foveal.build(tmp_path / "b.fov", tmp_path / "c.fov", scheme=SCHEME, pair_triangles=True)
    assert are_equal(read_cage(tmp_path / "c.fov").polygons, found)
    for source in (ball, tmp_path / "b.fov"):
        mesh = refine(source, everywhere=True, depths={"most": 2}, scheme=SCHEME, pair_triangles=True)
        assert len(mesh.faces) == 160 * 2 * 4**2
    one, two = (prepare(ball, folder=tmp_path, scheme=SCHEME, pair_triangles=on) for on in (True, None))
    assert one != two


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"scheme": SCHEME, "pair_triangles": True}, r"mesh: it has no two triangles side by side"),
        (
            {"scheme": "loop", "pair_triangles": True},
            "loop refines triangles as they are. Choose catmull-clark",
        ),
        ({"pair_triangles": True}, "choose a scheme, such as catmull-clark"),
        ({"scheme": SCHEME, "prim": "/a"}, "mesh: only a USD file has prims"),
        ({"scheme": "sqrt3", "prim": "/a"}, "sqrt3 reads no USD"),
    ],
)
def test_what_does_not_fit_is_said(tmp_path, options, sentence):
    with pytest.raises(FovealError, match=sentence):
        foveal.build(cube(), tmp_path / "a.fov", **options)
    assert not (tmp_path / "a.fov").exists()
