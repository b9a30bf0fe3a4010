"""Writes `cage.fov`, `cage.json`, and the same of `cage_sharp`, `_polygons`, `_placed`, `_holed`.

They lie in `spec/golden`; both pytest and vitest read them.

PYTHONPATH=tests python -m scene.golden_cage
"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region, sharp_edges
from foveal.refine.depth_words import depths_json
from foveal.refine.slates_depth import Depths
from foveal.refine.slates_placements import placed
from foveal.scene.cage_file import write_cage
from foveal.scene.refinement import Refinement

FOLDER = Path(__file__).parents[2] / "spec" / "golden"
MESH = TriMesh.of(  # a pyramid without its base, somewhere on a map
    [
        [684_300.1, 0.3, 7e-9],
        [684_301.7, 0.25, 0],
        [684_301.5, 1.9, -2.5],
        [684_300, 2, 0.125],
        [684_301, 1, 40],
    ],
    [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
)
REFINEMENT = Refinement(
    "butterfly",
    Criteria(Region(3, 2.5, math.radians(5)), Region(7), Region(1, 40.0, math.pi)),
    "limit",
    5_000,
    29.97,
)


SHARP = Refinement("sqrt3", Criteria())
ANGLE = 1.5
"""Two of the pyramid's four inner edges bend by more."""


POLYGONS = PolyMesh.of(  # a cube whose top is a triangle and a pentagon, creased, and a lone vertex
    [
        *([684_300.1, 0.3, 7e-9], [684_301.7, 0.25, 0], [684_301.5, 1.9, -2.5], [684_300, 2, 0.125]),
        *(
            [684_300, 0, 4],
            [684_302, 0, 4],
            [684_302, 2, 4],
            [684_300, 2, 4.5],
            [684_301, 0, 4.25],
            [0, 0, 0],
        ),
    ],
    [[0, 3, 2, 1], [0, 1, 5, 8, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 8, 7], [8, 5, 6, 7]],
    creases={(4, 8): 10, (8, 5): 2.5, (1, 0): 0.25, (7, 6): float("inf")},
    sharp_corners={6: 10, 2: 1.5},
    boundary="edge_and_corner",
    colours=[[16 * i, 255 - i, 0.5] for i in range(10)],
    uvs=[[i / 8, -i] for i in range(10)],
)
PLACEMENTS = [
    [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
    [[0, -1.5, 0, 8], [1.5, 0, 0, 0], [0, 0.25, 1.5, 0.1], [0, 0, 0, 1]],
    [[-1, 0, 0, 0.3], [0, 1, 0, 7], [0, 0, 2, 0], [0, 0, 0, 1]],
]
HOLES = [1, 3]
PATCHES = Refinement(
    "catmull-clark",
    Criteria(),
    "limit",
    70_000,
    25.0,
    Depths(6, math.radians(4), True, False, 0.25, (2.0, 12.5)),
)


def write_polygons() -> None:
    """A file of polygons."""
    write_cage(POLYGONS, FOLDER / "cage_polygons.fov", refinement=PATCHES, up="z")
    fields = [field for field in POLYGONS.__dataclass_fields__ if field not in ("boundary", "holes")]
    data = {
        **{field: getattr(POLYGONS, field).tolist() for field in fields},
        "crease_sharpness": [min(s, 2.0**100) for s in POLYGONS.crease_sharpness.tolist()],  # JSON has no inf
        "boundary": POLYGONS.boundary,
        "up": "z",
        "depths": depths_json(PATCHES.depths),
        "budget": PATCHES.budget,
        "rate": PATCHES.rate,
    }
    (FOLDER / "cage_polygons.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


def write_placed(path: Path) -> None:
    """A file in three places, one of them mirrored."""
    write_cage(POLYGONS, path, refinement=PATCHES, up="z", placements=PLACEMENTS)


def write_placed_json() -> None:
    """What such a file holds: the matrices, and where the vertices of all copies are."""
    placements = np.array(PLACEMENTS, np.float64)
    positions = placed(POLYGONS, placements).positions
    data = {"placements": placements.tolist(), "positions": positions.tolist()}
    (FOLDER / "cage_placed.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


def write_holed(path: Path) -> None:
    """A file with holes, in two places."""
    mesh = replace(POLYGONS, holes=np.array(HOLES, np.int32))
    write_cage(mesh, path, refinement=PATCHES, up="z", placements=PLACEMENTS[:2])


def write_holed_json() -> None:
    """Of the same polygons, which faces are left out, and how many are shown in all places."""
    data = {"holes": HOLES, "shown": 2 * (POLYGONS.faces - len(HOLES))}
    (FOLDER / "cage_holed.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


def write_sharp() -> None:
    """A file with sharp edges."""
    write_cage(MESH, FOLDER / "cage_sharp.fov", refinement=SHARP, sharp_edges=ANGLE)
    edges = sharp_edges(MESH, ANGLE)
    data = {"positions": MESH.positions.tolist(), "faces": MESH.faces.tolist(), "sharp": edges.tolist()}
    (FOLDER / "cage_sharp.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


def main() -> None:
    """Write all."""
    write_sharp()
    write_polygons()
    write_placed(FOLDER / "cage_placed.fov")
    write_placed_json()
    write_holed(FOLDER / "cage_holed.fov")
    write_holed_json()
    write_cage(MESH, FOLDER / "cage.fov", refinement=REFINEMENT, up="z")
    regions = {
        name: {"iterations": region.iterations, "edge_px": region.edge_px, "bend": region.bend}
        for name in ("front", "silhouette", "back")
        for region in [getattr(REFINEMENT.criteria, name)]
    }
    data = {
        "positions": MESH.positions.tolist(),
        "faces": MESH.faces.tolist(),
        "up": "z",
        "scheme": "butterfly",
        "criteria": regions,
        "shown": "limit",
        "budget": 5_000,
        "rate": 29.97,
    }
    (FOLDER / "cage.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
