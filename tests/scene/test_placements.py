"""One control mesh in many places: in files, refined, drawn, in live sessions; wrong files told."""

import json

import numpy as np
import pytest

import foveal
from foveal import FovealError
from foveal.container import open_container
from foveal.mesh.poly_shapes import cube, quad_torus
from foveal.refine.slates import Slates
from foveal.refine.slates_placements import placed
from foveal.scene.cage_file import read_cage
from foveal.scene.cage_options import placements_of, read_placements
from foveal.scene.prepare import prepare
from foveal.scene.refine import refine
from foveal.server.warm import begun
from refine.test_slates_placements import MATRICES
from scene import golden_cage
from scene.damage import assert_flips_refused, rewritten
from scene.test_cage_file import read
from scene.test_cage_polygons import are_equal

SCHEME = "catmull-clark"


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    path = tmp_path_factory.mktemp("placed") / "small.fov"
    foveal.build(cube(), path, scheme=SCHEME, placements=MATRICES)
    return path


def test_a_file_keeps_them(small):
    cage = read_cage(small)
    assert (cage.placements == MATRICES).all()
    assert are_equal(cage.polygons, cube())
    assert are_equal(cage.in_place(), placed(cube(), MATRICES))
    box = foveal.info(small)["box"]
    everywhere = placed(cube(), MATRICES).positions
    assert box == [everywhere.min(axis=0).tolist(), everywhere.max(axis=0).tolist()]
    assert (foveal.info(small)["placements"], foveal.check(small)["placements"]) == (4, 4)
    assert len(foveal.export(small).faces) == 48


def test_without_any_the_file_is_as_it_was(tmp_path):
    foveal.build(cube(), tmp_path / "a.fov", scheme=SCHEME)
    with open_container(tmp_path / "a.fov") as file:
        assert len(file) == 1
        assert "placements" not in file.header
    assert read_cage(tmp_path / "a.fov").placements is None


def test_the_golden_file_is_read_and_written(tmp_path):
    expected = json.loads((golden_cage.FOLDER / "cage_placed.json").read_text())
    found = read_cage(golden_cage.FOLDER / "cage_placed.fov")
    assert found.placements.tolist() == expected["placements"]
    assert found.mesh.positions.tolist() == expected["positions"]
    assert are_equal(found.polygons, golden_cage.POLYGONS)
    golden_cage.write_placed(tmp_path / "again.fov")
    with (
        open_container(golden_cage.FOLDER / "cage_placed.fov") as old,
        open_container(tmp_path / "again.fov") as new,
    ):
        assert [old.chunk(i) for i in range(2)] == [new.chunk(i) for i in range(2)]


def test_the_golden_file_with_holes_is_read_and_written(tmp_path):
    expected = json.loads((golden_cage.FOLDER / "cage_holed.json").read_text())
    found = read_cage(golden_cage.FOLDER / "cage_holed.fov")
    assert found.polygons.holes.tolist() == expected["holes"]
    in_place = found.in_place()
    assert in_place.faces - len(in_place.holes) == expected["shown"]
    golden_cage.write_holed(tmp_path / "again.fov")
    with (
        open_container(golden_cage.FOLDER / "cage_holed.fov") as old,
        open_container(tmp_path / "again.fov") as new,
    ):
        assert [old.chunk(i) for i in range(2)] == [new.chunk(i) for i in range(2)]


def test_they_are_built_anew_refined_and_drawn(small, tmp_path):
    surface = Slates(cube(), placements=MATRICES)
    surface.show(2)
    for source, more in ((small, {}), (cube(), {"placements": MATRICES})):
        found = refine(source, everywhere=True, depths={"most": 2}, scheme=SCHEME, **more)
        assert (found.positions == surface.mesh().positions).all()
    other = refine(small, everywhere=True, depths={"most": 1}, placements=MATRICES[:2])
    assert len(other.faces) == 2 * 6 * 8
    foveal.build(small, tmp_path / "a.fov", scheme=SCHEME, depths={"most": 3})
    assert (read_cage(tmp_path / "a.fov").placements == MATRICES).all()
    foveal.build(small, tmp_path / "b.fov", scheme="sqrt3")
    assert len(read_cage(tmp_path / "b.fov").mesh.faces) == 48
    picture = foveal.render(small, size=(48, 32))
    assert (
        np.asarray(picture)
        == np.asarray(foveal.render(cube(), scheme=SCHEME, placements=MATRICES, size=(48, 32)))
    ).all()


def test_each_choice_is_a_file_of_its_own_in_the_cache(tmp_path):
    # More numbers than NumPy writes out of an array.
    many = np.tile(np.eye(4), (100, 1, 1))
    many[:, 0, 3] = np.arange(100) * 3
    other = many.copy()
    other[50, 1, 3] = 1
    paths = {
        prepare(cube(), folder=tmp_path, scheme=SCHEME, placements=m) for m in (many, other, many.tolist())
    }
    assert len(paths) == 2


def test_a_live_session_has_all_places(small):
    session = begun(read_cage(small), SCHEME, "small.fov")
    low, high = (np.array(corner) for corner in foveal.info(small)["box"])
    assert session.origin == pytest.approx(low / 2 + high / 2)
    assert session._surface.patches == 24


@pytest.mark.parametrize(
    ("header", "sentence"),
    [
        ({"placements": 3}, "placements"),
        ({"placements": 0}, "placements"),
        ({"placements": ...}, "lengths"),
        ({"placements": 2.0}, "placements"),
        ({"box": [[-1, -1, -1], [1, 1, 1]]}, "box"),
    ],
)
def test_a_header_that_makes_no_sense_is_refused(small, header, sentence):
    with pytest.raises(FovealError, match=sentence):
        read(rewritten(small.read_bytes(), header))


def test_every_prefix_and_flipped_bit_is_refused(small):
    whole = small.read_bytes()
    for length in range(0, len(whole), 3):
        with pytest.raises(FovealError):
            read(whole[:length])
    assert_flips_refused(read, whole)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("[]", "an array of matrices"),
        ("7", "an array of matrices"),
        ('{"placements": []}', "an array of matrices"),
        ("[[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], 3]", "placement 1, counted from 0, is not four rows"),
        ("[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "placement 0, counted from 0, is not four rows"),
        ('[[[1,0,0,"0"],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]', "is not four rows"),
        ("[[[1,0,0,true],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]", "is not four rows"),
        ("[[[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]]", "flattens"),
        ("[[[1,0,0,Infinity],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]", "not finite"),
        ("[[", "not JSON"),
    ],
)
def test_files_of_them(tmp_path, text, sentence):
    path = tmp_path / "many.json"
    path.write_text(text)
    with pytest.raises(FovealError, match=rf"many\.json: .*{sentence}"):
        read_placements(path)
    path.write_text(json.dumps(MATRICES.tolist()))
    assert (read_placements(path) == MATRICES).all()


def test_too_many_and_too_far():
    with pytest.raises(
        FovealError, match=r"ring: 700,000 placements of 96 corners are more than the 67,108,864"
    ):
        placements_of(np.broadcast_to(np.eye(4), (700_000, 4, 4)), quad_torus(6, 4), "ring")
    with pytest.raises(FovealError, match="ring: placement 0, counted from 0, leads beyond"):
        placements_of([np.diag([1e308, 1e308, 1e308, 1])], quad_torus(6, 4, major=40), "ring")
    with pytest.raises(FovealError, match="loop refines in one place only"):
        refine(cube().triangulated(), scheme="loop", placements=MATRICES)
