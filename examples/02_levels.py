"""One surface at three errors, side by side and drawn flat, so that one sees where triangles are spent.

python examples/02_levels.py [FOLDER [MESH]]
"""

import sys
from pathlib import Path

import numpy as np

import foveal
from foveal.mesh.shapes import bumpy_sphere
from foveal.raster import gradient, picture, write_png

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
mesh = foveal.read(sys.argv[2]) if len(sys.argv) > 2 else bumpy_sphere(6)

fov = folder / "levels.fov"
foveal.build(mesh, fov)
low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
camera = foveal.Camera.around(low, high, direction=(-0.5, 0.25, 1.0), width=480, height=480)

panels = []
for share in (0.03, 0.005, 0.0):
    error = share * float((high - low).max())
    light = foveal.export(fov, error=error) if error else foveal.export(fov)
    print(f"error at most {error:.2g}: {len(light.faces):,} triangles in the picture")
    panels.append(picture(light, camera, background=gradient(camera), is_flat=True))
write_png(np.concatenate(panels, axis=1), folder / "levels.png")
