"""A yard in the light of the scene, for tests of shadows in the page."""

import json
import math

import numpy as np

from e2e.page import build
from foveal.mesh.poly_shapes import cube
from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh
from foveal.scene.source import triangles_of
from foveal.shadows import AreaLight, Directional, Point, Spot, SunPath
from foveal.shadows import build as build_shadow

TALL = [([0, -0.2, 0], [3, 0.2, 3]), ([-1, 0.6, 0.4], [0.3, 0.7, 0.3]), ([0.8, 0.3, -0.6], [0.5, 0.4, 0.2])]
"""Middles and half sides of boxes: the ground and what stands in it."""
PATH = SunPath("2026-06-21T09:00+02:00", "2026-06-21T18:00+02:00", 7, 43.72, 10.4, up="y")
LIGHTS = {
    "sun": Directional((0.5, -0.7, 0.35)),
    "spot": Spot((2.5, 4, 2), (0, 0, 0), math.radians(45)),
    "point": Point((0.2, 1.4, 0.6)),
    "area": AreaLight(Spot((2.5, 4, 2), (0, 0, 0), math.radians(80)), radius=0.5, samples=16),
    "path": PATH,
}
RESOLUTIONS = {"sun": 2048, "spot": 1024, "point": 1024, "area": 256, "path": 256}
VIEW = {"position": [4, 4, 6], "target": [0, 0.2, 0], "up": [0, 1, 0], "fieldOfViewDegrees": 38}


def yard():
    """Closed: boxes and a ball on and in the ground."""
    block = triangles_of(cube())
    parts = [TriMesh.of(block.positions * half + np.array(at), block.faces) for at, half in TALL]
    ball = icosphere(4)
    parts.append(TriMesh.of(ball.positions * 0.45 + np.array([0.3, 0.6, 1.1]), ball.faces))
    starts = np.cumsum([0] + [len(part.positions) for part in parts])
    faces = [part.faces + start for part, start in zip(parts, starts, strict=False)]
    return TriMesh.of(np.concatenate([part.positions for part in parts]), np.concatenate(faces))


def lit_scene(*layers, light=None):
    """A scene.json; the light is that of data/light.fov, with what is said beside it."""
    data = {
        "version": 1,
        "title": "A yard",
        "layers": [{"name": n, "asset": f"data/{n}.fov"} for n in layers],
    }
    if light is not None:
        data["light"] = {"asset": "data/light.fov", **light}
    return json.dumps({**data, "background": "#000000"}).encode()


def yard_files(folder):
    """The yard's patches, and a shadow map for each of LIGHTS."""
    mesh = yard()
    files = {"yard": build(mesh, folder / "yard.fov")}
    for name, light in LIGHTS.items():
        files[name] = folder / f"{name}.fov"
        build_shadow(mesh, light, resolution=RESOLUTIONS[name]).save(files[name])
    return files
