# mypy: allow-untyped-defs, allow-untyped-calls
"""The area vector of a triangle, for kernels of several rooms."""

from foveal.base.jit import lean


@lean
def area_vector(positions, faces, f):
    """(x, y, z): along the normal of face f, twice its area long."""
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    ux, uy, uz = (
        positions[b, 0] - positions[a, 0],
        positions[b, 1] - positions[a, 1],
        positions[b, 2] - positions[a, 2],
    )
    vx, vy, vz = (
        positions[c, 0] - positions[a, 0],
        positions[c, 1] - positions[a, 1],
        positions[c, 2] - positions[a, 2],
    )
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
