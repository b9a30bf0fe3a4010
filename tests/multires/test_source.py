"""A `.fov` built again from itself is the same surface."""

import numpy as np
import pytest

from corpus import MESHES
from foveal import multires
from foveal.mesh.io.source import mesh_of
from foveal.mesh.topology import inspect, weld


@pytest.mark.parametrize("name", ["bumpy_sphere", "terrain", "coloured", "with_all_attributes", "utm"])
def test_the_finest_level_comes_back_and_builds_again(name, tmp_path):
    first, second = tmp_path / "first.fov", tmp_path / "second.fov"
    report = multires.build(MESHES[name](), first, bits=12)
    source = multires.source_of(first)
    mesh = mesh_of(source)
    assert len(mesh.faces) == report.repairs.triangles
    assert (mesh.normals is not None, mesh.colours is not None) == (source.has_normals, source.has_colours)
    again = multires.build(multires.source_of(first), second, step=report.step)
    assert again.repairs.triangles == report.repairs.triangles
    with multires.open(first) as a, multires.open(second) as b:
        meshes = [multires.extract(asset) for asset in (a, b)]
    assert inspect(weld(meshes[0])[0]).boundary_edges == inspect(weld(meshes[1])[0]).boundary_edges
    lows = [m.positions.min(axis=0) for m in meshes]
    np.testing.assert_allclose(*lows, atol=report.step)
