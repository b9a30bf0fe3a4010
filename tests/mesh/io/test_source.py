"""Opening any file: the format told by content, gzip, faults of the file system, sources from memory."""

import gzip
import tracemalloc

import numpy as np
import pytest

import corpus
from foveal.base.errors import FovealError
from foveal.mesh.io import source as module
from foveal.mesh.io.blocks import FaceBlock, VertexBlock
from foveal.mesh.io.ply_writer import write_ply
from foveal.mesh.io.source import mesh_of, open_source, read_mesh, source_from_mesh
from foveal.mesh.shapes import terrain
from foveal.mesh.topology import inspect, weld
from mesh.io import samples

# A binary STL has no mark of its own, and its size is not known within gzip: only its name tells.
TOLD_BY_CONTENT = [name for name in samples.FILES if name != "packed.stl.gz"]


@pytest.mark.parametrize("name", TOLD_BY_CONTENT)
@pytest.mark.parametrize("suffix", ["", ".dat", ".gz"])
def test_the_content_decides_where_the_name_tells_nothing(name, suffix, tmp_path):
    path = tmp_path / f"unlabelled{suffix}"
    path.write_bytes(samples.FILES[name]())
    welded, _ = weld(read_mesh(path))
    assert (len(welded.positions), len(welded.faces)) == (4, 4)


@pytest.mark.parametrize(
    ("name", "suffix"),
    [
        (name, suffix)
        for name in TOLD_BY_CONTENT
        for suffix in ("ply", "obj", "stl", "glb", "off", "gltf")
        if suffix not in name.split(".")
    ],
)
def test_a_mislabelled_file_is_refused_by_both_names(name, suffix, tmp_path):
    path = tmp_path / f"mislabelled.{suffix}"
    path.write_bytes(samples.FILES[name]())
    with pytest.raises(FovealError, match=rf"named \.{suffix} but (holds|does not begin)"):
        read_mesh(path)


@pytest.mark.parametrize("name", samples.FILES)
def test_all_may_be_gzipped(name, tmp_path):
    path = tmp_path / f"{name}.gz"
    path.write_bytes(gzip.compress(samples.FILES[name]()))
    if not name.endswith(".gz"):
        assert inspect(weld(read_mesh(path))[0]).is_closed


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "empty"),
        (gzip.compress(b""), "empty"),
        (gzip.compress(samples.ply_ascii())[:-9], "gzip data end in the middle"),
        (gzip.compress(samples.ply_ascii())[:60] + b"\0" * 40, "cannot be read to its end|gzip data end"),
        (b"\x89PNG\r\n\x1a\n" + b"\0" * 50, "looks like a PNG picture"),
        (b"LASF" + b"\0" * 50, "looks like a LAS or LAZ point cloud"),
        (b"FOV\x1a" + b"\0" * 50, "a .fov file"),
        (b"Dear reader,\nthis is a letter.\n", "named .ply but does not begin like one; it looks like text"),
        (bytes(range(256)), "looks like binary data"),
    ],
)
def test_what_is_no_mesh_is_named(data, sentence, tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_bytes(data)
    with pytest.raises(FovealError, match=sentence):
        read_mesh(path)


def test_faults_of_the_file_system(tmp_path):
    with pytest.raises(FovealError, match="no such file"):
        open_source(tmp_path / "nowhere.ply")
    with pytest.raises(FovealError, match="this is a folder"):
        open_source(tmp_path)
    with pytest.raises(FovealError, match="cannot be opened"):
        open_source("nul\0byte.ply")
    with pytest.raises(ValueError, match="up must be"):
        open_source(tmp_path, up="north")


def test_an_unknown_suffix_lists_what_is_read(tmp_path):
    path = tmp_path / "mesh.xyzzy"
    path.write_bytes(b"something else entirely")
    with pytest.raises(FovealError, match="PLY, STL, OBJ, OFF or GLB"):
        open_source(path)


@pytest.mark.parametrize("name", corpus.MESHES)
def test_a_mesh_in_memory_is_a_source(name, monkeypatch):
    monkeypatch.setattr(module, "_ROWS", 100)
    mesh = corpus.MESHES[name]()
    source = source_from_mesh(mesh, name=name)
    back = mesh_of(source)
    for attribute in ("positions", "faces", "normals", "colours"):
        np.testing.assert_array_equal(getattr(mesh, attribute), getattr(back, attribute))
    assert source.bytes_read == source.size_hint


@pytest.mark.parametrize("suffix", ["ply", "obj", "stl"])
def test_memory_stays_bounded_whatever_the_size(suffix, tmp_path):
    mesh = terrain(256)
    path = tmp_path / f"mesh.{suffix}"
    if suffix == "ply":
        write_ply(mesh, path)
    elif suffix == "obj":
        rows = [f"v {x} {y} {z}\n" for x, y, z in mesh.positions.tolist()]
        rows += [f"f {a} {b} {c}\n" for a, b, c in (mesh.faces + 1).tolist()]
        path.write_text("".join(rows))
    else:
        table = np.zeros(len(mesh.faces), dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
        table["p"] = mesh.positions[mesh.faces]
        path.write_bytes(b"\0" * 80 + np.uint32(len(table)).tobytes() + table.tobytes())
    peaks = []
    for repeats in (1, 2):  # a file of twice the size must not take more
        if repeats == 2:
            _double(path, suffix)
        source = open_source(path)
        tracemalloc.start()
        rows = 0
        for block in source.blocks():
            size = len(block.positions if isinstance(block, VertexBlock) else block.faces)
            assert size <= 1 << 19
            rows += size if isinstance(block, FaceBlock) else 0
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert rows == repeats * len(mesh.faces)
    assert peaks[1] < 1.3 * peaks[0] + 1e6


def _double(path, suffix):
    data = path.read_bytes()
    if suffix == "ply":
        head, body = data.split(b"end_header\n", 1)
        start = body[-13 * 131072 :]
        path.write_bytes(head.replace(b"face 131072", b"face 262144") + b"end_header\n" + body + start)
    elif suffix == "obj":
        path.write_bytes(data + data)
    else:
        path.write_bytes(data[:80] + np.uint32(2 * 131072).tobytes() + data[84:] + data[84:])
