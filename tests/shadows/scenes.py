"""Small scenes that cast, by what is odd about them."""

import numpy as np

from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh


def box(low, high):
    """A closed box."""
    x, y, z = np.transpose([low, high]).astype(float)
    corners = [[x[i], y[j], z[k]] for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return TriMesh.of(corners, [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])


def sheet(low, high, z, is_turned=False):
    """A rectangle of two triangles, seen from above or, turned, from below."""
    (x0, y0), (x1, y1) = low, high
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    return TriMesh.of(
        [[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]], faces[:, ::-1] if is_turned else faces
    )


def ball(place, radius=1.0, level=2):
    mesh = icosphere(level)
    return TriMesh(mesh.positions * radius + np.asarray(place, float), mesh.faces)


def solids():
    """Closed parts on a slab, some through each other, one right on it."""
    return [
        box((-4, -4, -0.5), (4, 4, 0)),
        ball((0, 0, 1.2)),
        ball((0.8, 0.3, 1.9), 0.7),
        box((-3, -3, 0), (-1, -2, 1.5)),
        box((1, 1, 2), (3, 3, 2.1)),
    ]


def mixed():
    """Solids below roofs of one sheet, a sheet twice in one place, one turned over, one through a solid."""
    return [
        *solids(),
        sheet((-3.5, -3.5), (0.5, 0.5), 3.0),
        sheet((-1.0, 0.0), (2.0, 3.5), 3.5, is_turned=True),
        sheet((2, -3), (3.5, -1), 1.0),
        sheet((2, -3), (3.5, -1), 1.0, is_turned=True),
        sheet((-3.8, 1), (-2, 3), 0.5),
        sheet((-2.5, -3.5), (-1.5, -1.5), 0.7),
    ]
