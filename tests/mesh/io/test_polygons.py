"""Polygons of files: faces as they stand, tags of OBJ, what has only triangles, faults."""

import struct
import zlib
from types import SimpleNamespace

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh import read_mesh, read_polygons
from foveal.mesh.io import lines, ply
from mesh.io import samples

POINTS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\n"
HOUSE = POINTS + "f 1 2 3 4\nf 4 3 5\n"
TAGGED = (
    "# a house\nmtllib none.mtl\nt interpolateboundary 1/0/0 1\n" + HOUSE + "t crease 2/1/0 3 2 2.5\n"
    "t crease 4/2/0 0 1 1 2  4.0 inf # two of them\nt corner 1/1/0\t4  1.4\r\nt corner 2/1/0 0 1 10\n"
)


def read(tmp_path, text, name="house.obj"):
    path = tmp_path / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_polygons(path)


def faces_of(mesh):
    return [ring.tolist() for ring in np.split(mesh.corners, mesh.starts[1:-1])]


def assert_same(a, b):
    for name in a.__slots__:
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


def test_tags_of_an_obj(tmp_path):
    mesh = read(tmp_path, TAGGED)
    assert faces_of(mesh) == [[0, 1, 2, 3], [3, 2, 4]]
    assert mesh.crease_edges.tolist() == [[0, 1], [1, 2], [2, 3]]
    assert mesh.crease_sharpness.tolist() == [4, np.inf, 2.5]
    assert mesh.corner_vertices.tolist() == [0, 1, 4]
    assert mesh.corner_sharpness.tolist() == [10, 10, np.float32(1.4)]
    assert mesh.boundary == "edge_and_corner"


def test_chunks_may_be_cut_anywhere(tmp_path, monkeypatch):
    text = TAGGED.replace("f 1 2 3 4", "vt 0 0\nvt 1 0.5\nf 1/1 2/2 3/1 4/2").replace(
        "f 4 3 5", "f 4/2 3/1 5/1"
    )
    whole = read(tmp_path, text)
    assert whole.uvs.tolist() == [[0, 0], [1, 0.5], [0, 0], [1, 0.5], [0, 0]]
    for size in (1, 7, 50, 99):
        monkeypatch.setattr(lines, "_CHUNK_BYTES", size)
        assert_same(read(tmp_path, text), whole)


@pytest.mark.parametrize(("number", "boundary"), [(0, "none"), (1, "edge_and_corner"), (2, "edge_only")])
def test_boundaries_have_the_numbers_of_opensubdiv(number, boundary, tmp_path):
    assert read(tmp_path, HOUSE + f"t interpolateboundary 1/0/0 {number}\n").boundary == boundary


def test_other_tags_are_passed_by(tmp_path):
    text = HOUSE + "t creasemethod 0/0/1 chaikin\nt vertexedit 1/3/2 x\nt\nt \n"
    assert_same(read(tmp_path, text), read(tmp_path, HOUSE))


@pytest.mark.parametrize(
    ("tags", "told"),
    [
        (
            "t creasemethod 0/0/1 chaikin\nt vertexedit 1/3/2 x\nt vertexedit 1/3/2 y\n",
            "creasemethod, vertexedit",
        ),
        ("t creasemethod 0/0/1 normal\nt facevaryinginterpolateboundary 1/0/0 1\n", None),
    ],
)
def test_tags_that_would_give_another_surface_are_told_of(tags, told, tmp_path):
    said = []
    path = tmp_path / "house.obj"
    path.write_text(HOUSE + tags)
    read_polygons(path, progress=SimpleNamespace(note=said.append))
    assert len(said) == (told is not None)
    if told:
        assert f"tags {told} are passed by" in said[0]


def test_holes(tmp_path):
    assert read(tmp_path, HOUSE + "t hole 1/0/0 1\n").holes.tolist() == [1]
    with pytest.raises(FovealError, match="face 2 is to be a hole, but faces go from 0 to 1"):
        read(tmp_path, HOUSE + "t hole 2/0/0 0 2\n")
    with pytest.raises(FovealError, match="all its faces are holes"):
        read(tmp_path, HOUSE + "t hole 1/0/0 0\nt hole 1/0/0 1\n")


def test_texture_coordinates_with_seams_are_left_out(tmp_path):
    seam = POINTS + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1 4/1\nf 4/2 3/1 5/1\n"
    assert read(tmp_path, seam).uvs is None
    assert read(tmp_path, seam.replace("vt 1 1", "vt 0 0")).uvs.tolist() == [[0, 0]] * 5
    assert read(tmp_path, seam.replace("4/2", "4")).uvs is None
    assert read(tmp_path, seam.replace("4/2", "4/9")).uvs is None


def test_colours_are_kept(tmp_path):
    mesh = read(tmp_path, samples.obj(), "solid.obj")
    assert mesh.colours.dtype == np.float32
    np.testing.assert_array_equal(mesh.colours, samples.ATTRIBUTED.colours)
    assert mesh.crease_edges.tolist() == [[0, 1]]


def test_off(tmp_path):
    rows = POINTS.replace("v ", "")
    mesh = read(tmp_path, "OFF\n5 3 0\n" + rows + "4 0 1 2 3\n2 0 1\n3 3 2 4 255 0 0\n", "house.off")
    assert faces_of(mesh) == [[0, 1, 2, 3], [3, 2, 4]]


def ply_of(faces, order=None):
    points = np.array([line.split()[1:] for line in POINTS.splitlines()], float)
    kind = "ascii" if order is None else {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {kind} 1.0\nelement vertex 5\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz") + f"element face {len(faces)}\n"
    head += "property float quality\nproperty list uchar int vertex_indices\nend_header\n"
    if order is None:
        body = "".join(" ".join(map(repr, row)) + "\n" for row in points.tolist())
        body += "".join(f"0.5 {len(f)} " + " ".join(map(str, f)) + "\n" for f in faces)
        return (head + body).encode()
    rows = [struct.pack(f"{order}fB{len(f)}i", 0.5, len(f), *f) for f in faces]
    return head.encode() + points.astype(order + "f8").tobytes() + b"".join(rows)


@pytest.mark.parametrize("chunk", [None, 9, 32, 64])
@pytest.mark.parametrize("order", [None, "<", ">"])
def test_ply(order, chunk, tmp_path, monkeypatch):
    if chunk:
        monkeypatch.setattr(ply, "_CHUNK_BYTES", chunk)
    faces = [[3, 2, 4], [0, 1, 2, 3]]
    assert faces_of(read(tmp_path, ply_of([*faces, [0, 1]], order), "house.ply")) == faces
    pentagon = [[4, 0, 1, 2, 3]]
    assert faces_of(read(tmp_path, ply_of(pentagon, order), "house.ply")) == pentagon


@pytest.mark.parametrize("name", samples.FILES)
def test_the_triangles_are_those_that_are_read_as_such(name, tmp_path):
    path = tmp_path / name
    path.write_bytes(samples.FILES[name]())
    mesh, triangles = read_polygons(path), read_mesh(path)
    assert mesh.faces == 4
    np.testing.assert_array_equal(
        mesh.triangulated().positions[mesh.triangulated().faces], triangles.positions[triangles.faces]
    )
    assert len(mesh.positions) == 4  # of an STL, too


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (HOUSE + "t crease 2/1/0 0 1\n", 'the tag "t crease 2/1/0 0 1" cannot be read'),
        (HOUSE + "t crease 2/1/0 0 one 2\n", "cannot be read"),
        (HOUSE + "t crease 3/1/0 0 1 2 2\n", "cannot be read"),
        (HOUSE + "t crease 2/2/0 0 1 2 2\n", "cannot be read"),
        (HOUSE + "t crease 2 0 1 2\n", "cannot be read"),
        (HOUSE + "t crease\n", "cannot be read"),
        (HOUSE + "t corner 1/1/0 -1 2\n", "cannot be read"),
        (HOUSE + "t interpolateboundary 1/0/0 3\n", "cannot be read"),
        (
            HOUSE + "t crease 2/1/0 0 2 1.5\n",
            "there is no edge between vertices 0 and 2 that could be a crease",
        ),
        (HOUSE + "t crease 2/1/0 0 1 nan\n", "the crease between vertices 0 and 1 has the sharpness nan"),
        (HOUSE + "t corner 1/1/0 5 1\n", "there is no vertex 5 that could be a sharp corner"),
        (HOUSE + "t corner 1/1/0 4 -1\n", "the corner at vertex 4 has the sharpness -1.0"),
        (HOUSE + "f 4 3 1\n", "the edge between vertices 2 and 3 has more than two faces"),
        (HOUSE + "f 4 4 5\n", "face 2 has vertex 3 twice"),
        (POINTS + "f 1 2 9\n", "names vertex 8"),
        (POINTS, "5 points and no triangle"),
    ],
)
def test_faults_are_told_in_a_sentence(text, sentence, tmp_path):
    with pytest.raises(FovealError, match=f"house.obj: .*{sentence}") as told:
        read(tmp_path, text)
    assert str(told.value).endswith(".")
    assert "\n" not in str(told.value)


def test_only_usd_has_prims(tmp_path):
    (tmp_path / "house.obj").write_text(HOUSE)
    with pytest.raises(ValueError, match="only a USD file has prims"):
        read_polygons(tmp_path / "house.obj", prim="/house")


@pytest.mark.parametrize("make", [lambda: TAGGED.encode(), lambda: ply_of([[0, 1, 2, 3], [3, 2, 4]], "<")])
def test_whatever_is_in_a_file_it_is_read_or_refused(make, tmp_path):
    data = make()
    path = tmp_path / ("house.obj" if data.startswith(b"#") else "house.ply")
    rng = np.random.default_rng(zlib.crc32(data))
    damaged = [data[:length] for length in range(len(data))]
    for turn in range(300):
        copy = bytearray(data)
        for _ in range(1 + turn % 3):
            copy[int(rng.integers(len(data)))] = rng.integers(256) if turn % 2 else rng.choice(list(data))
        damaged.append(bytes(copy))
    for content in damaged:
        path.write_bytes(content)
        try:
            mesh = read_polygons(path)
        except FovealError as error:
            told = str(error)
            assert path.name in told
            assert told.endswith(".")
            continue
        assert_same(mesh.checked(), mesh)


SHAPES = ["cube_creases0", "cube_creases2", "cube_corner1", "cube_corner4", "dart_edgeonly", "inf_crease0"]
SHAPES += ["pyramid_creases1", "tent_creases1", "torus_creases0", "edgeonly", "edgenone"]


@pytest.mark.parametrize("shape", SHAPES)
def test_shapes_of_opensubdiv_are_read_as_it_reads_them(shape, shared_data):
    mesh = read_polygons(shared_data(f"base_meshes/opensubdiv_shapes/catmark_{shape}.obj"))
    path = shared_data(f"../reference/cc_osd_crease_{shape}_L1.npz")
    with np.load(path, allow_pickle=False) as truth:
        np.testing.assert_allclose(mesh.positions, truth["V0"], rtol=0, atol=1e-6)
        np.testing.assert_array_equal(mesh.corners, truth["F0_idx"])
        np.testing.assert_array_equal(np.diff(mesh.starts), truth["F0_cnt"])
        tags = ("crease_edges", "crease_sharpness", "corner_vertices", "corner_sharpness")
        found = [
            dict(zip(map(str, getattr(mesh, a)), getattr(mesh, b), strict=True))
            for a, b in (tags[:2], tags[2:])
        ]
        known = [dict(zip(map(str, truth[a]), truth[b], strict=True)) for a, b in (tags[:2], tags[2:])]
        assert found == known
        assert mesh.boundary == str(truth["boundary"])


REFUSED = {
    "catmark_gregory_test4": "vertex 4 several fans",
    "catmark_nonman_edges": "face 24 has vertex 51 twice",
    "catmark_nonman_quadpole8": "face 1 has vertex 4 twice",
    "catmark_nonman_quadpole360": "face 1 has vertex 4 twice",
    "catmark_nonman_verts": "vertex 1 several fans",
    "loop_nonman_edges": "face 51 has vertex 45 twice",
    "loop_nonman_verts": "vertex 1 several fans",
    "loop_val2_interior": "edge between vertices 10 and 11 has more than two faces",
}


def test_all_shapes_of_opensubdiv_are_read_but_those_that_are_no_surfaces(shared_data):
    paths = sorted(shared_data("base_meshes/opensubdiv_shapes").glob("*.obj"))
    assert len(paths) > 70
    for path in paths:
        if path.stem in REFUSED:
            with pytest.raises(FovealError, match=REFUSED[path.stem]):
                read_polygons(path)
        else:
            assert read_polygons(path).faces > 0
