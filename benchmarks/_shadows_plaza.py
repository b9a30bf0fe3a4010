"""The plaza: a closed scene of about 1.5 million triangles, from a seed.

Seven kinds of closed, detailed solids, 42 copies at random places, heights and turns, some through each
other, on a closed slab.
"""

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh

__all__ = ["LIGHT", "plaza"]

LIGHT = (0.55, 0.35, -0.76)
"""The way of the light: slanting, z being up."""
COPIES = 42
Array = NDArray[np.float64]


def plaza(*, copies: int = COPIES, detail: int = 190, seed: int = 2016) -> list[TriMesh]:
    """The slab and the copies; a solid has about `detail`² triangles."""
    rng = np.random.default_rng(seed)
    models = [make(detail) for make in (_knot, _bumpy, _fluted, _spring, _star, _twisted, _ripples)]
    meshes = [_slab()]
    for copy in range(copies):
        mesh = models[copy % len(models)]
        turn = _turn(rng)
        size = rng.uniform(0.35, 0.9)
        points = mesh.positions @ turn.T * size
        place = [
            *rng.uniform(-9, 9, 2),
            -points[:, 2].min() + rng.choice([0.0, 0.0, rng.uniform(0, 2.5)]) - 0.02,
        ]
        meshes.append(TriMesh(points + place, mesh.faces))
    return meshes


def _turn(rng: np.random.Generator) -> Array:
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _slab() -> TriMesh:
    corners = np.array([[x, y, z] for z in (-0.4, 0.0) for y in (-11, 11) for x in (-11, 11)], float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return TriMesh.of(corners, [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])


def _closed(points: Array, is_ball: bool) -> TriMesh:
    """A grid (rows, columns, 3), closed along its columns, and along its rows or with a pole at each end."""
    rows, columns = points.shape[:2]
    i, j = np.meshgrid(np.arange(rows - is_ball), np.arange(columns), indexing="ij")
    down, right = (i + 1) % rows, (j + 1) % columns
    a, b, c, d = i * columns + j, i * columns + right, down * columns + right, down * columns + j
    faces = np.concatenate([np.stack([a, d, c], -1).reshape(-1, 3), np.stack([a, c, b], -1).reshape(-1, 3)])
    points = points.reshape(-1, 3)
    if is_ball:
        points = np.concatenate([points, points[:columns].mean(0)[None], points[-columns:].mean(0)[None]])
        first = np.arange(columns)
        after = (first + 1) % columns
        north, south = np.full(columns, len(points) - 2), np.full(columns, len(points) - 1)
        base = (rows - 1) * columns
        faces = np.concatenate(
            [faces, np.stack([north, first, after], -1), np.stack([south, base + after, base + first], -1)]
        )
    mesh = TriMesh.of(points, faces)
    a, b, c = (mesh.positions[mesh.faces[:, k]] for k in range(3))
    if (np.cross(a, b) * c).sum() < 0:  # inside out
        mesh = TriMesh.of(points, mesh.faces[:, ::-1].copy())
    return mesh


def _angles(detail: int, ratio: float = 1.0) -> tuple[Array, Array]:
    rows, columns = int(detail * 0.7071 * ratio), int(detail * 0.7071 / ratio)
    u = np.arange(rows) / rows * 2 * np.pi
    v = np.arange(columns) / columns * 2 * np.pi
    return u[:, None], v[None]


def _ball(radius: Array, detail: int) -> TriMesh:
    rows = radius.shape[0]
    theta = ((np.arange(rows) + 0.5) / rows * np.pi)[:, None]
    phi = (np.arange(radius.shape[1]) / radius.shape[1] * 2 * np.pi)[None]
    points = np.stack(
        np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1
    )
    return _closed(points * radius[..., None], True)


def _tube(centre: Array, radius: Array, v: Array) -> TriMesh:
    """Around a closed curve (rows, 3)."""
    along = np.roll(centre, -1, 0) - np.roll(centre, 1, 0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    side = np.cross(along, [0.31, 0.17, 0.93])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    other = np.cross(along, side)
    ring = np.cos(v)[..., None] * side[:, None] + np.sin(v)[..., None] * other[:, None]
    return _closed(centre[:, None] + radius[..., None] * ring, False)


def _knot(detail: int) -> TriMesh:
    u, v = _angles(detail, 2.5)
    t = u[:, 0]
    centre = np.stack(
        [(2 + np.cos(3 * t)) * np.cos(2 * t), (2 + np.cos(3 * t)) * np.sin(2 * t), np.sin(3 * t)], -1
    )
    return _tube(centre * 0.5, 0.16 + 0.02 * np.sin(40 * u + 3 * v), v)


def _spring(detail: int) -> TriMesh:
    u, v = _angles(detail, 2.5)
    t = u[:, 0]
    radius = 1 + 0.35 * np.cos(14 * t)
    centre = np.stack([radius * np.cos(t), radius * np.sin(t), 0.35 * np.sin(14 * t)], -1)
    return _tube(centre, np.broadcast_to(0.07 + 0 * u, (len(t), v.shape[1])), v)


def _grid(detail: int) -> tuple[Array, Array]:
    u, v = _angles(detail)
    return (np.arange(u.shape[0]) + 0.5)[:, None] / u.shape[0] * np.pi, v


def _bumpy(detail: int) -> TriMesh:
    theta, phi = _grid(detail)
    return _ball(
        1 + 0.06 * np.sin(9 * theta) * np.cos(11 * phi) + 0.02 * np.cos(31 * theta + 17 * phi), detail
    )


def _fluted(detail: int) -> TriMesh:
    theta, phi = _grid(detail)
    profile = 0.45 / np.maximum(np.abs(np.sin(theta)), 0.22)
    return _ball(np.minimum(profile, 1.7) * (1 + 0.05 * np.abs(np.cos(10 * phi))), detail)


def _star(detail: int) -> TriMesh:
    theta, phi = _grid(detail)
    return _ball(0.75 + 0.45 * np.abs(np.cos(2.5 * phi)) ** 3 * np.sin(theta) ** 2, detail)


def _twisted(detail: int) -> TriMesh:
    u, v = _angles(detail)
    turn = 4 * u
    profile = 0.42 / (np.abs(np.cos(v)) ** 6 + np.abs(np.sin(v)) ** 6) ** (1 / 6)
    x, z = profile * np.cos(v + turn / 4), profile * np.sin(v + turn / 4)
    return _closed(np.stack([(1.1 + x) * np.cos(u), (1.1 + x) * np.sin(u), z + 0 * u], -1), False)


def _ripples(detail: int) -> TriMesh:
    theta, phi = _grid(detail)
    return _ball(0.9 + 0.05 * np.sin(24 * theta) + 0.25 * np.cos(theta) ** 2 * np.cos(4 * phi) ** 2, detail)
