"""The scenes of ./do bench shadows, each with a light."""

import gzip
import json
from functools import cache
from pathlib import Path

import numpy as np
from _shadows_plaza import LIGHT, plaza
from _shape import SHARED_DATA

from foveal.mesh import TriMesh, read_mesh
from foveal.shadows import Directional

__all__ = ["SCENES", "Scene", "scene"]

Scene = tuple[list[TriMesh], Directional]
SCENES = ("plaza", "samurai", "delft")
_FILES = {"samurai": "samurai_monastry.obj.gz", "delft": "delft.city.json.gz"}
_LIGHTS = {"plaza": LIGHT, "small plaza": LIGHT, "samurai": (0.45, -0.76, 0.35), "delft": (0.55, 0.35, -0.76)}
"""The ways of the light: slanting; y is up in the monastery, z in the others."""


@cache
def scene(name: str) -> Scene | None:
    """Meshes and light; None where its file is not there. The small plaza has 150,000 triangles."""
    light = Directional(_LIGHTS[name])
    if name.endswith("plaza"):
        return plaza(detail=60 if name.startswith("small") else 190), light
    path = SHARED_DATA / "scenes" / _FILES[name]
    if not path.is_file():
        return None
    return [city(path) if name == "delft" else read_mesh(path)], light


def city(path: Path) -> TriMesh:
    """All surfaces of a CityJSON whose polygons are triangles, as those of Delft are."""
    data = json.loads(gzip.decompress(path.read_bytes()))
    corners: list[list[int]] = []
    for thing in data["CityObjects"].values():
        for geometry in thing.get("geometry", []):
            shells = geometry["boundaries"] if geometry["type"] == "Solid" else [geometry["boundaries"]]
            for rings in (surface for shell in shells for surface in shell):
                if len(rings) != 1 or len(rings[0]) != 3:
                    raise ValueError("a polygon that is no triangle")
                corners.append(rings[0])
    transform = data["transform"]
    positions = np.array(data["vertices"]) * transform["scale"] + transform["translate"]
    return TriMesh.of(positions, corners)
