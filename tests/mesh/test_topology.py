"""Counts worked by hand and against a plain twin; welding merges exact equals and keeps triangles."""

import numpy as np
import pytest

import corpus
import naive
from foveal.mesh import topology
from foveal.mesh.shapes import icosphere, torus
from foveal.mesh.topology import inspect, weld
from foveal.mesh.trimesh import TriMesh


@pytest.mark.parametrize("name", corpus.MESHES)
def test_counts_agree_with_the_plain_twin(name):
    mesh = corpus.MESHES[name]()
    counts = inspect(mesh)
    uses = list(naive.edge_uses(mesh.faces).values())
    assert counts.boundary_edges == uses.count(1)
    assert counts.nonmanifold_edges == sum(u > 2 for u in uses)
    assert counts.components == naive.component_count(mesh.faces)
    assert counts.unused_vertices == len(mesh.positions) - len(np.unique(mesh.faces))
    assert counts.coincident_vertices == len(mesh.positions) - len(set(naive.weld(mesh.positions)))
    distinct = {tuple(sorted(f)) for f in mesh.faces.tolist()}
    assert counts.duplicate_triangles == len(mesh.faces) - len(distinct)
    assert counts.is_closed == (counts.boundary_edges == 0)


@pytest.mark.parametrize("name", corpus.MESHES)
def test_the_corpus_has_the_properties_it_names(name):
    counts = inspect(corpus.MESHES[name]())
    assert counts.is_closed == (name in corpus.CLOSED)
    if name in corpus.MANIFOLD:
        assert counts.nonmanifold_edges == 0


@pytest.mark.parametrize(("mesh", "euler"), [(icosphere(2), 2), (torus(9, 7), 0)])
def test_euler_characteristic_of_closed_surfaces(mesh, euler):
    edges = len(naive.edge_uses(mesh.faces))
    assert len(mesh.positions) - edges + len(mesh.faces) == euler


def test_degenerate_triangles_by_hand():
    counts = inspect(corpus.degenerate_and_duplicate())
    assert counts.degenerate_triangles == 3  # one vertex, two vertices, three on a line
    assert counts.duplicate_triangles == 3


def test_many_vertices_take_another_way_to_find_duplicates(monkeypatch):
    mesh = corpus.tangled()
    expected = topology._distinct_rows(np.sort(mesh.faces, axis=1).astype(np.int64), 60)
    rows = np.sort(mesh.faces, axis=1).astype(np.int64) + (1 << 22)
    assert topology._distinct_rows(rows, 1 << 23) == expected


@pytest.mark.parametrize("name", corpus.MESHES)
def test_welding_keeps_every_triangle_where_it_was(name):
    mesh = corpus.MESHES[name]()
    welded, place = weld(mesh)
    np.testing.assert_array_equal(place, naive.weld(mesh.positions))
    np.testing.assert_array_equal(welded.faces, place[mesh.faces])
    np.testing.assert_array_equal(welded.positions[place], mesh.positions)
    assert inspect(welded).coincident_vertices == 0
    assert weld(welded)[0] is welded


def test_zero_and_minus_zero_are_one_place():
    mesh = corpus.coincident_vertices()
    assert weld(mesh)[1].tolist() == [0, 1, 2, 3, 1, 4, 5, 2]
    assert inspect(weld(mesh)[0]).boundary_edges == 6


def test_welding_closes_a_sphere_of_loose_triangles():
    assert inspect(weld(corpus.unwelded_sphere())[0]).is_closed


def test_merged_attributes_are_means():
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [0, 0, 0]]
    normals = [[1, 0, 0], [0, 0, 1], [0, 0, 1], [0, 1, 0], [0, 0, 0]]
    colours = [[0, 0, 0], [9, 9, 9], [8, 8, 8], [10, 100, 200], [20, 100, 101]]
    mesh = TriMesh.of(points, [[0, 1, 2], [3, 1, 2], [4, 2, 1]], normals=normals, colours=colours)
    welded, _ = weld(mesh)
    np.testing.assert_allclose(welded.normals[0], [0.5**0.5, 0.5**0.5, 0], atol=1e-7)
    assert welded.colours.tolist() == [[10, 67, 100], [9, 9, 9], [8, 8, 8]]
