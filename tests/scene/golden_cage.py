"""Writes `spec/golden/cage.fov` and `cage.json`, which pytest and vitest both read.

PYTHONPATH=tests python -m scene.golden_cage
"""

import json
import math
from pathlib import Path

from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region
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


def main() -> None:
    """Write both."""
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
