"""Small patches by property, for the codec's tests and its golden files."""

import numpy as np

from foveal.multires.codec import Patch, predicted_normals, quantise_normals


def patch(positions, faces, normals=None, colours=None):
    return Patch(
        np.array(positions, np.int32).reshape(-1, 3),
        np.array(faces, np.int32).reshape(-1, 3),
        None if normals is None else np.array(normals, np.int16).reshape(-1, 2),
        None if colours is None else np.array(colours, np.uint8).reshape(-1, 3),
    )


def grid(width, height, *, around=False, along=False, flip=False):
    """Faces of a grid of quads, closed to a tube by `around`, to a torus by both."""
    columns, rows = width + (not around), height + (not along)
    v = lambda i, j: (j % rows) * columns + i % columns  # noqa: E731
    faces = []
    for j in range(height):
        for i in range(width):
            a, b, c, d = v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)
            faces += [(a, b, c), (a, c, d)] if (i + j) % 2 or not flip else [(a, b, d), (b, c, d)]
    return np.array(faces)


def torus(width=24, height=12, radius=900, seed=1):
    u, v = np.meshgrid(np.arange(width) / width, np.arange(height) / height)
    u, v = 2 * np.pi * u.ravel(), 2 * np.pi * v.ravel()
    ring = radius + 0.4 * radius * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), 0.4 * radius * np.sin(v)], 1)
    points += np.random.default_rng(seed).normal(0, 4, points.shape)
    return np.rint(points), grid(width, height, around=True, along=True, flip=True)


def sheet(width=20, height=16, seed=2):
    rng = np.random.default_rng(seed)
    i, j = np.meshgrid(np.arange(width + 1), np.arange(height + 1))
    points = np.stack([i.ravel() * 20, j.ravel() * 20, 30 * np.sin(i * 0.4 + j * 0.3).ravel()], 1)
    return np.rint(points + rng.normal(0, 3, points.shape)), grid(width, height, flip=True)


def unique_colours(n):
    i = np.arange(n)
    return np.stack([i & 255, (i * 37 + (i >> 8)) & 255, i >> 8], 1)


def octahedron():
    p = np.array([[9, 0, 0], [-9, 0, 0], [0, 9, 0], [0, -9, 0], [0, 0, 9], [0, 0, -9]])
    f = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return p, np.array(f)


def meshes():
    """Name to patch. Every vertex of a mesh with colours has a colour of its own."""
    rng = np.random.default_rng(7)
    tetrahedron = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    points, faces = torus()
    sheet_points, sheet_faces = sheet()
    holes = np.delete(sheet_faces, [100, 101, 102, 103, 300, 301, 400], axis=0)
    ball, ball_faces = octahedron()
    fan = [[0, 1, 2], [0, 1, 3], [1, 0, 4], [1, 0, 5], [0, 1, 6]]
    soup = rng.integers(0, 40, (120, 3))
    result = {
        "nothing": patch([], []),
        "triangle": patch([[5, -3, 1 << 29], [-(1 << 30), 0, 7], [3, (1 << 30) - 1, 2]], [[2, 0, 1]]),
        "tetrahedron": patch(*tetrahedron),
        "torus": patch(points, faces),
        "open": patch(sheet_points, sheet_faces),
        "holes": patch(sheet_points, holes, colours=unique_colours(len(sheet_points))),
        "inside_out": patch(ball, ball_faces[:, ::-1]),
        "non_manifold": patch(
            np.concatenate([ball, ball + np.array([0, 18, 0]), ball + np.array([18, 0, 0])]),
            # Octahedra that touch in a vertex and along an edge (0-4 is 0-4 of the third as well).
            np.where(
                np.concatenate([ball_faces, ball_faces + 6, ball_faces + 12]) == 9,
                2,
                np.concatenate([ball_faces, ball_faces + 6, ball_faces + 12]),
            ),
            colours=unique_colours(18),
        ),
        "fan_of_sheets": patch(rng.integers(-50, 50, (7, 3)), fan, colours=unique_colours(7)),
        "moebius": patch(
            rng.integers(-50, 50, (10, 3)),
            [[i, (i + 1) % 10, (i + 2) % 10][:: 1 if i % 2 else -1] for i in range(10)],
            colours=unique_colours(10),
        ),
        "soup": patch(rng.integers(-99, 99, (40, 3)), soup, colours=unique_colours(40)),
        "twice": patch(
            *[tetrahedron[0], [*tetrahedron[1], *tetrahedron[1], [3, 2, 1]]], colours=unique_colours(4)
        ),
        "degenerate": patch(
            [[0, 0, 0], [9, 0, 0], [0, 9, 0], [1, 1, 1]],
            [[0, 0, 0], [0, 1, 1], [0, 1, 2], [2, 1, 2], [3, 0, 3]],
            colours=unique_colours(4),
        ),
        "same_place": patch(np.zeros((66, 3)), grid(5, 10), colours=unique_colours(66)),
        "unused": patch(rng.integers(-9, 9, (9, 3)), [[1, 4, 7]], colours=unique_colours(9)),
        "coarse": patch(np.rint(sheet_points / 8) * 8 + (np.arange(357)[:, None] % 9 == 0), sheet_faces),
        "normals": patch(
            points, faces, quantise_normals(points * [1, 1, 3] + rng.normal(0, 9, points.shape))
        ),
        "no_normals": patch(points, faces, np.full((len(points), 2), -512)),
        "all": patch(
            sheet_points,
            sheet_faces,
            quantise_normals(rng.normal((0, 0, 4), 1, (len(sheet_points), 3))),
            rng.integers(0, 256, (len(sheet_points), 3)),
        ),
    }
    both = result["torus"]
    result["expected_normals"] = patch(
        both.positions, both.faces, predicted_normals(both.positions, both.faces, bits=10)
    )
    return result
