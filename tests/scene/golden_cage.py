"""Writes `cage.fov`, `cage.json`, and `cage_sharp` the same, in `spec/golden`: pytest and vitest read them.

PYTHONPATH=tests python -m scene.golden_cage
"""

import json
import math
from pathlib import Path

from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region, sharp_edges
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


def write_sharp() -> None:
    """A file with sharp edges."""
    write_cage(MESH, FOLDER / "cage_sharp.fov", refinement=SHARP, sharp_edges=ANGLE)
    edges = sharp_edges(MESH, ANGLE)
    data = {"positions": MESH.positions.tolist(), "faces": MESH.faces.tolist(), "sharp": edges.tolist()}
    (FOLDER / "cage_sharp.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


def main() -> None:
    """Write all."""
    write_sharp()
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
