"""Writes `spec/golden/selection.json`, which pytest and vitest both read.

    PYTHONPATH=tests python -m lod.golden_selection

Only when the rule itself changes; it says how many cases came out differently.
"""

import json
from pathlib import Path

import numpy as np

from foveal.lod.graph import Graph
from foveal.view.camera import Camera
from lod import naive_select
from lod.random_graphs import random_model, random_view

PATH = Path(__file__).parents[2] / "spec" / "golden" / "selection.json"
SIZES = [(6, 1), (10, 2), (40, 6), (60, 12), (90, 24), (150, 40)]  # atoms, leaves


def _graph(graph: Graph) -> dict:
    errors = [None if np.isinf(e) else e for e in graph.errors.tolist()]
    spheres = np.concatenate([graph.centres, graph.radii[:, None]], axis=1).ravel().tolist()
    columns = {
        name: getattr(graph, name).tolist()
        for name in ("first_patch", "finer", "triangles", "vertices", "patch_bytes")
    }
    return {"spheres": spheres, "errors": errors, **columns}


def _case(index: int, graph: Graph, rng: np.random.Generator) -> dict:
    camera = random_view(rng, Camera)
    total = int(graph.triangles.sum())
    options = {
        "error_px": float(rng.choice([-1.0, 0.0, 0.5, 1.0, 4.0])),
        "triangle_budget": None if rng.random() < 0.5 else int(rng.integers(total)),
        "byte_budget": None if rng.random() < 0.7 else int(rng.integers(3 * total)),
        "available": None,
        "is_culling": bool(rng.random() < 0.7),
    }
    available = rng.random(len(graph.errors)) < rng.choice([0.0, 0.5, 0.9, 0.97])
    if rng.random() < 0.5:
        options["available"] = np.flatnonzero(available).tolist()
    view = {
        "eye": camera.position.tolist(),
        "pixels_per_radian": camera.pixels_per_radian(),
        "near": camera.near,
        "planes": camera.frustum().ravel().tolist(),
    }
    found = naive_select.cut(graph, camera, **{**options, "available": _mask(graph, options["available"])})
    found["error_px"] = None if np.isinf(found["error_px"]) else found["error_px"]
    return {"graph": index, "camera": _camera(camera), "view": view, "options": options, "cut": found}


def _mask(graph, nodes):
    return None if nodes is None else np.isin(np.arange(len(graph.errors)), nodes)


def _camera(camera: Camera) -> dict:
    basis = camera.basis()
    return {
        "position": camera.position.tolist(),
        "target": camera.target.tolist(),
        "up": camera.up.tolist(),
        "field_of_view": camera.field_of_view,
        "width": camera.width,
        "height": camera.height,
        "near": camera.near,
        "far": camera.far,
        "basis": basis.tolist(),
    }


def main() -> None:
    rng = np.random.default_rng(20051023)
    graphs = [
        random_model(
            seed, atoms=atoms, leaves=leaves, zero_errors=seed % 2 == 1, error_scale=[1, 30, 100][seed % 3]
        ).graph
        for seed, (atoms, leaves) in enumerate(SIZES)
    ]
    cases = [_case(i % len(graphs), graphs[i % len(graphs)], rng) for i in range(72)]
    old = json.loads(PATH.read_text())["cases"] if PATH.exists() else []
    changed = sum(a != b for a, b in zip(old, cases, strict=False)) + abs(len(old) - len(cases))
    lines = [f'{{"graphs": [\n{_lines(map(_graph, graphs))}\n],\n"cases": [\n{_lines(cases)}\n]}}\n']
    PATH.write_text("".join(lines))
    print(f"{PATH}: {len(cases)} cases, {changed} of them changed")


def _lines(values) -> str:
    return ",\n".join(json.dumps(value) for value in values)


if __name__ == "__main__":
    main()
