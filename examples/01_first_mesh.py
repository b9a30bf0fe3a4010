"""The shortest whole program: a mesh made of arrays becomes a .fov, a coarser mesh and two pictures.

python examples/01_first_mesh.py [FOLDER]
"""

import sys
from pathlib import Path

import numpy as np

import foveal

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# A torus with waves on it: positions (n, 3) and triangles (m, 3) as plain arrays.
rings, sides = 600, 200
around, across = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
u, v = 2 * np.pi * around / rings, 2 * np.pi * across / sides
tube = 0.4 + 0.02 * np.sin(25 * u) * np.sin(9 * v)
positions = np.stack(
    [(1 + tube * np.cos(v)) * np.cos(u), tube * np.sin(v), (1 + tube * np.cos(v)) * np.sin(u)], -1
)
here = around * sides + across
right, up = np.roll(here, -1, axis=0), np.roll(here, -1, axis=1)
diagonal = np.roll(right, -1, axis=1)
faces = np.concatenate([np.stack([here, up, diagonal], -1), np.stack([here, diagonal, right], -1)]).reshape(
    -1, 3
)

# Build: patches at all resolutions in one file, each with a bound of its error.
fov = folder / "torus.fov"
foveal.build(positions.reshape(-1, 3), faces, fov)
facts = foveal.info(fov)
print(f"{facts['triangles']:,} triangles in {fov.stat().st_size:,} bytes")

# A mesh that is nowhere further than 0.005 from the original.
light = foveal.export(fov, folder / "torus_light.glb", error=0.005)
print(f"{len(light.faces):,} of them stay within 0.005 of all the others")

# Pictures: the whole, and that light mesh.
camera = foveal.Camera.of([0, 2.2, 2.6], [0, 0, 0], width=960, height=540)
foveal.render(fov, folder / "torus.png", camera=camera)
foveal.render(light, folder / "torus_light.png", camera=camera)
