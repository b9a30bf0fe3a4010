"""The three forms of `build`, and whatever a programmer or a file may get wrong."""

import numpy as np
import pytest

import foveal
from foveal import FovealError, TriMesh
from foveal.mesh.shapes import icosphere
from foveal.scene.build import title_of

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setattr("foveal.scene.prepare.cache_folder", lambda: tmp_path / "cache")


def test_arrays_lists_a_mesh_and_a_file_give_the_same_bytes(tmp_path):
    from foveal.mesh.io import write_ply

    mesh = TriMesh.of(POINTS, FACES)
    write_ply(mesh, tmp_path / "mesh.ply")
    forms = [(POINTS, FACES), (POINTS.tolist(), FACES.tolist()), (mesh,), (tmp_path / "mesh.ply",)]
    found = set()
    for number, form in enumerate(forms):
        path = tmp_path / f"{number}.fov"
        foveal.build(*form, path)
        found.add(path.read_bytes())
    assert len(found) == 1


@pytest.mark.parametrize(
    "arguments", [(), (POINTS,), (POINTS, FACES), ("a.ply",), ("a.ply", "b", "c"), (None, "a.fov")]
)
def test_another_number_of_arguments_is_refused(arguments):
    with pytest.raises(TypeError, match="build"):
        foveal.build(*arguments)


def test_what_cannot_be_built_is_said_before_any_work(tmp_path):
    with pytest.raises(FovealError, match=r"end in \.fov"):
        foveal.build(POINTS, FACES, tmp_path / "a.ply")
    (tmp_path / "scene.json").write_text("{}")
    with pytest.raises(FovealError, match="one by one"):
        foveal.build(tmp_path / "scene.json", tmp_path / "a.fov")
    foveal.build(POINTS, FACES, tmp_path / "a.fov")
    with pytest.raises(FovealError, match="the input itself"):
        foveal.build(tmp_path / "a.fov", tmp_path / "a.fov")


WRONG = {
    "NaN": (TriMesh(np.full((3, 3), np.nan), np.array([[0, 1, 2]], np.int32)), "NaN"),
    "index": (TriMesh(POINTS, np.array([[0, 1, 9]], np.int32)), "vertex 9"),
    "empty": (TriMesh(np.empty((0, 3)), np.empty((0, 3), np.int32)), "no triangle"),
    "colours": (TriMesh(POINTS, FACES.astype(np.int32), None, np.zeros((2, 3), np.uint8)), "colours"),
}


@pytest.mark.parametrize("name", WRONG)
def test_every_verb_checks_a_mesh_that_nobody_checked(tmp_path, viewer, name):
    mesh, part = WRONG[name]
    for verb in (
        lambda: foveal.build(mesh, tmp_path / "a.fov"),
        lambda: foveal.render(mesh, size=(8, 8)),
        lambda: foveal.export(mesh, tmp_path / "a.ply"),
        lambda: foveal.export(mesh, triangles=9),
        lambda: foveal.info(mesh),
        lambda: foveal.publish(mesh, tmp_path / "site", viewer=viewer),
        lambda: foveal.view(mesh, open_browser=False, viewer=viewer),
    ):
        with pytest.raises(FovealError, match=part):
            verb()
    assert list(tmp_path.iterdir()) == [viewer]


def test_arrays_of_other_types_are_taken_as_they_are_meant():
    mesh = TriMesh(POINTS.astype(np.float32), FACES)
    assert foveal.info(mesh)["triangles"] == 4
    assert foveal.render(mesh, size=(8, 8)).shape == (8, 8, 3)


@pytest.mark.parametrize("source", [None, 3, POINTS])
def test_what_is_neither_a_path_nor_a_mesh_is_said(tmp_path, viewer, source):
    for verb in (
        foveal.render,
        foveal.export,
        foveal.info,
        lambda source: foveal.publish(source, tmp_path / "site", viewer=viewer),
    ):
        with pytest.raises(TypeError, match=r"TriMesh\.of"):
            verb(source)


@pytest.mark.parametrize("verb", [foveal.render, foveal.export])
def test_limits_that_make_no_sense_are_said(verb):
    with pytest.raises(FovealError, match="at least one triangle"):
        verb(icosphere(1), triangles=0)
    with pytest.raises(ValueError, match="up must be"):
        verb(icosphere(1), up="w")


def test_titles():
    names = ["a.ply", "a.ply.gz", "a.PLY.GZ", "a", ".ply", "a.b.c", "x/y.z/a.ply"]
    assert [title_of(name) for name in names] == ["a", "a", "a", "a", ".ply", "a.b", "a"]
