"""Catmull-Clark patches where a scene is static files: the page's own TypeScript, in Node and in a worker."""

from collections.abc import Iterator, Sequence
from statistics import median
from typing import Any

from _refine_page import in_node, in_page
from _shape import Row

from foveal.mesh import PolyMesh
from foveal.refine import Depths
from foveal.refine.depth_words import depths_json
from foveal.view.camera import Camera

SCRIPT = "slates_rounds"


def case_of(mesh: PolyMesh, cameras: Sequence[Camera], rules: Depths, budget: int = 0) -> dict[str, Any]:
    """What `js/slates_rounds.mjs` reads: requests as on the wire."""
    tags = mesh.crease_edges, mesh.crease_sharpness, mesh.corner_vertices, mesh.corner_sharpness
    names = "creaseEdges", "creaseSharpness", "cornerVertices", "cornerSharpness"
    return {
        "mesh": {
            "boundary": mesh.boundary,
            "positions": mesh.positions.reshape(-1).tolist(),
            "starts": mesh.starts.tolist(),
            "corners": mesh.corners.tolist(),
            **{name: values.reshape(-1).tolist() for name, values in zip(names, tags, strict=True)},
        },
        "requests": [
            {
                "camera": _wire(camera),
                "depths": depths_json(rules),
                "budget": budget,
                "positions": "limit",
                "rate": 0,
                "drawn_ms": 0,
            }
            for camera in cameras
        ],
    }


def _wire(camera: Camera) -> dict[str, Any]:
    words = {key: getattr(camera, key).tolist() for key in ("position", "target", "up")}
    numbers = {key: getattr(camera, key) for key in ("width", "height", "near", "far")}
    return {**words, **numbers, "fov": camera.field_of_view}


def rows(data: dict[str, Any], name: str, *, runs: int) -> Iterator[Row]:
    """`patches_page_ms`: a degree further; beside it one from nothing, warm, and the very first."""
    for where, times in (
        ("Node", in_node(data, runs, SCRIPT)),
        ("a browser's worker", in_page(data, runs, SCRIPT)),
    ):
        if times is None:
            why = "no Chromium or no Playwright here"
            yield Row("patches_page_ms", f"{name}, {where}", None, "ms", "lower", why=why)
            continue
        beside = {"fresh": median(times["fresh"]), "cold": times["first"]["fresh"]}
        case = f"{name}, {times['first']['triangles']:,} tri, {where}"
        yield Row.of("patches_page_ms", case, times["orbit"], "ms", "lower", peers=beside)
