"""The door for arrays from outside: what it takes, what it refuses."""

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh

POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
FACES = [[0, 1, 2]]


def test_arrays_become_contiguous_and_of_the_right_types():
    points = np.asfortranarray(np.array(POINTS, np.float32))
    mesh = TriMesh.of(
        points, np.array(FACES, np.uint64), normals=np.array(POINTS) + 1, colours=np.eye(3) * 255
    )
    assert (mesh.positions.dtype, mesh.faces.dtype) == (np.float64, np.int32)
    assert (mesh.normals.dtype, mesh.colours.dtype) == (np.float32, np.uint8)
    assert all(a.flags.c_contiguous for a in (mesh.positions, mesh.faces, mesh.normals, mesh.colours))
    assert mesh.colours.tolist() == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]


def test_normals_become_unit_or_zero():
    mesh = TriMesh.of(POINTS, FACES, normals=[[0, 0, 5], [np.nan, 0, 1], [0, 0, 0]])
    assert mesh.normals.tolist() == [[0, 0, 1], [0, 0, 0], [0, 0, 0]]
    unit = np.array([[0.6, 0.8, 1e-5], [1, 0, 0], [0, 0, -1]], np.float32)
    np.testing.assert_array_equal(TriMesh.of(POINTS, FACES, normals=unit).normals, unit)


@pytest.mark.parametrize(
    ("points", "faces", "more", "part"),
    [
        (np.array(POINTS) * 1j, FACES, {}, "real numbers"),
        (np.array(POINTS).astype(str), FACES, {}, "real numbers"),
        ([[0, 0, 0], [1, 0], [0, 1, 0]], FACES, {}, "as long as the others"),
        (np.zeros((3, 2)), FACES, {}, r"\(n, 3\)"),
        (np.zeros((0, 3)), np.zeros((0, 3), int), {}, "no triangle"),
        (POINTS, np.array(FACES, float), {}, "integers"),
        (POINTS, [[0, 1, 3]], {}, "vertex 3"),
        (POINTS, np.array([[0, 1, 2**32]]), {}, "vertex 4294967296"),
        ([[0, 0, 0], [1, np.inf, 0], [0, 1, 0]], FACES, {}, "vertex 1"),
        (POINTS, FACES, {"colours": [[0.5, 1, 0]] * 3}, "multiply by 255"),
        (POINTS, FACES, {"colours": [[300, 0, 0]] * 3}, "from 0 to 255"),
        (POINTS, FACES, {"colours": np.full((3, 3), -1)}, "from 0 to 255"),
        (POINTS, FACES, {"colours": np.full((3, 3), np.nan)}, "from 0 to 255"),
        (POINTS, FACES, {"colours": np.zeros((3, 4), int)}, r"\(3, 3\)"),
        (POINTS, FACES, {"normals": np.zeros((2, 3))}, r"\(3, 3\)"),
    ],
)
def test_what_is_no_mesh_is_refused_in_a_sentence(points, faces, more, part):
    with pytest.raises(FovealError, match=f"^thing: .*{part}"):
        TriMesh.of(points, faces, name="thing", **more)
