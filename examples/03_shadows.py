"""Precomputed shadows: a hall in the sun, a ball that moves through it, and the edges of a wide light.

python examples/03_shadows.py [FOLDER [MESH]]
"""

import sys
from pathlib import Path

import numpy as np

import foveal
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.shadows import AreaLight, Directional, ShadowMap, build


def box(low, high):
    """A closed box between two corners."""
    corners = np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)], float)
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    faces = [triangle for a, b, c, d in quads for triangle in ([a, b, c], [a, c, d])]
    # Each quadrangle has corners of its own, so that the box is not shaded round.
    faces = np.array(faces)
    return foveal.TriMesh.of(corners[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3))


def together(meshes):
    """Many meshes as one."""
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    return foveal.TriMesh.of(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]),
    )


def placed(mesh, at, size):
    """A mesh at another place, in another size."""
    return foveal.TriMesh.of(mesh.positions * size + np.array(at, float), mesh.faces)


folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
middle = foveal.read(sys.argv[2]) if len(sys.argv) > 2 else bumpy_sphere(5)
middle = placed(middle, (0, 0, 0), 1.2 / np.ptp(middle.positions, axis=0).max())
columns = [
    box((x - 0.12, 0, z - 0.12), (x + 0.12, 2, z + 0.12)) for x in (-3, -1.5, 1.5, 3) for z in (-1.5, 1.5)
]
beams = [box((-3.3, 2, z - 0.15), (3.3, 2.2, z + 0.15)) for z in (-1.5, 1.5)]
hall = together([box((-4, -0.2, -3), (4, 0, 3)), *columns, *beams, placed(middle, (0, 0.9, 0), 1)])

sun = Directional((0.45, -0.8, -0.4))
shadow = build(hall, sun, resolution=16384)
size = sum(packed.words.nbytes for packed in shadow.packed)
print(f"{shadow.resolution:,} pixels a side, {4 * shadow.resolution**2 / size:,.0f} times smaller than all")

camera = foveal.Camera.of((5.5, 4.2, 7.5), (0, 0.6, 0), width=720, height=480)
foveal.render(hall, folder / "hall.png", camera=camera, shadow=shadow, shadow_filter="pcf5")

# A ball that flies through casts by an ordinary shadow map beside the precomputed one.
ball = placed(icosphere(4), (0.9, 1.5, 0.6), 0.35)
with_ball = together([hall, ball])
print(f"{len(with_ball.faces):,} triangles in the picture of the hall with a ball")
moved: ShadowMap = shadow.with_moving(ball)
foveal.render(with_ball, folder / "ball.png", camera=camera, shadow=moved)

# The same sun as a disc 20 times as wide, of 64 images in one octree: soft shadows.
disc = AreaLight(sun, radius=np.radians(5), samples=64)
soft = build(hall, disc, resolution=1024)
foveal.render(hall, folder / "soft.png", camera=camera, shadow=soft)
