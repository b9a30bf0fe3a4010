"""Triangles paired into quadrangles: each once, on the same surface, few left over."""

from dataclasses import replace

import numpy as np
import pytest

from corpus import MANIFOLD, MESHES
from foveal.mesh.poly_shapes import quad_torus
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.shapes import icosphere, torus
from foveal.refine.slates import Slates
from foveal.refine.slates_pairs import paired


def half_edges(faces):
    return {(a, b) for face in faces for a, b in zip(face, [*face[1:], face[0]], strict=True)}


def rows(mesh):
    return [ring.tolist() for ring in np.split(mesh.corners, mesh.starts[1:-1])]


@pytest.mark.parametrize("name", sorted(set(MANIFOLD) - {"flipped", "moebius"}))  # which are not oriented
def test_quadrangles_are_two_triangles_each(name):
    mesh = MESHES[name]()
    quads = rows(paired(mesh))
    sizes = np.array([len(face) for face in quads])
    assert set(sizes) <= {3, 4}
    assert (sizes - 2).sum() == len(mesh.faces)
    triangles = half_edges(mesh.faces.tolist())
    ours = half_edges(quads)
    assert ours <= triangles
    assert all((b, a) in triangles for a, b in triangles - ours)
    assert len(triangles) - len(ours) == 2 * (sizes == 4).sum()
    paired(mesh).checked(name)


def test_nothing_is_left_over_where_all_can_be_paired():
    for mesh in (torus(9, 7), icosphere(2)):
        assert (np.diff(paired(mesh).starts) == 4).all()
    surface = Slates(icosphere(2), pair_triangles=True)
    assert surface.patches == len(icosphere(2).faces) // 2
    surface.show(1)
    radius = np.linalg.norm(surface.mesh().positions, axis=1)
    assert 0.9 < radius.min() < radius.max() < 1


def test_other_faces_and_creases_stay():
    fan = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5, 6]]
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0.2], [0, -1, 0], [1, -1, 0]]
    mesh = PolyMesh.of(points, fan, creases={(1, 4): 2, (3, 4): 0}, sharp_corners={4: 3})
    found = paired(mesh)
    assert sorted(map(sorted, rows(found))) == [[0, 1, 3, 4], [0, 1, 5, 6], [1, 2, 3, 4]]
    assert found.checked().crease_edges.tolist() == [[1, 4], [3, 4]]
    assert found.corner_vertices.tolist() == [4]
    surface = Slates(mesh, pair_triangles=True)
    assert surface.patches == 3
    assert paired(quad_torus(5, 4)).faces == 20  # nothing to pair
    holed = paired(replace(mesh, holes=np.array([2, 4], np.int32)))
    assert sorted(map(sorted, rows(holed))) == [[0, 1, 3, 4], [0, 1, 5, 6], [1, 2, 4], [2, 3, 4]]
    assert holed.holes.tolist() == [2, 3]
    holed = paired(replace(mesh, holes=np.array([4], np.int32)))
    assert [len(rows(holed)), holed.holes.tolist()] == [3, [2]]
