"""Writes `spec/golden/sqrt3.json` and `sharp.json`, which pytest and vitest both read: √3 refinements of
small control meshes, without and with sharp edges.

    PYTHONPATH=tests python -m refine.golden_sqrt3

Only when the surface or the criteria themselves change; it says which walks came out differently.
"""

import hashlib
import json
import math
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

import corpus
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, tetrahedron, torus
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Region, Sqrt3
from foveal.refine._kernels_turn import turn
from foveal.refine.criteria import view_of
from foveal.refine.pace import COARSEST, Pace, coarser
from foveal.view.camera import Camera

PATH = Path(__file__).parents[2] / "spec" / "golden" / "sqrt3.json"

SHARP_PATH = PATH.with_name("sharp.json")

LIMITS = 9  #: front, silhouette, back; the page leaves nothing out by a depth buffer


def hull(count, seed):
    """Of points on a sphere: closed, with three to ten neighbours at a vertex."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    faces = ConvexHull(points).simplices
    corners = points[faces]
    volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return TriMesh.of(points, np.where((volumes < 0)[:, None], faces[:, ::-1], faces))


def bipyramid(sides):
    """Two tips of as many neighbours as it has sides."""
    angles = 2 * math.pi * np.arange(sides) / sides
    rim = np.stack([np.cos(angles), np.zeros(sides), np.sin(angles)], axis=1)
    i = np.arange(sides)
    j = (i + 1) % sides
    top, bottom = np.full(sides, sides), np.full(sides, sides + 1)
    faces = np.concatenate([np.stack([j, i, top], axis=1), np.stack([i, j, bottom], axis=1)])
    return TriMesh.of(np.concatenate([rim, [[0, 0.8, 0], [0, -0.6, 0]]]), faces)


def bowl():
    """A hull with its top away: open, irregular, with edges inside that join two border vertices."""
    ball = hull(40, 5)
    faces = ball.faces[ball.positions[ball.faces].mean(axis=1)[:, 1] < 0.5]
    used = np.unique(faces)
    return TriMesh.of(ball.positions[used], np.searchsorted(used, faces))


def moved(mesh, by):
    return TriMesh(mesh.positions + by, mesh.faces)


CAGES = {
    "tetrahedron": tetrahedron,
    "single_triangle": corpus.single_triangle,
    "two_triangles": corpus.two_triangles,
    "bumpy": lambda: bumpy_sphere(1, seed=3),
    "torus": lambda: torus(7, 5),
    "terrain": lambda: terrain(5),
    "hull": lambda: hull(30, 1),
    "bowl": bowl,
    "bipyramid": lambda: bipyramid(12),
    "two_pieces": lambda: corpus.joined(icosphere(0), moved(terrain(3), 9)),
    "far_away": lambda: moved(torus(6, 4), (455_000.5, 5_020_000.25, 310.125)),
}
CRITERIA = {
    "usual": Criteria(),
    "fine": Criteria(Region(8, 16.0), Region(9, 8.0), Region(2, 40.0)),
    "bent": Criteria(Region(5, 0.0, 0.12), Region(7, 3.0, 0.02), Region(3, 0.0, 0.3)),
    "deep": Criteria(Region(4), Region(6), Region(2)),
    "everywhere": Criteria(Region(5), Region(5), Region(5)),
    "nowhere": Criteria(Region(0), Region(0), Region(0)),
}
ORDERS = (
    ("usual", "fine", "nowhere", "bent", "everywhere", "deep", "fine"),
    ("deep", "fine", "fine", "usual", "bent", "fine", "everywhere"),
)


def rows_of(mesh, levels):
    """(m, 10): corners bit for bit and level, whatever the order of triangles and which corner is first."""
    corners = mesh.positions[mesh.faces] + 0.0
    order = np.lexsort((corners[..., 2], corners[..., 1], corners[..., 0]), axis=1)[:, 0]
    turned = np.take_along_axis(corners, ((order[:, None] + np.arange(3)) % 3)[..., None], axis=1)
    rows = np.column_stack([turned.reshape(-1, 9), levels])
    return rows[np.lexsort(rows.T[::-1])]


def shown(refined):
    """The rows of a refinement by what is shown of it: where its vertices are, go and were born."""
    found = {}
    for name in ("control", "limit", "starts"):
        slots = refined.slots(positions="limit" if name == "limit" else "control")
        is_face = slots.faces.any(axis=1)
        places = slots.starts if name == "starts" else slots.positions
        found[name] = rows_of(TriMesh(places, slots.faces[is_face]), slots.levels[is_face])
    return found


def digest(rows):
    return hashlib.sha256(rows.astype("<f8").tobytes()).hexdigest()


def refined_to(refined, camera, criteria, slices):
    """Update, in slices of so many splits where a number is given."""
    while True:
        done = refined.update(camera, criteria=criteria, most_splits=slices)
        if done.is_done:
            return done


def _cameras(mesh, rng):
    """Around a control mesh, near and far, and one from close above the surface."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    for closeness in (1.0, 0.97, 2.5, 0.6, 1.0, 0.45, 0.8):
        camera = Camera.around(low, high, direction=rng.normal(size=3), width=900, height=700)
        eye = camera.target + (camera.position - camera.target) * closeness
        target = camera.target + rng.normal(size=3) * 0.1 * np.linalg.norm(high - low)
        yield Camera.of(eye, target, field_of_view=0.7, width=900, height=700)


def _camera_json(camera):
    keys = ("position", "target", "up")
    data = {key: getattr(camera, key).tolist() for key in keys}
    return data | {
        "fov": camera.field_of_view,
        **{key: getattr(camera, key) for key in ("width", "height", "near", "far")},
    }


def _walk(number, name, mesh, sharp=None):
    rng = np.random.default_rng(number)
    steps = []
    refined = Sqrt3(mesh, sharp=sharp)
    for i, camera in enumerate(_cameras(mesh, rng)):
        chosen = ORDERS[number % 2][i]
        slices = int(rng.choice([7, 60])) if i % 3 == 1 else None
        done = refined_to(refined, camera, CRITERIA[chosen], slices)
        found = shown(refined)
        step = {
            "camera": _camera_json(camera),
            "view": view_of(camera).tolist(),
            "criteria": chosen,
            "slices": slices,
            "faces": done.faces,
            "vertices": done.vertices,
            **{key: digest(rows) for key, rows in found.items()},
        }
        if done.faces <= 12:  # whole, for who looks for what differs
            step["rows"] = found["control"].tolist()
        steps.append(step)
    return {"cage": name, "steps": steps}


def _view(top, budget, rate=0, is_leap=False, is_moving=False):
    return {"top": top, "budget": budget, "rate": rate, "is_leap": is_leap, "is_moving": is_moving}


SEARCHES = [
    (4.0, [_view(90_000, 30_000), _view(100_000, 30_000, is_moving=True), _view(60_000, 30_000)]),
    (
        4.0,
        [_view(90_000, 30_000, is_leap=True), _view(20_000, 30_000, is_moving=True), _view(20_000, 90_000)],
    ),
    (0.0, [_view(5_000_000, 20_000, is_leap=True), _view(5_000_000, 21_000, is_moving=True)]),
    (8.0, [_view(800, 30_000), _view(0, 30_000)]),
    (2.0, [_view(2_000_000, 0, rate=30), _view(900_000, 0, rate=31, is_moving=True), _view(1e6, 0, rate=60)]),
    (4.0, [_view(7_000, 10), _view(7_000, 6_000, is_moving=True), _view(7_000, 6_000)]),
]


def _searches():
    """What the search for a threshold does where a step has `top` / 2^(step / 4) triangles, at least 12."""
    for edge, views in SEARCHES:
        pace = Pace(least=12, budget=2_000_000)
        criteria = Criteria(Region(6, edge), Region(8, edge / 2), Region(0))
        told = []
        for view in views:
            pace.spent(4e-4)
            pace.begin(criteria, budget=view["budget"], rate=view["rate"], is_leap=view["is_leap"])
            steps = []
            while not (pace.is_fit if view["is_moving"] else pace.is_settled):
                if pace.is_fit:
                    pace.finer()
                steps.append(pace.step)
                pace.tell(max(12, int(view["top"] / 2 ** (pace.step / 4))))
            limits = coarser(criteria, pace.step).limits().reshape(-1).tolist()[:LIMITS]
            told.append({**view, "allowed": pace.budget, "steps": steps, "limits": limits})
        yield {"edge_px": edge, "views": told}


def golden_sharp():
    """What the file of sharp edges holds."""
    from refine.test_sharp import CREASED, PILLOWS

    cages = {name: make() for name, make in {**CREASED, **PILLOWS}.items()}
    return {
        "cages": {
            name: {
                "positions": mesh.positions.reshape(-1).tolist(),
                "faces": mesh.faces.reshape(-1).tolist(),
                "sharp": np.asarray(sharp).reshape(-1).tolist(),
            }
            for name, (mesh, sharp) in cages.items()
        },
        "walks": [_walk(i, name, *cage) for i, (name, cage) in enumerate(cages.items())],
    }


def golden():
    """What the file holds."""
    cages = {name: make() for name, make in CAGES.items()}
    return {
        "turns": [[i, n, *turn(i, n)] for n in (1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 31) for i in range(n)],
        "cages": {
            name: {"positions": mesh.positions.reshape(-1).tolist(), "faces": mesh.faces.reshape(-1).tolist()}
            for name, mesh in cages.items()
        },
        "criteria": {
            name: {
                **{
                    key: {name: getattr(region, name) for name in ("iterations", "edge_px", "bend")}
                    for key, region in zip(
                        ("front", "silhouette", "back"),
                        (chosen.front, chosen.silhouette, chosen.back),
                        strict=True,
                    )
                },
                "limits": chosen.limits().reshape(-1).tolist()[:LIMITS],
            }
            for name, chosen in CRITERIA.items()
        },
        "walks": [_walk(i, name, mesh) for i, (name, mesh) in enumerate(cages.items())],
        "coarsest": COARSEST,
        "searches": list(_searches()),
    }


if __name__ == "__main__":
    for path, made in ((PATH, golden()), (SHARP_PATH, golden_sharp())):
        was = json.loads(path.read_text()) if path.exists() else {"walks": []}
        for walk in made["walks"]:
            print(walk["cage"], "as it was" if walk in was["walks"] else "differs")
        path.write_text(json.dumps(made, separators=(",", ":")) + "\n")
