"""√3 refinements of small control meshes: the triangles of spec/golden/, as in the viewer."""

import json
import math

import numpy as np
import pytest

from foveal.mesh.trimesh import TriMesh
from foveal.refine import Sqrt3
from foveal.refine._kernels_turn import turn
from foveal.refine.criteria import view_of
from foveal.view.camera import Camera
from refine import golden_sqrt3 as golden

GOLDEN = json.loads(golden.PATH.read_text())
SHARP = json.loads(golden.SHARP_PATH.read_text())


def refinement_of(data):
    mesh = TriMesh.of(np.reshape(data["positions"], (-1, 3)), np.reshape(data["faces"], (-1, 3)))
    return Sqrt3(mesh, sharp=np.reshape(data["sharp"], (-1, 2)) if "sharp" in data else None)


def camera_of(data):
    names = ("width", "height", "near", "far")
    return Camera.of(
        data["position"],
        data["target"],
        up=data["up"],
        field_of_view=data["fov"],
        **{name: data[name] for name in names},
    )


class Seen:
    """A camera whose view is given: cosines and tangents may differ between machines."""

    def __init__(self, view):
        self.position, self.planes, self.pixels = np.array(view[:3]), np.array(view[4:]), view[3]

    def pixels_per_radian(self):
        return self.pixels

    def frustum(self):
        return self.planes.reshape(5, 4)


WALKS = [(file["cages"][walk["cage"]], walk) for file in (GOLDEN, SHARP) for walk in file["walks"]]


@pytest.mark.parametrize(("cage", "walk"), WALKS, ids=[walk["cage"] for _, walk in WALKS])
def test_a_walk_gives_the_golden_triangles_bit_for_bit(cage, walk):
    walking = refinement_of(cage)
    for step in walk["steps"]:
        seen, criteria = Seen(step["view"]), golden.CRITERIA[step["criteria"]]
        np.testing.assert_allclose(view_of(camera_of(step["camera"])), step["view"], rtol=1e-12, atol=1e-12)
        fresh = refinement_of(cage)
        fresh.update(seen, criteria=criteria)
        for refined in (fresh, walking):
            done = golden.refined_to(refined, seen, criteria, step["slices"])
            found = golden.shown(refined)
            assert (done.faces, done.vertices) == (step["faces"], step["vertices"])
            assert {name: golden.digest(rows) for name, rows in found.items()} == {
                name: step[name] for name in found
            }
        if "rows" in step:
            assert found["control"].tolist() == step["rows"]


def test_shares_of_a_turn_are_golden_and_true():
    for i, n, cosine, sine in GOLDEN["turns"]:
        assert turn(i, n) == (cosine, sine)
        angle = 2 * math.pi * i / n
        assert (cosine, sine) == pytest.approx((math.cos(angle), math.sin(angle)), abs=2e-15)


def test_the_quarters_of_a_turn_are_exact():
    assert [turn(i, 4) for i in range(4)] == [(1, 0), (0, 1), (-1, 0), (0, -1)]


def test_the_search_for_a_threshold_is_golden():
    assert list(golden._searches()) == GOLDEN["searches"]
    assert GOLDEN["coarsest"] == golden.COARSEST
