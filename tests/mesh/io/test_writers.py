"""Writing and reading back: PLY bit for bit, GLB within float32 of its own middle."""

import json

import numpy as np
import pytest
import trimesh

import corpus
from foveal.base.errors import FovealError
from foveal.mesh.io.glb_writer import write_glb
from foveal.mesh.io.ply_writer import write_ply
from foveal.mesh.io.source import open_source, read_mesh
from foveal.mesh.shapes import terrain
from foveal.mesh.trimesh import TriMesh
from mesh.io import samples


def assert_same_attributes(mesh, back, normal_error):
    np.testing.assert_array_equal(mesh.faces, back.faces)
    if mesh.colours is None:
        assert back.colours is None
    else:
        np.testing.assert_array_equal(mesh.colours, back.colours)
    if mesh.normals is not None:
        there = (mesh.normals != 0).any(axis=1)
        np.testing.assert_allclose(back.normals[there], mesh.normals[there], atol=normal_error)


@pytest.mark.parametrize("name", corpus.MESHES)
def test_ply_gives_back_what_was_written(name, tmp_path):
    mesh = corpus.MESHES[name]()
    mesh = TriMesh(mesh.positions.astype(np.float32).astype(float), mesh.faces, mesh.normals, mesh.colours)
    write_ply(mesh, tmp_path / "mesh.ply", comment="made by a test")
    back = read_mesh(tmp_path / "mesh.ply")
    np.testing.assert_array_equal(mesh.positions, back.positions)
    assert_same_attributes(mesh, back, 1e-7)


def test_ply_takes_doubles_only_where_they_are_needed(tmp_path):
    write_ply(terrain(4), tmp_path / "near.ply")
    assert b"property float x" in (tmp_path / "near.ply").read_bytes()
    far = corpus.utm()
    write_ply(far, tmp_path / "far.ply")
    np.testing.assert_array_equal(read_mesh(tmp_path / "far.ply").positions, far.positions)
    vast = TriMesh(terrain(4).positions * 1e300, terrain(4).faces)
    write_ply(vast, tmp_path / "vast.ply")
    np.testing.assert_array_equal(read_mesh(tmp_path / "vast.ply").positions, vast.positions)


@pytest.mark.parametrize("name", corpus.MESHES)
def test_glb_gives_back_what_was_written(name, tmp_path):
    mesh = corpus.MESHES[name]()
    write_glb(mesh, tmp_path / "mesh.glb")
    back = read_mesh(tmp_path / "mesh.glb")
    size = np.ptp(mesh.positions, axis=0).max()
    rounding = np.abs(mesh.positions).max() * 2.0**-50
    np.testing.assert_allclose(back.positions, mesh.positions, rtol=0, atol=size * 2.0**-24 + rounding)
    assert_same_attributes(mesh, back, 1e-6)


def test_texture_coordinates_are_written(tmp_path):
    land = terrain(4)
    uvs = np.random.default_rng(2).uniform(-1, 2, (len(land.positions), 2)).astype(np.float32)
    mesh = TriMesh(land.positions, land.faces, land.normals, None, uvs)
    for suffix, write in ((".ply", write_ply), (".glb", write_glb)):
        write(mesh, path := tmp_path / f"mesh{suffix}")
        other = trimesh.load(path, process=False)
        other = other if suffix == ".ply" else other.geometry.popitem()[1]
        np.testing.assert_allclose(other.visual.uv, uvs, atol=2.0**-22)
        np.testing.assert_array_equal(read_mesh(path).faces, mesh.faces)


def test_every_level_of_every_channel_survives_the_way_to_linear_light(tmp_path):
    land = terrain(16)
    rng = np.random.default_rng(0)
    colours = rng.integers(0, 256, size=land.positions.shape).astype(np.uint8)
    colours[:256] = np.arange(256)[:, None]
    mesh = TriMesh.of(land.positions, land.faces, colours=colours)
    write_glb(mesh, tmp_path / "mesh.glb")
    np.testing.assert_array_equal(read_mesh(tmp_path / "mesh.glb").colours, colours)


def test_glb_has_what_the_standard_asks_for(tmp_path):
    data = samples.glb_written()
    length = int.from_bytes(data[12:16], "little")
    tree = json.loads(data[20 : 20 + length])
    assert int.from_bytes(data[8:12], "little") == len(data)
    assert all(view["byteOffset"] % 4 == 0 for view in tree["bufferViews"])
    position, _, colour, indices = tree["accessors"]
    assert position["min"] < position["max"]
    assert (colour["componentType"], colour["type"], colour["normalized"]) == (5123, "VEC4", True)
    assert indices["componentType"] == 5123
    assert tree["buffers"][0]["byteLength"] == len(data) - 20 - length - 8


def test_more_than_65535_vertices_take_wide_indices(tmp_path):
    mesh = terrain(256)
    write_glb(mesh, tmp_path / "mesh.glb")
    np.testing.assert_array_equal(read_mesh(tmp_path / "mesh.glb").faces, mesh.faces)


@pytest.mark.parametrize(("up", "axis"), [("x", 0), ("y", 1), ("z", 2)])
def test_a_node_turns_the_up_axis_to_y(up, axis, tmp_path):
    mesh = corpus.utm()
    write_glb(mesh, tmp_path / "mesh.glb", up=up)
    back = read_mesh(tmp_path / "mesh.glb")
    np.testing.assert_allclose(back.positions[:, 1], mesh.positions[:, axis], atol=1e-5)
    a, b, c = (back.positions[back.faces[0, i]] for i in range(3))
    d, e, f = (mesh.positions[mesh.faces[0, i]] for i in range(3))
    assert np.cross(b - a, c - a)[1] == pytest.approx(np.cross(e - d, f - d)[axis], rel=1e-4)


def test_nothing_half_written_stays(tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_bytes(b"before")
    mesh = TriMesh(terrain(4).positions, np.zeros((3, 2), np.int32))
    with pytest.raises(ValueError):
        write_ply(mesh, path)
    assert [p.name for p in tmp_path.iterdir()] == ["mesh.ply"]
    assert path.read_bytes() == b"before"


@pytest.mark.parametrize("write", [write_ply, write_glb])
def test_a_folder_is_refused(write, tmp_path):
    with pytest.raises(FovealError, match="folder"):
        write(terrain(4), tmp_path)


def test_a_source_repeats_what_it_read(tmp_path):
    path = tmp_path / "mesh.glb"
    path.write_bytes(samples.glb_written())
    source = open_source(path, up="z")
    assert (source.up, source.has_normals, source.has_colours) == ("z", True, True)
    assert len(list(source.blocks())) == len(list(source.blocks())) == 2
