"""OFF: comments, counts where they may stand, polygons, colours and normals, faults."""

import pytest

from foveal.base.errors import FovealError
from foveal.mesh.io.source import open_source, read_mesh

SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def read(tmp_path, text):
    path = tmp_path / "mesh.off"
    path.write_text(text)
    return read_mesh(path)


def test_comments_blank_lines_and_face_colours_are_passed_by(tmp_path):
    mesh = read(tmp_path, "# first\nOFF # here\n\n4 2 0\n" + SQUARE + "# faces\n3 0 1 2 255 0 0\n4 0 1 2 3\n")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 3]]
    assert mesh.colours is None


def test_counts_on_the_first_line(tmp_path):
    assert len(read(tmp_path, "OFF 4 1 0\n" + SQUARE + "3 0 1 2\n").faces) == 1


@pytest.mark.parametrize(
    ("row", "expected"), [("255 0 128 255", [255, 0, 128]), ("1.0 0.0 0.5", [255, 0, 128])]
)
def test_colours(row, expected, tmp_path):
    text = "COFF\n3 1 0\n" + "".join(f"{i} {i * i} 0 {row}\n" for i in range(3)) + "3 0 1 2\n"
    assert read(tmp_path, text).colours.tolist() == [expected] * 3


def test_normals(tmp_path):
    text = "NOFF\n3 1 0\n" + "".join(f"{i} {i * i} 0 0 0 2\n" for i in range(3)) + "3 0 1 2\n"
    assert read(tmp_path, text).normals.tolist() == [[0, 0, 1]] * 3


def test_faces_of_two_corners_are_left_out_with_a_note(tmp_path):
    (tmp_path / "mesh.off").write_text("OFF\n4 2 0\n" + SQUARE + "2 0 1\n3 0 1 2\n")
    assert open_source(tmp_path / "mesh.off").notes == ["1 faces of fewer than three corners were left out"]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("OFF\n4 1 0\n" + SQUARE, "ends after 4 of 5 rows"),
        ("OFF\n1000000000000 1 0\n" + SQUARE, "ends after 4 of"),
        ("OFF\n-4 1 0\n" + SQUARE, "its counts cannot be read"),
        ("OFF BINARY\n" + SQUARE, "its counts cannot be read"),
        ("4OFF\n1 1 0\n1 1 1 1\n3 0 0 0\n", "kind of OFF"),
        ("OFF\n4 1 0\n" + SQUARE + "3 0 1\n", "face 0 cannot be read"),
        ("OFF\n4 1 0\n" + SQUARE + "3 0 1 7\n", "names vertex 7"),
        ("OFF\n4 1 0\n" + SQUARE.replace("1 1 0", "1 one 0") + "3 0 1 2\n", "not three numbers"),
        ("OFF\n4 1 0\n" + SQUARE.replace("1 1 0", "1 nan 0") + "3 0 1 2\n", "vertex 2 has a coordinate"),
        ("OFF\n4 0 0\n" + SQUARE, "4 points and no triangle"),
        ("OFF\n0 0 0\n", "no vertex"),
    ],
)
def test_faults_are_told_in_a_sentence(text, sentence, tmp_path):
    with pytest.raises(FovealError, match=sentence):
        read(tmp_path, text)
