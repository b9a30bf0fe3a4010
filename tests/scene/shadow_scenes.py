"""A ball over a slab, and shadow files of it: small, and quickly made."""

import numpy as np

from foveal import TriMesh
from foveal.mesh.shapes import icosphere

SLAB_FACES = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4]]
SLAB_FACES += [[1, 3, 5], [3, 7, 5], [3, 2, 7], [2, 6, 7], [2, 0, 6], [0, 4, 6]]


def ball_over_slab(level=3):
    """A ball of radius 0.5 around (0, 0, 1), over a slab whose top is z = 0."""
    ball = icosphere(level)
    slab = np.array([[x, y, z] for z in (-0.2, 0) for y in (-2, 2) for x in (-2, 2)])
    positions = np.concatenate([0.5 * ball.positions + [0, 0, 1], slab])
    return TriMesh.of(positions, np.concatenate([ball.faces, np.add(SLAB_FACES, len(ball.positions))]))
