"""PLY: every encoding gives the same mesh; polygons, strips, attributes; each fault one sentence."""

import struct

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh.io import ply
from foveal.mesh.io.blocks import FaceBlock, VertexBlock
from foveal.mesh.io.source import mesh_of, open_source, read_mesh
from mesh.io import samples


def read(tmp_path, data, name="mesh.ply"):
    path = tmp_path / name
    path.write_bytes(data)
    return read_mesh(path)


def ascii_ply(vertices, lists, *, element="face", count=None):
    """A file of x, y, z and lists of indices, written plainly."""
    text = f"ply\nformat ascii 1.0\nelement vertex {len(vertices) if count is None else count}\n"
    text += "property float x\nproperty float y\nproperty float z\n"
    text += f"element {element} {len(lists)}\nproperty list int int vertex_indices\nend_header\n"
    text += "".join(" ".join(map(str, v)) + "\n" for v in vertices)
    return (text + "".join(f"{len(k)} " + " ".join(map(str, k)) + "\n" for k in lists)).encode()


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 1.5, 0)]


def test_ascii(tmp_path):
    mesh = read(tmp_path, samples.ply_ascii())
    np.testing.assert_array_equal(mesh.positions, samples.SOLID.positions)
    np.testing.assert_array_equal(mesh.faces, samples.SOLID.faces)
    assert mesh.normals is None
    assert mesh.colours is None


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("count", ["B", "b", "H", "i"])
@pytest.mark.parametrize("index", ["h", "H", "i", "I", "B"])
def test_binary_of_all_integer_types_with_attributes(order, count, index, tmp_path):
    mesh = read(tmp_path, samples.ply_binary(order, count, index))
    np.testing.assert_array_equal(mesh.positions, samples.SOLID.positions)
    np.testing.assert_array_equal(mesh.faces, samples.SOLID.faces)
    np.testing.assert_array_equal(mesh.colours, samples.ATTRIBUTED.colours)
    np.testing.assert_allclose(mesh.normals, samples.SOLID.positions, atol=1e-7)


@pytest.mark.parametrize("order", ["<", ">"])
def test_strips_restart_and_turn_every_second_triangle(order, tmp_path):
    mesh = read(tmp_path, samples.ply_strips(order))
    assert mesh.faces.tolist() == [[0, 1, 2], [2, 1, 3], [1, 0, 3], [3, 0, 2]]


def test_polygons_become_fans_in_order(tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_bytes(ascii_ply(SQUARE, [[0, 1, 2, 3], [3, 2, 4], [0, 1], [0, 1, 2, 4, 3]]))
    source = open_source(path)
    mesh = mesh_of(source)
    assert source.notes == ["1 faces of fewer than three corners were left out"]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [3, 2, 4], [0, 1, 2], [0, 2, 4], [0, 4, 3]]


def test_elements_in_any_order_and_lists_beside_vertices(tmp_path):
    lines = ["ply", "format ascii 1.0", "element face 1", "property list uchar int vertex_indices"]
    lines += ["element vertex 3", "property list uchar float weights"]
    lines += [f"property float {axis}" for axis in "zyx"]
    lines += ["end_header", "3 2 1 0", "2 9 9 30 20 10", "0 31 21 11", "1 9 32 22 12"]
    text = "\n".join(lines) + "\n"
    mesh = read(tmp_path, text.encode())
    assert mesh.faces.tolist() == [[2, 1, 0]]
    assert mesh.positions.tolist() == [[10, 20, 30], [11, 21, 31], [12, 22, 32]]


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_line_ends_of_all_systems(end, tmp_path):
    head, body = samples.ply_binary().split(b"end_header\n")
    data = (head + b"end_header\n").replace(b"\n", end) + body
    assert read(tmp_path, data).faces.tolist() == samples.SOLID.faces.tolist()


@pytest.mark.parametrize(
    ("kind", "values", "expected"),
    [
        ("uchar", [255, 0, 128], [255, 0, 128]),
        ("float", [1, 0, 0.5], [255, 0, 128]),
        ("float", [255, 0, 128], [255, 0, 128]),
        ("ushort", [65535, 0, 257], [255, 0, 1]),
        ("int", [300, -5, 17], [255, 0, 17]),
    ],
)
def test_colours_of_all_types(kind, values, expected, tmp_path):
    text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    text += "".join(f"property {kind} diffuse_{c}\n" for c in ("red", "green", "blue"))
    text += "element face 1\nproperty list uchar int vertex_index\nend_header\n"
    text += "".join(f"{i} {i * i} 0 {' '.join(map(str, values))}\n" for i in range(3)) + "3 0 1 2\n"
    assert read(tmp_path, text.encode()).colours.tolist() == [expected] * 3


@pytest.mark.parametrize("name", ["ascii.ply", "little.ply", "strips.ply"])
def test_blocks_of_any_size_give_the_same_mesh(name, tmp_path, monkeypatch):
    from foveal.mesh.io import numbers

    path = tmp_path / name
    path.write_bytes(samples.FILES[name]())
    whole = read_mesh(path)
    monkeypatch.setattr(numbers, "_LONGEST_TOKEN", 30)
    for size in (33, 40, 57, 100, 333):
        monkeypatch.setattr(ply, "_CHUNK_BYTES", size)
        monkeypatch.setattr(numbers, "_CHUNK_BYTES", size)
        source = open_source(path)
        blocks = list(source.blocks())
        assert len(blocks) > 2 or size > 40
        points = np.concatenate([b.positions for b in blocks if isinstance(b, VertexBlock)])
        faces = np.concatenate([b.faces for b in blocks if isinstance(b, FaceBlock)])
        np.testing.assert_array_equal(points, whole.positions)
        np.testing.assert_array_equal(faces, whole.faces)
        assert source.bytes_read == source.size_hint == path.stat().st_size


def test_an_iterator_closed_early_closes_the_file(tmp_path):
    path = tmp_path / "mesh.ply"
    path.write_bytes(samples.ply_binary())
    blocks = open_source(path).blocks()
    next(blocks)
    blocks.close()  # a file left open would be a ResourceWarning, which is an error in these tests


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (ascii_ply(SQUARE, [[0, 1, 9]]), "triangle 0 names vertex 9, but vertices go from 0 to 4"),
        (ascii_ply(SQUARE, [[0, 1, 2], [0, -7, 1]]), "triangle 1 names vertex -7"),
        (ascii_ply([(0, 0, 0), (0, "nan", 1)], [[0, 1, 1]]), "vertex 1 has a coordinate that is NaN"),
        (ascii_ply([(0, 0, 0), (0, "1e999", 1)], [[0, 1, 1]]), "vertex 1 has a coordinate that is NaN"),
        (ascii_ply(SQUARE, []), "5 points and no triangle"),
        (ascii_ply([], []), "no vertex"),
        (ascii_ply(SQUARE, [[0, 1, 2]], count=10**12), "ends after .* of 1000000000000 rows of vertex"),
        (ascii_ply(SQUARE, [[0, 1, 2]], count=-3), 'line 3 of the PLY header, "element vertex -3"'),
        (ascii_ply(SQUARE, [[0, 1.5, 2]]), "face 0 has an index that is no such number"),
        (ascii_ply(SQUARE, [[0, 1, 2]]).replace(b"3 0 1 2", b"-3 0 1 2"), "a list whose length"),
        (ascii_ply(SQUARE, [[0, "x", 2]]), '"x" stands where a number is due'),
        (samples.ply_binary()[:-3], "ends after 3 of 4 rows of face"),
        (samples.ply_ascii().replace(b"end_header", b"end"), "no end_header"),
        (samples.ply_ascii().replace(b"double x", b"double u"), "no vertices with x, y and z"),
        (samples.ply_ascii().replace(b"format ascii 1.0", b"format morse 1.0"), "line 2 of the PLY header"),
        (samples.ply_ascii().replace(b"format ascii 1.0\n", b""), "no format line"),
        (samples.ply_ascii().replace(b"element face", b"element vertex"), "names an element twice"),
    ],
)
def test_faults_are_told_in_a_sentence(data, sentence, tmp_path):
    with pytest.raises(FovealError, match=sentence) as caught:
        read(tmp_path, data)
    assert str(caught.value).startswith("mesh.ply: ")


def test_a_list_that_claims_more_than_the_file_has_costs_no_memory(tmp_path):
    head, _ = samples.ply_strips().split(b"end_header\n")
    body = samples.SOLID.positions.astype("<f4").tobytes() + struct.pack("<3i", 2**31 - 1, 0, 1)
    with pytest.raises(FovealError, match="ends after 0 of 1 rows of tristrips"):
        read(tmp_path, head + b"end_header\n" + body)
