"""The `.fov` of kind "cage" with polygons: what goes in comes out, and no byte that can do harm."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import foveal
from foveal import FovealError
from foveal.container import open_container
from foveal.mesh.poly_shapes import cube, quad_torus
from foveal.mesh.shapes import icosphere
from foveal.refine import Criteria
from foveal.refine import _kernels_slates_layout as layout
from foveal.refine.depth_words import depths_json
from foveal.refine.slates_depth import Depths
from foveal.scene import depth_rules
from foveal.scene.cage_file import read_cage, write_cage
from foveal.scene.cage_polygons import PolygonCounts, told
from foveal.scene.refinement import Refinement, chosen, refinement_json, refinement_of
from scene import golden_cage
from scene.damage import assert_flips_refused, rewritten
from scene.test_cage_file import read

PATCHES = Refinement("catmull-clark", Criteria(), "limit")
FIELDS = [field for field in golden_cage.POLYGONS.__dataclass_fields__ if field != "boundary"]


def are_equal(one, other):
    pairs = [(getattr(one, field), getattr(other, field)) for field in FIELDS]
    return one.boundary == other.boundary and all(
        a is b is None or (a.dtype == b.dtype and np.array_equal(a, b)) for a, b in pairs
    )


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    path = tmp_path_factory.mktemp("cages") / "small.fov"
    write_cage(golden_cage.POLYGONS, path, refinement=PATCHES)
    return path.read_bytes()


HOLED = replace(golden_cage.POLYGONS, holes=np.array([1, 3], np.int32))


@pytest.mark.parametrize("mesh", [cube(), quad_torus(7, 5), golden_cage.POLYGONS, HOLED])
def test_what_goes_in_comes_out(tmp_path, mesh):
    report = write_cage(mesh, tmp_path / "a.fov", refinement=golden_cage.PATCHES, up="x")
    found = read_cage(tmp_path / "a.fov")
    assert are_equal(found.polygons, mesh)
    assert are_equal(found.surface(), mesh)
    assert found.up == "x"
    assert refinement_json(found.refinement) == refinement_json(golden_cage.PATCHES)
    assert report.polygons == PolygonCounts.of(mesh)
    assert (report.vertices, report.triangles) == (len(mesh.positions), len(mesh.corners) - 2 * mesh.faces)
    assert len(found.mesh.faces) == len(mesh.triangulated().faces)


def test_triangles_are_kept_as_polygons(tmp_path):
    write_cage(icosphere(1), tmp_path / "a.fov", refinement=PATCHES)
    found = read_cage(tmp_path / "a.fov")
    assert (found.mesh.faces == icosphere(1).faces).all()
    assert PolygonCounts.of(found.polygons) == PolygonCounts(80, 0, 0, 0, 0, 0, "edge_only")


def test_the_golden_file_is_read_and_written(tmp_path):
    path = golden_cage.FOLDER / "cage_polygons.fov"
    expected = json.loads((golden_cage.FOLDER / "cage_polygons.json").read_text())
    found = read_cage(path)
    for field in FIELDS:
        got = np.minimum(getattr(found.polygons, field), 2.0**100)
        assert got.tolist() == expected.get(field, []), field
    assert (found.polygons.boundary, found.up) == (expected["boundary"], expected["up"])
    assert depths_json(found.refinement.depths) == expected["depths"]
    assert (found.refinement.budget, found.refinement.rate) == (expected["budget"], expected["rate"])
    write_cage(golden_cage.POLYGONS, tmp_path / "again.fov", refinement=golden_cage.PATCHES, up="z")
    with open_container(path) as old, open_container(tmp_path / "again.fov") as new:
        assert old.chunk(0) == new.chunk(0)
        apart = {"generator": 0, "first_bytes": 0}
        assert {**old.header, **apart} == {**new.header, **apart}


def test_holes_are_counted_and_damaged_ones_refused(tmp_path):
    report = write_cage(HOLED, tmp_path / "a.fov", refinement=PATCHES)
    assert told(report.polygons).split(", ")[:4] == ["5 quads", "1 triangle", "1 larger polygon", "2 holes"]
    data = (tmp_path / "a.fov").read_bytes()
    with open_container(data) as file:
        chunk = file.chunk(0)
    assert chunk[-8:] == bytes([1, 0, 0, 0, 3, 0, 0, 0])
    for holes, sentence in (({"holes": 0}, "holes"), ({"holes": 1}, "lengths"), ({"holes": ...}, "lengths")):
        with pytest.raises(FovealError, match=sentence):
            read(rewritten(data, holes))
    with pytest.raises(FovealError, match="face 9 is to be a hole, but faces go from 0 to 6"):
        read(rewritten(data, first=chunk[:-4] + bytes([9, 0, 0, 0])))


def test_every_prefix_is_refused(small):
    for length in range(len(small)):
        with pytest.raises(FovealError):
            read(small[:length])


def test_every_flipped_bit_is_refused(small):
    assert_flips_refused(read, small)


@given(changes=st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), min_size=1, max_size=3))
@settings(max_examples=400, deadline=None)
def test_a_chunk_of_other_bytes_is_refused_or_read_safely(small, changes):
    with open_container(small) as file:
        chunk = bytearray(file.chunk(0))
    for at, value in changes:
        chunk[at % len(chunk)] = value
    try:
        found = read(rewritten(small, first=bytes(chunk))).polygons
    except FovealError:
        return
    assert np.isfinite(found.positions).all()
    assert 0 <= found.corners.min() <= found.corners.max() < 10
    assert found.starts[-1] == len(found.corners)
    found.checked()


@pytest.mark.parametrize(
    ("header", "sentence"),
    [
        ({"version": 1}, "lengths"),
        ({"version": 3}, "cage version 3 is not known"),
        ({"vertices": 11}, "lengths"),
        ({"faces": 8}, "triangles"),
        ({"faces": 0}, "faces"),
        ({"faces": ..., "corners": ...}, "faces"),
        ({"corners": 2**40}, "corners"),
        ({"triangles": 5}, "triangles"),
        ({"creases": -1}, "creases"),
        ({"creases": 3.0}, "creases"),
        ({"creases": 0}, "lengths"),
        ({"sharp_corners": True}, "sharp_corners"),
        ({"boundary": "sharp"}, "boundary"),
        ({"boundary": ...}, "boundary"),
        ({"boundary": ["none"]}, "boundary"),
        ({"attributes": ["uv", "colour"]}, "attributes"),
        ({"attributes": ["normal"]}, "attributes"),
        ({"attributes": [["uv"]]}, "attributes"),
        ({"attributes": []}, "lengths"),
        ({"attributes": ...}, "attributes"),
        ({"scheme": "sqrt3"}, "scheme"),
        ({"up": 3}, "up"),
        ({"box": [[0, 0, 0], [1, 1, 1]]}, "box"),
        ({"depths": 3}, "how it is refined"),
        ({"depths": {"most": 12}}, "how it is refined"),
        ({"depths": {"size_px": [1]}}, "how it is refined"),
        ({"depths": {"cone_degrees": float("nan")}}, "how it is refined"),
    ],
)
def test_a_header_that_makes_no_sense_is_refused(small, header, sentence):
    with pytest.raises(FovealError, match=sentence) as error:
        read(rewritten(small, header))
    assert str(error.value).endswith((".", ". "))


def test_what_a_header_lacks_is_the_default(small):
    found = read(rewritten(small, {"depths": {"most": 3}, "budget": ..., "rate": ...}))
    assert found.refinement.depths == Depths(most=3)
    assert read(rewritten(small, {"depths": ...})).refinement.depths is None


def test_polygons_are_of_one_scheme(tmp_path):
    with pytest.raises(FovealError, match=r"statue\.obj: polygons are refined by catmull-clark alone"):
        write_cage(cube(), tmp_path / "a.fov", refinement=Refinement("loop", Criteria()), name="statue.obj")
    write_cage(cube(), tmp_path / "a.fov", refinement=PATCHES)
    with pytest.raises(FovealError, match="polygons and their creases, which loop does not know"):
        foveal.render(tmp_path / "a.fov", scheme="loop", size=(8, 8))
    assert not list(tmp_path.glob("*.png"))


def test_options_of_patches():
    assert depth_rules.MOST_DEPTH == layout.MOST_DEPTH
    mapped = chosen({"scheme": "catmull-clark", "criteria": {"front": {"iterations": 3, "bend": 0.25}}})
    assert mapped.depths == Depths(most=3, cone=0.25)
    assert mapped.positions == "limit"
    again = mapped.chosen({"depths": {"backs": False}, "budget": 7})
    assert (again.depths, again.budget) == (Depths(most=3, cone=0.25, backs=False), 7)
    assert again.chosen({"depths": Depths(2)}).depths == Depths(2)
    assert refinement_of(json.loads(json.dumps(refinement_json(again))), "here").depths.most == 3
    assert math.isclose(refinement_json(again)["depths"]["cone_degrees"], math.degrees(0.25))


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"scheme": "catmull-clark", "criteria": {"front": {"edge_px": 3}}}, "no length of edges"),
        ({"scheme": "catmull-clark", "criteria": {"back": {"iterations": 3}}}, "no numbers apart"),
        ({"scheme": "catmull-clark", "criteria": Criteria()}, "Choose depths instead"),
        (
            {"scheme": "catmull-clark", "criteria": {"front": {"iterations": 9}}},
            "knows 0 to 8 iterations, got 9",
        ),
        ({"scheme": "catmull-clark", "positions": "control"}, "limit surface only"),
        ({"scheme": "catmull-clark", "sharp_edges": 0.5}, "keeps the creases of the file"),
        ({"scheme": "sqrt3", "depths": {"most": 3}}, "sqrt3 has no rules of depth"),
        ({"depths": {"most": 3}}, "choose a scheme"),
    ],
)
def test_options_that_do_not_fit_are_said(options, sentence):
    with pytest.raises(FovealError, match=sentence):
        chosen(options)
