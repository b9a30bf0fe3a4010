"""A surface in many places: as one mesh of copies it is the same surface; bad matrices are named."""

import numpy as np
import pytest

from foveal import FovealError
from foveal.mesh.poly_shapes import cube
from foveal.mesh.polymesh import PolyMesh
from foveal.refine.slates import Slates
from foveal.refine.slates_placements import Placements, placed
from refine.cages import CAGES

MOVED = np.eye(4)
MOVED[:3, 3] = [5, -2, 1]
LEANT = np.array([[1.5, 0.4, 0, 0], [0, 0.7, 0.2, 9], [0.3, 0, 2, -4], [0, 0, 0, 1.0]])
MIRRORED = np.diag([-1.0, 1, 2, 1])
MATRICES = np.stack([np.eye(4), MOVED, LEANT, MIRRORED])


@pytest.mark.parametrize("name", ["creased_prism", "creased_grid", "holes", "cube"])
def test_copies_are_the_same_surface(name):
    mesh = CAGES[name]()
    copies = placed(mesh, MATRICES).checked()
    assert copies.faces == 4 * mesh.faces
    together, apart = Slates(mesh, placements=MATRICES), Slates(copies)
    depths = np.random.default_rng(3).integers(0, 3, (4, together.patches))
    depths[3] = 2  # mirrored, the patches of a polygon come in another order
    together.show(depths)
    apart.show(depths.reshape(-1))
    one, other = together.arrays(), apart.arrays()
    size = np.ptp(copies.positions, axis=0).max()
    for k in range(4):
        for patch in np.flatnonzero(one.counts[k]).tolist():
            at, there = one.first[k, patch], other.first[0, k * together.patches + patch]
            faces = one.faces[at : at + one.counts[k, patch]]
            corners = one.positions[faces] @ MATRICES[k, :3, :3].T + MATRICES[k, :3, 3]
            theirs = other.positions[other.faces[there : there + len(faces)]]
            if k < 3:  # mirrored, the patch begins at another corner
                assert np.abs(corners - theirs).max() < 1e-12 * size
    assert volume(together.mesh()) == pytest.approx(volume(apart.mesh()), rel=1e-9, abs=1e-12 * size**3)
    unit = np.linalg.norm(apart.mesh().normals, axis=1)
    assert ((np.abs(unit - 1) < 1e-6) | (unit == 0)).all()


def volume(mesh):
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    return float((np.cross(a, b) * c).sum()) / 6


def test_mirrored_copies_keep_their_outside():
    copies = placed(cube(), [MIRRORED])
    assert volume(copies.triangulated()) == pytest.approx(16)
    assert (copies.corners[::4] == cube().corners[::4]).all()  # the first corner stays the first


def test_tags_and_attributes_are_of_each_copy():
    mesh = CAGES["creased_prism"]()
    copies = placed(mesh, MATRICES)
    n = len(mesh.positions)
    for k in range(4):
        part = slice(k * len(mesh.crease_edges), (k + 1) * len(mesh.crease_edges))
        assert (copies.crease_edges[part] == mesh.crease_edges + k * n).all()
        assert (copies.crease_sharpness[part] == mesh.crease_sharpness).all()
    holed = placed(PolyMesh.of(cube().positions, cube().corners.reshape(-1, 4), holes=[1, 5]), MATRICES)
    assert holed.holes.tolist() == [1, 5, 7, 11, 13, 17, 19, 23]
    assert len(copies.corner_vertices) == 4 * len(mesh.corner_vertices)
    np.testing.assert_allclose(
        copies.positions[2 * n : 3 * n], mesh.positions @ LEANT[:3, :3].T + LEANT[:3, 3], atol=1e-12
    )


@pytest.mark.parametrize(
    ("matrix", "sentence"),
    [
        (np.diag([1, 1, np.nan, 1]), "placement 1, counted from 0, has a number that is not finite"),
        (2 * np.eye(4), "placement 1, counted from 0, has a last row other than"),
        (np.diag([1, 0, 1, 1]), "placement 1, counted from 0, flattens"),
        (np.diag([1, 1e-14, 1, 1]), "placement 1, counted from 0, flattens"),
    ],
)
def test_what_is_no_placement_is_named_by_its_number(matrix, sentence):
    with pytest.raises(FovealError, match=rf"^cube\.obj: {sentence}"):
        Placements.of([np.eye(4), matrix], name="cube.obj")


def test_the_smallest_and_the_largest_are_placements():
    found = Placements.of([np.diag([s, s, s, 1]) for s in (1e-120, 1e120)], name="cube.obj")
    assert found.scales.tolist() == [1e-120, 1e120]
