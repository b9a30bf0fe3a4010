"""STL: both encodings, told apart by content; each triangle has three vertices of its own."""

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh.io import lines, stl
from foveal.mesh.io.source import read_mesh
from foveal.mesh.topology import weld
from mesh.io import samples

CORNERS = samples.SOLID.positions[samples.SOLID.faces].reshape(-1, 3)


def read(tmp_path, data):
    path = tmp_path / "mesh.stl"
    path.write_bytes(data)
    return read_mesh(path)


@pytest.mark.parametrize("header", [b"", b"solid", b"solid facet normal endsolid\n", b"COLOR=abcd"])
def test_binary_whatever_its_header_says(header, tmp_path):
    mesh = read(tmp_path, samples.stl_binary(header))
    np.testing.assert_array_equal(mesh.positions, CORNERS.astype(np.float32))
    assert mesh.faces.tolist() == np.arange(12).reshape(4, 3).tolist()


def test_ascii_keeps_every_digit(tmp_path):
    mesh = read(tmp_path, samples.stl_ascii())
    np.testing.assert_array_equal(mesh.positions, CORNERS)
    assert len(weld(mesh)[0].positions) == 4


def test_ascii_in_capitals_with_carriage_returns(tmp_path):
    data = samples.stl_ascii().upper().replace(b"\n", b"\r\n")
    np.testing.assert_array_equal(read(tmp_path, data).positions, CORNERS)


def test_blocks_of_any_size_give_the_same_mesh(tmp_path, monkeypatch):
    for size in (100, 131, 250, 777):
        monkeypatch.setattr(lines, "_CHUNK_BYTES", size)
        monkeypatch.setattr(stl, "_TRIANGLES_A_BLOCK", 1 + size % 3)
        np.testing.assert_array_equal(read(tmp_path, samples.stl_ascii()).positions, CORNERS)
        mesh = read(tmp_path, samples.stl_binary())
        np.testing.assert_array_equal(mesh.positions, CORNERS.astype(np.float32))
        assert mesh.faces.tolist() == np.arange(12).reshape(4, 3).tolist()


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (samples.stl_binary()[:-1], "ends after 3 of the 4 triangles"),
        (samples.stl_binary()[:90], "ends after 0 of the 4 triangles"),
        (samples.stl_binary()[:40], "ends within the header"),
        (samples.stl_binary()[:80] + b"\0\0\0\0", "no vertex"),
        (samples.stl_binary()[:84] + b"\xff" * 200, "vertex 0 has a coordinate that is NaN"),
        (samples.stl_ascii()[:-20], "without endsolid"),
        (samples.stl_ascii().replace(b"vertex ", b"vertex x", 1), "line 4|stands where a number"),
        (b"solid a\nfacet\nouter loop\nvertex 1 2\nendsolid\n", "line 4 is not a vertex"),
        (b"solid a\nendsolid a\n", "no vertex"),
    ],
)
def test_faults_are_told_in_a_sentence(data, sentence, tmp_path):
    with pytest.raises(FovealError, match=sentence):
        read(tmp_path, data)
