"""Catmull-Clark patches of small control meshes: what spec/golden/slates.json has, as in the viewer."""

import json

import numpy as np
import pytest

from foveal.mesh.polymesh import PolyMesh
from foveal.refine import Slates
from foveal.refine.depth_words import depths_json
from refine import golden_slates as golden

GOLDEN = json.loads(golden.PATH.read_text())


def mesh_of(data):
    shapes = {"positions": (-1, 3), "crease_edges": (-1, 2), "colours": (-1, 3), "uvs": (-1, 2)}
    arrays = {
        name: np.reshape(values, shapes.get(name, (-1,))) if name != "boundary" else values
        for name, values in data.items()
    }
    for name in ("starts", "corners", "crease_edges", "corner_vertices", "holes"):
        if name in arrays:
            arrays[name] = arrays[name].astype(np.int32)
    return PolyMesh(**arrays).checked()


@pytest.mark.parametrize("cage", GOLDEN["cages"], ids=[cage["name"] for cage in GOLDEN["cages"]])
def test_patches_are_golden_bit_for_bit(cage):
    placements = np.reshape(cage["placements"], (-1, 4, 4)) if "placements" in cage else None
    surface = Slates(mesh_of(cage["mesh"]), placements=placements)
    for step in cage["steps"]:
        golden.shown(surface, step)
        found = golden.found(surface)
        assert found == {name: step[name] for name in found}


def test_what_a_page_has_of_places_colours_and_holes_is_golden():
    assert golden.session() == GOLDEN["session"]


def test_the_budgets_of_a_rate_are_golden():
    assert list(golden.rates()) == GOLDEN["rates"]
    assert {name: depths_json(rules) for name, rules in golden.RULES.items()} == GOLDEN["rules"]
