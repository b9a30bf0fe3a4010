"""Patches with colours in many places: the page draws what the CPU draws, and colours can be left out.

Once with foveal's server, which tessellates then, and once of static files, where the page does it by itself.
"""

from dataclasses import replace

import numpy as np
import pytest

import foveal
from e2e.page import picture
from e2e.refined import FRONT, PLAIN, go, press, served
from e2e.test_catmull_clark_page import camera_of, near, steps_of
from foveal.mesh.poly_shapes import cube
from foveal.refine.patch_session import warm_patches
from foveal.refine.slates import Slates
from foveal.refine.slates_placements import placed
from foveal.scene import Scene
from foveal.scene.cage_file import write_cage
from foveal.scene.refinement import chosen
from foveal.scene.scene import Layer

VIEW = {**FRONT, "position": [1, 2, 9], "target": [1, 0, 0]}
#: A cube coloured by where its vertices are, and the same mirrored and larger beside it.
MESH = replace(cube(), colours=((cube().positions + 1) * 100 + 55).astype(np.float32))
PLACES = np.stack([np.eye(4), np.array([[-1.5, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])])
REFINEMENT = chosen({"scheme": "catmull-clark", "depths": {"most": 5}})


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    warm_patches()
    path = tmp_path_factory.mktemp("cage") / "cubes.fov"
    write_cage(MESH, path, refinement=REFINEMENT, placements=PLACES)
    return Scene("Coloured", (Layer("cubes", path, refinement=REFINEMENT),), background="#000000")


@pytest.fixture(params=["live", "static"])
def site(request, scene, viewer_folder, tmp_path):
    """In the place of the static files of the other tests: a live layer, or what was published."""
    with served(request.param, scene, viewer_folder, tmp_path / "site") as server:
        yield server


def hues(pixels):
    """Which of a picture's pixels are neither grey nor black."""
    return np.ptp(pixels.astype(int), axis=2) > 40


def test_colours_and_places_are_drawn_as_by_the_cpu(open_page, scene):
    page = open_page(PLAIN)
    go(page, VIEW)
    seen = picture(page).astype(int)
    expected = np.asarray(foveal.render(scene, camera=camera_of(VIEW))).astype(int)
    is_model = (seen.max(axis=2) > 20) & (expected.max(axis=2) > 20)
    is_even = is_model & ~near(steps_of(seen, 6) | steps_of(expected, 6), 2)
    assert is_even.mean() > 0.03
    assert np.abs(seen - expected).max(axis=2)[is_even].max() <= 4
    columns = np.flatnonzero(hues(seen).any(axis=0))
    assert (np.diff(columns) > 10).sum() == 1  # two of them, apart


def test_each_place_has_depths_of_its_own_and_is_counted(open_page):
    page = open_page(PLAIN)
    assert page.locator("#subtitle").text_content().startswith("12 faces")
    surface = Slates(placed(MESH, PLACES))
    for view in (VIEW, {**VIEW, "position": [-1, 1, 3.5]}):
        shown = go(page, view)
        wanted = surface.update(camera_of(view), depths=REFINEMENT.depths).triangles
        # the page's own frame rounds the last digits of the camera, and decides by them now and then
        assert shown["triangles"] == pytest.approx(wanted, rel=0.02)


def test_colours_can_be_left_out_and_levels_go_before(open_page):
    page = open_page(PLAIN)
    go(page, VIEW)
    coloured = picture(page)
    assert page.locator("[data-tool=colours]").get_attribute("aria-disabled") == "false"
    press(page, "c")
    grey = picture(page)
    assert hues(coloured).mean() > 0.05
    assert hues(grey).mean() == 0
    assert (grey.max(axis=2) > 20).sum() == pytest.approx((coloured.max(axis=2) > 20).sum(), rel=0.02)
    press(page, "c")
    assert (picture(page) == coloured).all()
    press(page, "m")
    assert (picture(page) != coloured).any(axis=2).mean() > 0.05
