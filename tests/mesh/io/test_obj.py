"""OBJ: polygons, relative indices, colours, normals that belong to vertices, textures."""

import numpy as np
import pytest
from PIL import Image

from foveal.base.errors import FovealError
from foveal.mesh.io import lines
from foveal.mesh.io.source import open_source, read_mesh
from mesh.io import samples

POINTS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(tmp_path, text):
    path = tmp_path / "mesh.obj"
    path.write_text(text)
    return read_mesh(path)


def notes(tmp_path, text):
    path = tmp_path / "mesh.obj"
    path.write_text(text)
    return open_source(path).notes


def test_all_at_once(tmp_path):
    mesh = read(tmp_path, samples.obj().decode())
    np.testing.assert_array_equal(mesh.positions, samples.SOLID.positions)
    np.testing.assert_array_equal(mesh.faces, samples.SOLID.faces)
    np.testing.assert_array_equal(mesh.colours, samples.ATTRIBUTED.colours)
    np.testing.assert_allclose(mesh.normals, samples.SOLID.positions, atol=1e-7)


def test_chunks_may_be_cut_anywhere(tmp_path, monkeypatch):
    whole = read(tmp_path, samples.obj().decode())
    for size in (1, 7, 50, 99, 300):
        monkeypatch.setattr(lines, "_CHUNK_BYTES", size)
        mesh = read(tmp_path, samples.obj().decode())
        for name in ("positions", "faces", "normals", "colours"):
            np.testing.assert_array_equal(getattr(mesh, name), getattr(whole, name))


@pytest.mark.parametrize(
    ("line", "faces"),
    [
        ("f 1 2 3 4", [[0, 1, 2], [0, 2, 3]]),
        ("f -4 -3 -2", [[0, 1, 2]]),
        ("f 1/5/6 2/7 3//8", [[0, 1, 2]]),
        ("f 1/ 2/ 3/", [[0, 1, 2]]),
        ("  f\t1  2\t3  # not 4", [[0, 1, 2]]),
        ("f 1 2 \\\r\n3", [[0, 1, 2]]),
        ("f 1 2 \\\n\\\n3 4\nf 1 2 3", [[0, 1, 2], [0, 2, 3], [0, 1, 2]]),
        ("f 1 2\nf 1 2 3\nl 1 2\np 1", [[0, 1, 2]]),
        ("f 1 2 3\r\nf 2 3 4\r", [[0, 1, 2], [1, 2, 3]]),
        ("usemtl a\nf 1 2 3\nusemtl b\nf 4 3 2", [[0, 1, 2], [3, 2, 1]]),
    ],
)
def test_faces(line, faces, tmp_path):
    assert read(tmp_path, POINTS + line).faces.tolist() == faces


def test_faces_may_come_before_their_vertices_and_relative_ones_count_back(tmp_path):
    mesh = read(tmp_path, "f 1 2 3\n" + POINTS + "f -1 -2 -3\nv 5 5 5\nf -1 1 2\n")
    assert mesh.faces.tolist() == [[0, 1, 2], [3, 2, 1], [4, 0, 1]]


def test_a_fourth_coordinate_is_a_weight_and_six_make_a_colour(tmp_path):
    mesh = read(tmp_path, "v 0 0 0 1\nv 1 0 0 1.0 0.5 0\nv 1 1 0\nf 1 2 3\n")
    assert mesh.colours.tolist() == [[255, 255, 255], [255, 128, 0], [255, 255, 255]]


def test_normals_of_their_own_numbers_are_dropped_with_a_note(tmp_path):
    text = POINTS + "vn 0 0 1\nf 1//1 2//1 3//1\n"
    assert read(tmp_path, text).normals is None
    assert "normals were left out" in notes(tmp_path, text)[0]


def test_faces_of_two_corners_are_left_out_with_a_note(tmp_path):
    assert "2 faces of fewer than three" in notes(tmp_path, POINTS + "f 1 2\nf 1\nf 1 2 3\n")[0]


def test_a_texture_is_sampled_into_vertex_colours(tmp_path):
    picture = np.zeros((8, 8, 3), dtype=np.uint8)
    picture[:4, 4:] = [200, 100, 50]  # upper right
    picture[4:, :4] = [10, 20, 30]  # lower left
    Image.fromarray(picture).save(tmp_path / "my stone.png")
    (tmp_path / "mesh.mtl").write_text(
        "newmtl stone\nKd 1 1 1\nmap_Kd -s 1 1 1 my stone.png\nnewmtl b\nKd 0 1 0\n"
    )
    text = "mtllib mesh.mtl\n" + POINTS + "v 7 7 7\nv 8 8 8\nv 9 9 9\n"
    text += "vt 0.25 0.25\nvt 0.75 0.75\nvt 1.75 -0.25\nusemtl stone\nf 1/1 2/2 3/3\n"
    text += "usemtl b\nf 4 5 6\n"
    mesh = read(tmp_path, text)
    assert mesh.colours[:3].tolist() == [[10, 20, 30], [200, 100, 50], [200, 100, 50]]
    assert mesh.colours[3:].tolist() == [[0, 255, 0]] * 3 + [[255, 255, 255]]
    assert notes(tmp_path, text) == ["its texture was sampled into vertex colours"]


def test_a_texture_that_is_no_picture_is_left_out_with_a_note(tmp_path):
    (tmp_path / "stone.png").write_bytes(b"not a picture")
    (tmp_path / "mesh.mtl").write_text("newmtl stone\nmap_Kd stone.png\n")
    text = "mtllib mesh.mtl\n" + POINTS + "vt 0 0\nusemtl stone\nf 1/1 2/1 3/1\n"
    assert read(tmp_path, text).colours is None
    assert notes(tmp_path, text) == ["the texture stone.png cannot be read and was left out"]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (POINTS + "f 1 2 9\n", "triangle 0 names vertex 8, but vertices go from 0 to 3"),
        (POINTS + "f 0 1 2\n", "line 5 names a vertex that does not exist"),
        (POINTS + "f 1 2 3\nf -9 1 2\n", "line 6 names a vertex that does not exist"),
        (POINTS + "f 1 2 x\n", "line 5 has a corner that cannot be read"),
        ("v 0 0\nf 1 1 1\n", "line 1 has too few numbers"),
        ("v 0 0 zero\nf 1 1 1\n", '"zero" stands where a number is due'),
        ("v 0 0 nan\nf 1 1 1\n", "vertex 0 has a coordinate that is NaN"),
        (POINTS, "4 points and no triangle"),
        ("o nothing\n", "no vertex"),
    ],
)
def test_faults_are_told_in_a_sentence(text, sentence, tmp_path):
    with pytest.raises(FovealError, match=sentence):
        read(tmp_path, text)
