"""Writes `spec/golden/shadow_tree_*.fov` and what is in them, `.json`; both pytest and vitest read them.

    PYTHONPATH=tests python -m shadows.golden_trees

Only when the format itself changes.
"""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from foveal.shadows import Directional, Point, SunPath, coded
from foveal.shadows.file import read_parts, write_shadow
from foveal.shadows.pack import pack
from foveal.shadows.projection import Projection
from shadows.maps import FAR, things
from shadows.naive_shadows import tree_of_pixels
from shadows.random_trees import random_tree

FOLDER = Path(__file__).parents[2] / "spec" / "golden"
SMALL_PART = 16
"""Nodes that are joined in the first chunk: few, so that small trees have several chunks."""
DAY = SunPath("2026-06-21T08:00+02:00", "2026-06-21T18:00+02:00", 8, latitude=43.72, longitude=10.4)
DOWN = Directional((0.25, -1, 0.5))


def projections(count):
    """Any matrices: files keep all 64 bits of them."""
    random = np.random.default_rng(count)
    return tuple(Projection(matrix) for matrix in random.standard_normal((count, 4, 4)))


def spread_stack():
    """Eight images, every other place of the third axis."""
    apart = [np.zeros((16, 16, 16), np.int64), np.full((16, 16, 16), FAR)]
    for places, images in zip(apart, things(16, 4, images=8), strict=True):
        places[::2] = images
    return replace(tree_of_pixels(*apart), spread=1)


CASES = {
    "map": lambda: (DOWN, projections(1), (tree_of_pixels(*things(64, 1)),)),
    "six": lambda: (
        Point((1, 2, 3.5)),
        projections(6),
        tuple(tree_of_pixels(*things(16, seed)) for seed in range(6)),
    ),
    "stack": lambda: (DAY, projections(8), (spread_stack(),)),
    "any": lambda: (DOWN, projections(1), (random_tree(np.random.default_rng(8), 5, 4, most=20),)),
    "one_value": lambda: (DOWN, projections(1), (tree_of_pixels(np.full((1, 1), 9), np.full((1, 1), 9)),)),
}


def write(name, path):
    """Write a case; the same bytes each time, but for the version of who wrote them."""
    light, matrices, trees = CASES[name]()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(coded, "SMALL_PART", SMALL_PART)
        write_shadow(SimpleNamespace(light=light, projections=matrices, trees=trees), path)


def tree_json(tree):
    packed = pack(tree)
    return {
        "root": tree.root,
        "spread": tree.spread,
        "masks": tree.masks.tolist(),
        "mask_starts": tree.mask_starts.tolist(),
        "values": tree.values.tolist(),
        "value_starts": tree.value_starts.tolist(),
        "words": packed.words.tolist(),
        "scales": packed.scales.tolist(),
    }


def expected(file):
    """What any reader finds: all that the header says, and the trees after each part."""
    light, matrices, _ = read_parts(file)
    return {
        "light": light,
        "projections": [projection.matrix.tolist() for projection in matrices],
        "levels": file.header["levels"],
        "children": file.header["children"],
        "parts": [
            {"levels": part, "trees": [tree_json(tree) for tree in read_parts(file, levels=part)[2]]}
            for part in file.header["parts"]
        ],
    }


if __name__ == "__main__":
    from foveal.container import open_container

    for case in CASES:
        path = FOLDER / f"shadow_tree_{case}.fov"
        write(case, path)
        with open_container(path) as opened:
            text = json.dumps(expected(opened), separators=(",", ":"))
        path.with_suffix(".json").write_text(text + "\n")
