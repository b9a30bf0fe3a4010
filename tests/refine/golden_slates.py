"""Writes `spec/golden/slates.json`, which pytest and vitest both read: Catmull-Clark patches of small control
meshes, at given depths and as views and rules have them.

    PYTHONPATH=tests python -m refine.golden_slates

Only when the surface or the rules themselves change; it says which cages came out differently. What it holds
is told in spec/slates.md.
"""

import hashlib
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from foveal.mesh.poly_shapes import cube, prism, quad_grid, quad_torus
from foveal.mesh.polymesh import INFINITELY_SHARP, PolyMesh
from foveal.mesh.shapes import icosphere
from foveal.refine import Depths, Slates
from foveal.refine.depth_words import depths_json
from foveal.refine.patch_session import PatchSession
from foveal.refine.slates_placements import placed
from foveal.refine.slates_rate import FrameRate
from foveal.refine.wire import request_of
from refine.cages import creased, valence_two, wavy
from refine.wire_page import Page, wish

PATH = Path(__file__).parents[2] / "spec" / "golden" / "slates.json"
SAMPLES = 3  #: rows whose numbers are told, of those in use, for who looks for what differs


def tagged(mesh, creases=None, corners=None, **what):
    """The same, jolted, with other tags."""
    faces = [ring.tolist() for ring in np.split(mesh.corners, mesh.starts[1:-1])]
    return PolyMesh.of(wavy(mesh, 2), faces, creases=creases, sharp_corners=corners, **what)


def jolted(mesh):
    return replace(mesh, positions=wavy(mesh, 1))


def pole(sides, sharp=None):
    """Quadrangles around one vertex of as many faces; one edge there may be sharp: a dart."""
    angle = 2 * math.pi * np.arange(2 * sides) / (2 * sides)
    rim = np.stack([np.cos(angle), 0.3 * np.cos(3 * angle), np.sin(angle)], axis=1)
    last = 2 * sides
    faces = [[last, (2 * i + 2) % last, 2 * i + 1, 2 * i] for i in range(sides)]
    creases = None if sharp is None else {(last, 2): sharp}
    return PolyMesh.of(np.vstack([rim, [0, 0.5, 0]]), faces, creases=creases)


def coloured(mesh):
    rng = np.random.default_rng(8)
    count = len(mesh.positions)
    return replace(
        mesh,
        colours=rng.integers(0, 256, (count, 3)).astype(np.float32),
        uvs=rng.random((count, 2), np.float32),
    )


def holed():
    """Some faces of a closed mesh are holes, so backs may be seen."""
    mesh = coloured(tagged(prism(6), {(0, 1): 10.0, (6, 7): 1.5}))
    return replace(mesh, holes=np.array([2, 7], np.int32))


TOP = {(4, 5): 10.0, (5, 7): 10.0, (6, 7): 10.0, (4, 6): 10.0}
HALF = dict(zip(TOP, (0.4, 1.0, 2.5, 1.25), strict=True))
CAGES = {
    "cube": lambda: jolted(cube()),
    "creased": lambda: tagged(cube(), TOP),
    "semi_sharp": lambda: tagged(cube(), HALF, {0: 1.5, 3: 10.0}),
    "dart": lambda: tagged(cube(), {(0, 1): 10.0, (0, 2): 1.5}),
    "torus": lambda: jolted(quad_torus(6, 5)),
    "grid": lambda: jolted(quad_grid(4, 3)),
    "grid_corners": lambda: creased(quad_grid(3, 3), 4, "edge_and_corner"),
    "holes": lambda: creased(quad_grid(5, 4), 6, "none"),
    "polygons": lambda: tagged(prism(7), {(0, 1): 10.0, (1, 2): 2.25, (7, 8): 0.5}, {3: 0.75}),
    "triangles": lambda: jolted(PolyMesh.of_triangles(icosphere(0))),
    "lone_triangle": lambda: PolyMesh.of([[9, 9, 9], *np.eye(3)], [[1, 2, 3]]),
    "valence_two": valence_two,
    **{f"pole_{n}": lambda n=n: pole(n) for n in (3, 5, 7)},
    **{f"dart_{n}": lambda n=n: pole(n, 10.0) for n in (3, 4, 5, 12)},
    "coloured": lambda: coloured(tagged(prism(5), {(0, 1): 10.0})),
    "everywhere": lambda: creased(quad_torus(5, 4), 3),
    "holed": holed,
}
PLACED = {"creased": 3}
#: As it is, mirrored and leaning, and small and far from zero.
PLACES = [
    [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
    [[-1.5, 0.25, 0, 4], [0, 1, 0.125, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]],
    [[0, 0.5, 0, 1.5], [0, 0, 0.3, 3], [0.7, 0, 0, -1], [0, 0, 0, 1]],
]
RULES = {
    "usual": Depths(),
    "fine": Depths(most=6, cone=math.radians(3), size_px=(1.0, 8.0)),
    "bent": Depths(most=4, cone=math.radians(12), size_px=None),
    "plain": Depths(most=3, cone=None, backs=False, silhouettes=False, epsilon=0.3, size_px=(4.0, 40.0)),
}


class Seen:
    """A camera of given numbers: tangents may differ between machines."""

    def __init__(self, eye, pixels):
        self.position, self.pixels = np.array(eye), pixels

    def pixels_per_radian(self):
        return self.pixels


def placements_of(name, mesh):
    """Turned, stretched and moved; None for most."""
    if name not in PLACED:
        return None
    rng = np.random.default_rng(5)
    matrices = np.tile(np.eye(4), (PLACED[name], 1, 1))
    size = np.ptp(mesh.positions)
    for i, matrix in enumerate(matrices):
        matrix[:3, :3] += rng.normal(scale=0.3, size=(3, 3)).round(3)
        matrix[:3, 3] = (2 * i * size, 0, 0)
    return matrices


def surface_of(name, mesh):
    return Slates(mesh, placements=placements_of(name, mesh))


def steps_of(number, mesh, patches):
    """Depths by chance, then views from near and far by rules, some within a budget."""
    rng = np.random.default_rng(number)
    for most in (2, 4):
        yield {"depths": rng.integers(0, most, patches).tolist()}
    used = mesh.positions[np.unique(mesh.corners)]
    centre, size = used.mean(axis=0), np.linalg.norm(np.ptp(used, axis=0))
    for i, (away, rules) in enumerate(zip((3.0, 2.0, 1.1, 6.0, 0.7), [*RULES, "usual"], strict=True)):
        direction = rng.normal(size=3)
        eye = centre + size * away * direction / np.linalg.norm(direction)
        budget = int(rng.integers(2, 12)) * patches * 4 if i % 2 else None
        yield {"eye": eye.tolist(), "pixels": 700.0, "rules": rules, "budget": budget}


def shown(surface, step):
    """Bring a surface to a step."""
    if "depths" in step:
        surface.show(step["depths"])
    else:
        seen = Seen(step["eye"], step["pixels"])
        surface.update(seen, depths=RULES[step["rules"]], budget=step["budget"])


def found(surface):
    """What a step has to give, bit for bit."""
    arrays = surface.arrays()
    columns = [arrays.positions, arrays.normals, *arrays.columns]
    rows = np.unique(arrays.faces[arrays.faces.any(axis=1)])
    rows = rows[:: max(1, -(-len(rows) // SAMPLES))]
    depths = arrays.depths.reshape(-1)
    rows_changed, faces_changed = surface.changed()
    return {
        "triangles": int(arrays.counts.sum()),
        "patch_depths": "".join("." if d < 0 else str(d) for d in depths.tolist()),
        "faces": digest(arrays.faces.astype("<u4")),
        "rows_changed": digest(rows_changed.astype("<u4")),
        "faces_changed": digest(faces_changed.astype("<u4")),
        "points": digest(*(column.astype("<f8") for column in columns)),
        "samples": {
            "rows": rows.tolist(),
            "columns": [column[rows].reshape(-1).tolist() for column in columns],
        },
    }


def digest(*arrays):
    return hashlib.sha256(b"".join(np.ascontiguousarray(array).tobytes() for array in arrays)).hexdigest()


def rates():
    """Budgets that a rate finds where a frame takes so long and so much for a triangle."""
    for rate, base, each, least in ((40, 5.0, 1e-4, 100), (30, 1.0, 2e-3, 100), (60, 0.5, 1e-6, 500)):
        pace, budgets = FrameRate(rate, least=least, most=1_000_000), []
        for i in range(14):
            triangles = min(pace.budget, 400_000)
            pace.tell(base + triangles * each * (1 + 0.02 * (i % 3)), triangles)
            budgets.append(pace.budget)
        yield {"rate": rate, "base": base, "each": each, "least": least, "budgets": budgets}


def session():
    """What a page has after each message of a walk around a mesh with colours and holes in several places."""
    mesh = holed()
    live, page, messages = PatchSession(placed(mesh, PLACES)), Page(), []
    walk = [(0.0, 9, "usual", 0), (0.3, 9, "usual", 0), (0.3, 5, "fine", 9_000), (3.0, 40, "plain", 0)]
    for angle, away, rules, budget in walk:
        depths = depths_json(RULES[rules])
        request = wish(seen=page.sequence, angle=angle, away=away, depths=depths, budget=budget)
        live.ask(request_of(json.dumps(request)))
        page.apply(live.answer())
        told = {name: page.head[name] for name in ("base", "flags", "faces", "vertices", "triangles")}
        messages.append({"request": request, **told, "arrays": [digest(array) for array in page.arrays]})
    matrices = np.reshape(PLACES, (-1,)).tolist()
    return {
        "mesh": cage_json(mesh),
        "placements": matrices,
        "origin": live.origin.tolist(),
        "messages": messages,
    }


def cage_json(mesh):
    names = ("positions", "starts", "corners", "crease_edges", "crease_sharpness")
    names += ("corner_vertices", "corner_sharpness", "colours", "uvs")
    values = {name: getattr(mesh, name) for name in names}
    values["holes"] = mesh.holes if len(mesh.holes) else None
    for name in ("crease_sharpness", "corner_sharpness"):  # JSON knows no infinity
        values[name] = np.minimum(values[name], INFINITELY_SHARP)
    data = {name: array.reshape(-1).tolist() for name, array in values.items() if array is not None}
    return data | {"boundary": mesh.boundary}


def golden():
    """What the file holds."""
    cages = []
    for number, (name, make) in enumerate(CAGES.items()):
        mesh = make()
        surface, steps = surface_of(name, mesh), []
        for step in steps_of(number, mesh, surface.patches):
            shown(surface, step)
            steps.append({**step, **found(surface)})
        placements = placements_of(name, mesh)
        placed = {} if placements is None else {"placements": placements.reshape(-1).tolist()}
        cages.append({"name": name, "mesh": cage_json(mesh), **placed, "steps": steps})
    rules = {name: depths_json(rules) for name, rules in RULES.items()}
    return {"rules": rules, "cages": cages, "rates": list(rates()), "session": session()}


if __name__ == "__main__":
    made = golden()
    was = json.loads(PATH.read_text())["cages"] if PATH.exists() else []
    for cage in made["cages"]:
        print(cage["name"], "as it was" if cage in was else "differs")
    PATH.write_text(json.dumps(made, separators=(",", ":")) + "\n")
