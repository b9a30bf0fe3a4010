# mypy: allow-untyped-defs, allow-untyped-calls
"""Where the samples of a picture are in the world, and how its surfaces lie there."""

from foveal.base.jit import kernel

from ._kernels_shade import face_normal, weights_of

_EDGE_ON = 1e-4  # of a sample's ray to its face, the least cosine: steps along the face stay finite


@kernel
def _to_world(x, y, depth, basis, out):
    for k in range(3):
        out[k] = x * basis[0, k] + y * basis[1, k] - depth * basis[2, k]


@kernel
def surface(face_ids, first_row, faces, seen, lens, eye, basis, lift_px, points, normals, spans):
    """Of each sample with a face, in order: its place, its triangle's normal, and steps to its neighbours.

    The normal is unit and on the eye's side; the place is `lift_px` samples' width along it. Weights are
    computed again in double: in single a large triangle's places are off its plane by more than shadows bear.
    """
    pixels_per_radian, width, height, _ = lens
    count = 0
    for row in range(len(face_ids)):
        y = (0.5 * height - (first_row + row + 0.5)) / pixels_per_radian
        for column in range(width):
            face = face_ids[row, column]
            if face < 0:
                continue
            x = (column + 0.5 - 0.5 * width) / pixels_per_radian
            a, b, c = seen[faces[face, 0]], seen[faces[face, 1]], seen[faces[face, 2]]
            u, v, w = weights_of(x, y, a, b, c)
            nx, ny, nz = face_normal(a, b, c)
            along = x * nx + y * ny - nz  # of the ray, which looks along -z
            if along > 0.0:
                nx, ny, nz, along = -nx, -ny, -nz, -along
            along = min(along, -_EDGE_ON)
            depth = u * a[2] + v * b[2] + w * c[2]
            lift = lift_px * depth / pixels_per_radian
            _to_world(nx, ny, -nz, basis, normals[count])
            _to_world(
                u * a[0] + v * b[0] + w * c[0], u * a[1] + v * b[1] + w * c[1], depth, basis, points[count]
            )
            for k in range(3):
                points[count, k] += eye[k] + lift * normals[count, k]
            # One sample to the right the ray (x, y, 1) t is longer by what brings it back to the plane.
            step = depth / pixels_per_radian
            _to_world(
                step - step * x * nx / along,
                -step * y * nx / along,
                -step * nx / along,
                basis,
                spans[count, 0],
            )
            _to_world(
                -step * x * ny / along,
                step - step * y * ny / along,
                -step * ny / along,
                basis,
                spans[count, 1],
            )
            count += 1
