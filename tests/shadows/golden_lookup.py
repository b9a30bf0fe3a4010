"""Writes `spec/golden/shadow_lookup.json` and `.bin`, which pytest and the viewer both read: trees, their
words, queries and answers.

    PYTHONPATH=tests python -m shadows.golden_lookup

Only when the page itself changes. The numbers of the answers come from the slow twins.
"""

import importlib
import json
from pathlib import Path

import numpy as np
import pytest

from shadows.maps import TREES
from shadows.naive_lookup import lit_count, receiver, value_in

packing = importlib.import_module("foveal.shadows.pack")  # the function has its name

PATH = Path(__file__).parents[2] / "spec" / "golden" / "shadow_lookup.json"
WORDS_PATH = PATH.with_suffix(".bin")
MOST_POINTERS = {"one_value": 65535, "one_pixel": 65535, "things": 65535, "stack": 65535}


def pixels_of(packed, level, random, count, beside):
    side = 1 << level
    pixels = random.integers(-beside, side + beside, (count, 3))
    pixels[:, 2] = pixels[:, 2].clip(0, side - 1) if packed.children == 8 else 0
    return pixels.tolist()


def case_of(name, random):
    tree = TREES[name]()
    most = MOST_POINTERS.get(name, 40)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(packing, "_MOST_POINTER", most)
        packed = packing.pack(tree)
    values, lit = [], []
    for level in range(tree.levels + 1):
        pixels = pixels_of(packed, level, random, 40, 0)
        found = [value_in(packed, *pixel, level) for pixel in pixels]
        values.append({"level": level, "pixels": pixels, "values": found})
        for radius in (0, 1, 2):
            pixels = pixels_of(packed, level, random, 24, radius + 1)
            # At a value it is lit, one step behind it no more.
            steps = [
                min(int(random.choice(packed.words)) + k % 2, 2**32 - 1)
                if k % 3
                else int(random.integers(2**32))
                for k in range(len(pixels))
            ]
            found = [
                lit_count(packed, *pixel, step, radius, level)
                for pixel, step in zip(pixels, steps, strict=True)
            ]
            lit.append({"level": level, "radius": radius, "pixels": pixels, "steps": steps, "lit": found})
    data = {
        **{"name": name, "levels": tree.levels, "children": tree.children, "root": tree.root},
        **{"most_pointer": most, "masks": tree.masks.tolist(), "mask_starts": tree.mask_starts.tolist()},
        **{"tree_values": tree.values.tolist(), "value_starts": tree.value_starts.tolist()},
        **{"scales": packed.scales.tolist(), "word_count": len(packed.words), "values": values, "lit": lit},
    }
    return data, packed.words


def turned(direction):
    """Rows that span a light's frame: right, down and along."""
    along = np.array(direction, float) / np.linalg.norm(direction)
    right = np.cross(along, [0, 0, 1] if abs(along[2]) < 0.9 else [0, 1, 0])
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(along, right), along])


def projections():
    """Parallel straight and slanting light, an oblique window, a spot."""
    out = []
    for direction, extent in (((0, 0, -1), 4), ((0.3, 0.5, -0.8), 8), ((0.9, 0.1, -0.05), 1000)):
        matrix = np.eye(4)
        matrix[:3, :3] = turned(direction) / extent
        matrix[:3, 3] = 0.5
        out.append(matrix)
    oblique = out[0].copy()
    oblique[0, 2], oblique[1, 2], oblique[1, 1] = 0.125, -0.0625, 0.125
    out.append(oblique)
    rows, place = turned((0.2, -0.1, -1)), np.array([1.0, 2, 8])
    spot = np.zeros((4, 4))
    spot[3, :3], spot[3, 3] = rows[2], -rows[2] @ place
    for k in (0, 1):
        spot[k, :3] = rows[k] / 1.5
        spot[k, 3] = -rows[k] @ place / 1.5
        spot[k] += 0.5 * spot[3]
    spot[2] = spot[3] / 20
    out.append(spot)
    return out


def receivers(random):
    cases = []
    for matrix in projections():
        for levels, level, radius in ((4, 4, 0), (10, 10, 1), (16, 16, 2), (20, 20, 0), (12, 9, 1)):
            extent = 0.3 / np.abs(matrix[0, :3]).max() if matrix[3, 3] == 1 else 3
            points = random.uniform(-extent, extent, (6, 3))
            normals = random.normal(size=(6, 3))
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            for k, (point, normal) in enumerate(zip(points.tolist(), normals.tolist(), strict=True)):
                given = None if k == 0 else normal
                x, y, step = receiver(matrix, levels, point, given, radius, level) or (None, None, None)
                if x is None or max(abs(x), abs(y)) >= 2**30:
                    continue
                map_ = {"matrix": matrix.ravel().tolist(), "levels": levels}
                asked = {"level": level, "radius": radius, "point": point, "normal": given}
                cases.append(map_ | asked | {"pixel": [x, y], "step": step})
    return cases


def main():
    random = np.random.default_rng(5)
    trees, words, start = [], [], 0
    for name in TREES:
        data, tree_words = case_of(name, random)
        trees.append(data | {"word_start": start})
        words.append(tree_words)
        start += len(tree_words)
    WORDS_PATH.write_bytes(np.concatenate(words).astype("<u4").tobytes())
    places = receivers(random)
    data = {"page": "spec/shadows.md", "words": WORDS_PATH.name, "trees": trees, "receivers": places}
    PATH.write_text(json.dumps(data, separators=(",", ":")) + "\n")
    print(f"{len(trees)} trees, {start} words, {len(places)} receivers, {PATH.stat().st_size} bytes")


if __name__ == "__main__":
    main()
