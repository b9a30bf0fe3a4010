"""The `.fov` of kind "cage": what goes in comes out, and no byte that can do harm."""

import json
import math
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import corpus
from foveal import FovealError, TriMesh
from foveal.container import create, open_container
from foveal.mesh.shapes import bumpy_sphere, icosphere, tetrahedron
from foveal.refine import Criteria, Region, sharp_edges
from foveal.scene.cage_file import control_mesh, is_cage, read_cage, write_cage
from foveal.scene.refinement import Refinement, chosen, refinement_json, refinement_of
from scene import golden_cage
from scene.damage import assert_flips_refused, rewritten

PLAIN = Refinement("sqrt3", Criteria())


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    path = tmp_path_factory.mktemp("cages") / "small.fov"
    write_cage(tetrahedron(), path, refinement=PLAIN)
    return path.read_bytes()


def read(data):
    with open_container(data) as file:
        return control_mesh(file)


@pytest.mark.parametrize("mesh", [tetrahedron(), bumpy_sphere(2), corpus.MESHES["with_hole"]()])
@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_what_goes_in_comes_out(tmp_path, mesh, up):
    refinement = Refinement(
        "loop", Criteria(Region(3, 1.5, 0.1), Region(9), Region(1, 0.25, math.pi)), "limit", 77, 24.5
    )
    report = write_cage(mesh, tmp_path / "a.fov", refinement=refinement, up=up)
    found = read_cage(tmp_path / "a.fov")
    assert (found.mesh.positions == mesh.positions).all()
    assert (found.mesh.faces == mesh.faces).all()
    assert found.up == up
    assert refinement_json(found.refinement) == refinement_json(refinement)
    assert (report.triangles, report.vertices, report.welded) == (len(mesh.faces), len(mesh.positions), 0)
    assert report.bytes == (tmp_path / "a.fov").stat().st_size
    assert is_cage(tmp_path / "a.fov")


def test_the_bytes_are_those_of_the_spec(small):
    with open_container(small) as file:
        assert (file.kind, file.version, len(file)) == ("cage", 1, 1)
        assert file.header["first_bytes"] == len(small)
        chunk, mesh = file.chunk(0), tetrahedron()
    assert struct.unpack("<12d", chunk[:96]) == tuple(mesh.positions.reshape(-1))
    assert struct.unpack("<12I", chunk[96:]) == tuple(mesh.faces.reshape(-1))


def test_the_golden_file_is_read_and_written(tmp_path):
    path = golden_cage.FOLDER / "cage.fov"
    expected = json.loads((golden_cage.FOLDER / "cage.json").read_text())
    found = read_cage(path)
    assert found.mesh.positions.tolist() == expected["positions"]
    assert found.mesh.faces.tolist() == expected["faces"]
    assert (found.up, found.refinement.scheme) == (expected["up"], expected["scheme"])
    assert found.refinement.positions == expected["shown"]
    assert (found.refinement.budget, found.refinement.rate) == (expected["budget"], expected["rate"])
    for name, region in expected["criteria"].items():
        there = getattr(found.refinement.criteria, name)
        assert (there.iterations, there.edge_px) == (region["iterations"], region["edge_px"])
        assert there.bend == pytest.approx(region["bend"], rel=1e-15)
    write_cage(golden_cage.MESH, tmp_path / "again.fov", refinement=golden_cage.REFINEMENT, up="z")
    with open_container(path) as old, open_container(tmp_path / "again.fov") as new:
        assert old.chunk(0) == new.chunk(0)
        assert {**old.header, "generator": 0, "first_bytes": 0} == {
            **new.header,
            "generator": 0,
            "first_bytes": 0,
        }


def test_the_golden_file_with_sharp_edges_is_read_and_written(tmp_path):
    path = golden_cage.FOLDER / "cage_sharp.fov"
    expected = json.loads((golden_cage.FOLDER / "cage_sharp.json").read_text())
    found = read_cage(path)
    assert found.mesh.positions.tolist() == expected["positions"]
    assert found.mesh.faces.tolist() == expected["faces"]
    assert found.sharp.tolist() == expected["sharp"]
    assert 0 < len(found.sharp) < 4
    sharp = {"refinement": golden_cage.SHARP, "sharp_edges": golden_cage.ANGLE}
    report = write_cage(golden_cage.MESH, tmp_path / "again.fov", **sharp)
    assert report.sharp_edges == len(found.sharp)
    with open_container(path) as old, open_container(tmp_path / "again.fov") as new:
        assert old.chunk(0) == new.chunk(0)
        assert old.header["sharp_edges"] == new.header["sharp_edges"]


def test_without_sharp_edges_nothing_is_written_of_them(tmp_path):
    for angle in (None, math.pi):
        write_cage(tetrahedron(), tmp_path / "a.fov", refinement=PLAIN, sharp_edges=angle)
        assert read_cage(tmp_path / "a.fov").sharp is None
        with open_container(tmp_path / "a.fov") as file:
            assert "sharp_edges" not in file.header


def test_sharp_edges_are_those_of_the_welded_mesh(tmp_path):
    mesh = tetrahedron()
    soup = TriMesh(mesh.positions[mesh.faces].reshape(-1, 3), np.arange(12, dtype=np.int32).reshape(-1, 3))
    write_cage(soup, tmp_path / "a.fov", refinement=PLAIN, sharp_edges=1.0)
    found = read_cage(tmp_path / "a.fov")
    assert found.sharp.tolist() == sharp_edges(found.mesh, 1.0).tolist()
    assert len(found.sharp) == 6


def test_too_many_sharp_edges_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("foveal.scene.cage_file._MOST_SHARP", 5)
    with pytest.raises(FovealError, match=r"6 sharp edges, more than the 5 .* larger angle"):
        write_cage(tetrahedron(), tmp_path / "a.fov", refinement=PLAIN, sharp_edges=1.0)
    assert not list(tmp_path.iterdir())


def test_a_soup_is_welded(tmp_path):
    ball = icosphere(1)
    soup = TriMesh(ball.positions[ball.faces].reshape(-1, 3), np.arange(240, dtype=np.int32).reshape(-1, 3))
    report = write_cage(soup, tmp_path / "a.fov", refinement=PLAIN)
    assert (report.vertices, report.welded) == (42, 198)


@pytest.mark.parametrize(
    "name", ["nonmanifold_edge", "nonmanifold_vertex", "flipped", "degenerate_and_duplicate"]
)
def test_what_is_no_surface_is_refused_and_not_written(tmp_path, name):
    with pytest.raises(FovealError, match=r"^statue\.ply: .*\.$"):
        write_cage(corpus.MESHES[name](), tmp_path / "a.fov", refinement=PLAIN, name="statue.ply")
    assert not list(tmp_path.iterdir())


def test_every_prefix_is_refused(small):
    for length in range(len(small)):
        with pytest.raises(FovealError):
            read(small[:length])
    with pytest.raises(FovealError):
        read(small + b"\0\0\0\0")


def test_every_flipped_bit_is_refused(small):
    assert_flips_refused(read, small)


@given(at=st.integers(0, 143), value=st.integers(0, 255))
@settings(max_examples=300, deadline=None)
def test_a_chunk_of_other_bytes_is_refused_or_read_safely(small, at, value):
    mesh = tetrahedron()
    chunk = bytearray(mesh.positions.tobytes() + mesh.faces.astype("<u4").tobytes())
    chunk[at] = value
    data = rewritten(small, first=bytes(chunk))
    try:
        found = read(data)
    except FovealError:
        return
    assert np.isfinite(found.mesh.positions).all()
    assert found.mesh.faces.min() >= 0
    assert found.mesh.faces.max() < 4


@pytest.mark.parametrize(
    ("header", "sentence"),
    [
        ({"version": 3}, "cage version 3 is not known to this foveal, which reads version 1 and 2"),
        ({"version": 2}, "header is damaged"),
        ({"kind": "shadow"}, "holds 'shadow'"),
        ({"vertices": 5}, "lengths"),
        ({"triangles": 3}, "lengths"),
        ({"triangles": 0}, "triangles"),
        ({"triangles": -1}, "triangles"),
        ({"vertices": 2**40}, "vertices"),
        ({"vertices": 4.0}, "vertices"),
        ({"vertices": True}, "vertices"),
        ({"vertices": ...}, "vertices"),
        ({"origin": [0, 0, 1]}, "box"),
        ({"origin": ...}, "box"),
        ({"box": [[0, 0, 0], [1, 1, float("inf")]]}, "box"),
        ({"up": "w"}, "up"),
        ({"up": ...}, "up"),
        ({"sharp_edges": [0]}, "sharp_edges"),
        ({"sharp_edges": [0, 4]}, "sharp_edges"),
        ({"sharp_edges": [0, -1]}, "sharp_edges"),
        ({"sharp_edges": [0, 1.0]}, "sharp_edges"),
        ({"sharp_edges": [True, 2]}, "sharp_edges"),
        ({"sharp_edges": [[0, 1]]}, "sharp_edges"),
        ({"sharp_edges": "01"}, "sharp_edges"),
        ({"sharp_edges": None}, "sharp_edges"),
        ({"scheme": ...}, "scheme"),
        ({"scheme": "catmull"}, "sqrt3, loop, butterfly"),
        ({"scheme": 3}, "scheme"),
        ({"scheme": ["sqrt3"]}, "scheme"),
        ({"criteria": 3}, "how it is refined"),
        ({"criteria": {"front": {"iterations": 31}}}, "iterations"),
        ({"criteria": {"front": {"iterations": "4"}}}, "how it is refined"),
        ({"criteria": {"front": {"edge_px": -1}}}, "edge_px"),
        ({"criteria": {"front": {"edge_px": float("nan")}}}, "edge_px"),
        ({"criteria": {"back": {"bend_degrees": -3}}}, "bend"),
        ({"criteria": {"back": {"bend_degrees": float("nan")}}}, "bend"),
        ({"criteria": {"back": {"bend_degrees": 181}}}, "bend"),
        ({"criteria": {"back": []}}, "how it is refined"),
        ({"positions": "best"}, "positions"),
        ({"budget": -1}, "budget"),
        ({"budget": 1.5}, "budget"),
        ({"rate": float("inf")}, "rate"),
        ({"rate": None}, "how it is refined"),
    ],
)
def test_a_header_that_makes_no_sense_is_refused(small, header, sentence):
    with pytest.raises(FovealError, match=sentence) as error:
        read(rewritten(small, header))
    assert str(error.value).endswith((".", ". "))


def test_what_a_header_lacks_is_the_default(small):
    found = read(rewritten(small, {"criteria": {"front": {"iterations": 2}}, "positions": ..., "rate": ...}))
    assert found.refinement == Refinement("sqrt3", Criteria(front=Region(2, 8.0)))


def test_more_chunks_than_one_are_refused(tmp_path, small):
    with open_container(small) as file, create(tmp_path / "a.fov", kind="cage", version=1) as writer:
        writer.add_chunk(b"more")
        writer.finish({k: v for k, v in file.header.items() if k not in ("kind", "version")}, file.chunk(0))
    with pytest.raises(FovealError, match="lengths"):
        read_cage(tmp_path / "a.fov")


def test_what_is_chosen_goes_before_what_is_there():
    base = Refinement("loop", Criteria(front=Region(1)), "limit", 5, 2.0)
    assert base.chosen({}) is not base
    assert base.chosen({"scheme": None, "budget": None}) == base
    assert base.chosen({"budget": 0, "positions": "control"}) == Refinement(
        "loop", Criteria(front=Region(1)), "control", 0, 2.0
    )
    assert chosen({}) is None
    assert chosen({"scheme": "sqrt3", "rate": 3.0}) == Refinement("sqrt3", Criteria(), rate=3.0)
    with pytest.raises(FovealError, match="choose a scheme"):
        chosen({"budget": 7})
    with pytest.raises(ValueError, match="scheme must be one of"):
        chosen({"scheme": "cubic"})


def test_sharp_edges_are_chosen_with_sqrt3_alone():
    assert chosen({"scheme": "sqrt3", "sharp_edges": 0.5}) == Refinement("sqrt3", Criteria())
    with pytest.raises(FovealError, match="loop knows no sharp edges"):
        chosen({"scheme": "loop", "sharp_edges": 0.5})
    with pytest.raises(FovealError, match="choose a scheme"):
        chosen({"sharp_edges": 0.5})
    for angle in (-0.1, 4.0, math.nan):
        with pytest.raises(ValueError, match="from 0 to pi"):
            chosen({"scheme": "sqrt3", "sharp_edges": angle})


def test_criteria_may_be_changed_in_part():
    base = Refinement("sqrt3", Criteria(front=Region(1, 3.0, 0.5)))
    found = base.chosen({"criteria": {"front": {"edge_px": 2.0}, "back": {"iterations": 1}}})
    assert found.criteria == Criteria(front=Region(1, 2.0, 0.5), back=Region(1))
    with pytest.raises(TypeError):
        base.chosen({"criteria": {"front": {"edges": 2.0}}})


def test_json_and_back():
    refinement = golden_cage.REFINEMENT
    back = refinement_of(json.loads(json.dumps(refinement_json(refinement))), "here")
    assert refinement_json(back) == refinement_json(refinement)
