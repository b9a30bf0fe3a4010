"""Whether a control mesh shows its outside."""

import numpy as np
import pytest

import corpus
from foveal import TriMesh
from foveal.mesh.shapes import bumpy_sphere, grid_patch, icosphere, terrain, tetrahedron, torus
from foveal.scene.facing import Once, is_inside_out, tell_inside_out


def turned(mesh):
    return TriMesh(mesh.positions, mesh.faces[:, ::-1].copy())


def with_hole(mesh, height):
    """Open above a height."""
    return TriMesh(mesh.positions, mesh.faces[mesh.positions[mesh.faces].mean(axis=1)[:, 2] < height])


FAR = np.array([455_000.5, 5_020_000.25, 310.125])
SOLIDS = {
    "ball": icosphere(2),
    "bumpy": bumpy_sphere(2),
    "torus": torus(7, 5),
    "tetrahedron": tetrahedron(),
    "far_away": TriMesh(torus(6, 4).positions + FAR, torus(6, 4).faces),
    "plate": TriMesh(icosphere(2).positions * (1.0, 1.0, 1e-4), icosphere(2).faces),
    "huge": TriMesh(icosphere(1).positions * 1e200, icosphere(1).faces),
    "tiny": TriMesh(icosphere(1).positions * 1e-200, icosphere(1).faces),
    "a_hole": with_hole(icosphere(3), 0.8),
}
SHEETS = {
    "grid": grid_patch(4),
    "terrain": terrain(8),
    "bowl": with_hole(icosphere(3), 0.0),
    "triangle": corpus.single_triangle(),
    "two_sides": TriMesh(tetrahedron().positions, np.array([[0, 1, 2], [0, 2, 1]], np.int32)),
    "too_large": TriMesh(icosphere(1).positions * 1.5e308, icosphere(1).faces),
    "nothing": TriMesh(np.zeros((1, 3)), np.zeros((0, 3), np.int32)),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_is_inside_out_if_it_is_turned(name):
    assert not is_inside_out(SOLIDS[name])
    assert is_inside_out(turned(SOLIDS[name]))


@pytest.mark.parametrize("name", SHEETS)
def test_of_a_sheet_nothing_is_said(name):
    assert not is_inside_out(SHEETS[name])
    assert not is_inside_out(turned(SHEETS[name]))


def test_it_is_said_once():
    said = []

    class Notes:
        def note(self, sentence):
            said.append(sentence)

        def stage(self, what, total):
            return what, total

    once = Once(Notes())
    for _ in range(2):
        tell_inside_out(turned(icosphere(1)), "head.off", once)
    tell_inside_out(turned(icosphere(1)), "other.off", once)
    tell_inside_out(icosphere(1), "fine.off", once)
    assert [sentence.partition(":")[0] for sentence in said] == ["head.off", "other.off"]
    assert once.stage("a", 1) == ("a", 1)
