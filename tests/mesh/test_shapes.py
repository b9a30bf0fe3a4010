"""Generated meshes: counts, closedness, orientation; the streamed torus is one closed surface."""

import numpy as np
import pytest

from foveal.mesh.io.blocks import FaceBlock, VertexBlock
from foveal.mesh.io.source import mesh_of
from foveal.mesh.shapes import (
    bumpy_sphere,
    grid_patch,
    icosphere,
    stream_terrain,
    terrain,
    tetrahedron,
    torus,
)
from foveal.mesh.topology import inspect


def volume(mesh):
    a, b, c = (mesh.positions[mesh.faces[:, i]] for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


@pytest.mark.parametrize(
    ("mesh", "triangles", "vertices"),
    [(tetrahedron(), 4, 4), (icosphere(3), 1280, 642), (bumpy_sphere(2), 320, 162), (torus(5, 4), 40, 20)],
)
def test_closed_shapes_face_outwards(mesh, triangles, vertices):
    assert (len(mesh.faces), len(mesh.positions)) == (triangles, vertices)
    counts = inspect(mesh)
    assert counts.is_closed
    assert (counts.nonmanifold_edges, counts.unused_vertices, counts.components) == (0, 0, 1)
    assert volume(mesh) > 0


def test_an_icosphere_is_round():
    np.testing.assert_allclose(np.linalg.norm(icosphere(3, radius=2).positions, axis=1), 2, rtol=1e-12)


@pytest.mark.parametrize("mesh", [grid_patch(5, 3), terrain(16)])
def test_open_shapes_are_seen_from_above(mesh):
    counts = inspect(mesh)
    assert not counts.is_closed
    assert counts.nonmanifold_edges == 0
    a, b, c = (mesh.positions[mesh.faces[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


@pytest.mark.parametrize("triangles", [1, 300, 20_000, 300_000])
def test_the_streamed_torus_is_closed_and_as_large_as_asked(triangles):
    source = stream_terrain(triangles, has_colours=True)
    mesh = mesh_of(source)
    assert source.bytes_read == source.size_hint
    assert abs(len(mesh.faces) - triangles) <= max(18, 0.01 * triangles)
    counts = inspect(mesh)
    assert counts.is_closed
    assert (counts.nonmanifold_edges, counts.unused_vertices, counts.components) == (0, 0, 1)
    assert volume(mesh) > 0
    assert mesh.colours is not None


def test_its_blocks_are_bounded_and_repeat():
    source = stream_terrain(1_000_000)
    for block, again in zip(source.blocks(), source.blocks(), strict=True):
        if isinstance(block, VertexBlock):
            assert len(block.positions) <= 1 << 17
            np.testing.assert_array_equal(block.positions, again.positions)
        else:
            assert isinstance(block, FaceBlock)
            assert len(block.faces) <= 1 << 18
