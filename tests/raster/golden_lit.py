"""Adds the cases of a scene's light to `spec/golden/shading.json`, from the slow twin of the page.

PYTHONPATH=tests python -m raster.golden_lit
"""

import json
from pathlib import Path

import numpy as np

from raster import naive_raster

PATH = Path(__file__).parents[2] / "spec" / "golden" / "shading.json"


def unit(random):
    vector = random.normal(size=3)
    return np.round(vector / np.linalg.norm(vector), 9).tolist()


def main():
    random, cases = np.random.default_rng(9), []
    for shadow in (0.0, 0.25, 1.0) * 16:
        colour = random.integers(0, 256, 3).tolist()
        case = {"colour": colour, "normal": unit(random), "facing": unit(random), "to_light": unit(random)}
        pixel = naive_raster.shade(colour, case["normal"], case["facing"], shadow, case["to_light"])
        cases.append(case | {"shadow": shadow, "pixel": pixel})
    data = json.loads(PATH.read_text()) | {"with_light": cases}
    lists = [f' "{name}": [\n{_lines(data[name])}\n ]' for name in ("cases", "with_light")]
    PATH.write_text("{\n" + ",\n".join([f' "page": "{data["page"]}"', *lists]) + "\n}\n")


def _lines(cases):
    return ",\n".join(f"  {json.dumps(case)}" for case in cases)


if __name__ == "__main__":
    main()
