"""Reading: the whole corpus through build, check and extract; single patches; wrong masks."""

import functools
import tempfile
from pathlib import Path

import numpy as np
import pytest

from corpus import CLOSED, MESHES
from foveal import multires
from foveal.base.errors import FovealError
from foveal.mesh.distance import sampled_hausdorff
from foveal.mesh.shapes import torus
from foveal.multires.check import boundary_edges


@functools.cache
def built(name):
    """One build a mesh: its bytes and the report."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "it.fov"
        report = multires.build(MESHES[name](), path, bits=16, cell_triangles=256)
        multires.check(path)
        return path.read_bytes(), report


@pytest.fixture(scope="module")
def asset(tmp_path_factory):
    path = tmp_path_factory.mktemp("read") / "torus.fov"
    multires.build(torus(40, 30), path, cell_triangles=256)
    with multires.open(path) as found:
        yield found


@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_is_built_checked_and_comes_back(name):
    mesh = MESHES[name]()
    data, report = built(name)
    with multires.open(data) as asset:
        full, root = multires.extract(asset), multires.extract(asset, error=np.inf)
    assert report.repairs.triangles == len(full.faces) == len(mesh.faces)
    ours = np.sort(full.positions[full.faces].mean(axis=1), axis=0)
    given = np.sort(mesh.positions[mesh.faces].mean(axis=1), axis=0)
    np.testing.assert_allclose(ours, given, rtol=0, atol=asset.header["finest_error"])
    assert (full.normals is not None, full.colours is not None) == (True, mesh.colours is not None)
    if name in CLOSED:
        assert boundary_edges(full.faces) == boundary_edges(root.faces) == 0


@pytest.mark.parametrize("name", ["bumpy_sphere", "terrain", "soup"])
def test_extracting_at_an_error_keeps_it(name):
    mesh = MESHES[name]()
    with multires.open(built(name)[0]) as asset:
        wanted = float(np.median(asset.graph.errors[1:]))
        found = multires.extract(asset, error=wanted)
        assert len(found.faces) < len(mesh.faces)
        assert max(sampled_hausdorff(found, mesh, samples=5000)) <= wanted


def test_a_single_patch_is_the_one_of_its_node(asset):
    number = 0
    for node in range(len(asset.graph.errors)):
        for patch in asset.node_patches(node):
            single = asset.patch(number)
            np.testing.assert_array_equal(single.positions, patch.positions)
            np.testing.assert_array_equal(single.faces, patch.faces)
            np.testing.assert_array_equal(single.normals, patch.normals)
            number += 1
    assert number == len(asset.graph.finer)


@pytest.mark.parametrize("mask", [np.ones(3, bool), [1, 0], np.ones(1000, int)])
def test_a_mask_of_another_shape_or_type_is_refused(asset, mask):
    with pytest.raises(ValueError, match="expanded must be bool"):
        asset.mesh_of(mask)


def test_a_cut_without_the_root_is_refused(asset):
    with pytest.raises(FovealError, match="expand node 0"):
        asset.mesh_of(np.zeros(len(asset.graph.errors), bool))


def test_what_is_no_multires_file_is_refused(tmp_path):
    path = tmp_path / "text.fov"
    path.write_bytes(b"solid nothing\n" * 10)
    with pytest.raises(FovealError, match=r"text\.fov"):
        multires.open(path)
