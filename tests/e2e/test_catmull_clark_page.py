"""Catmull-Clark patches in the page: the tessellation of its camera, sharp creases, depths chosen by hand.

Once with foveal's server, which tessellates then, and once of static files, where the page does it by itself.
"""

import math

import numpy as np
import pytest

import foveal
from e2e.page import picture, stats
from e2e.refined import FRONT, HEIGHT, PLAIN, WIDTH, go, press, published, served, slide
from e2e.static_server import StaticServer
from foveal.mesh.poly_shapes import cube, prism
from foveal.mesh.polymesh import PolyMesh
from foveal.refine.patch_session import warm_patches
from foveal.refine.slates import Slates
from foveal.scene import Scene
from foveal.scene.cage_file import write_cage
from foveal.scene.refinement import chosen
from foveal.scene.scene import Layer
from foveal.view.camera import Camera
from refine.cages import creased

SIDE = {**FRONT, "position": [2.5, 3, 4.5]}
TOP = {(4, 5): 10.0, (5, 7): 10.0, (6, 7): 10.0, (4, 6): 10.0}
MESH = PolyMesh.of(cube().positions, cube().corners.reshape(-1, 4), creases=TOP)
REFINEMENT = chosen({"scheme": "catmull-clark", "depths": {"most": 6}})


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    """A cube with a creased side; no page waits for its kernels."""
    warm_patches()
    path = tmp_path_factory.mktemp("cage") / "cube.fov"
    write_cage(MESH, path, refinement=REFINEMENT)
    return Scene("Creased", (Layer("cube", path, refinement=REFINEMENT),), background="#000000")


@pytest.fixture(params=["live", "static"])
def site(request, scene, viewer_folder, tmp_path):
    """In the place of the static files of the other tests: a live layer, or what was published."""
    with served(request.param, scene, viewer_folder, tmp_path / "site") as server:
        yield server


def camera_of(view):
    return Camera.of(
        view["position"],
        view["target"],
        up=view["up"],
        field_of_view=math.radians(view["fieldOfViewDegrees"]),
        width=WIDTH,
        height=HEIGHT,
        near=1e-3,
    )


def test_the_page_has_the_tessellation_that_its_camera_asks_for(open_page):
    page = open_page(PLAIN)
    surface = Slates(MESH)
    for view in (FRONT, SIDE, FRONT):
        shown = go(page, view)
        wanted = surface.update(camera_of(view), depths=REFINEMENT.depths).triangles
        # the page's own frame rounds the last digits of the camera, and decides by them now and then
        assert shown["triangles"] == shown["refinement"]["triangles"] == pytest.approx(wanted, rel=0.02)
        assert wanted > 2000


def test_it_is_shaded_as_the_limit_surface_is_and_sharp_at_creases(open_page, scene):
    page = open_page(PLAIN)
    go(page, SIDE)
    seen = picture(page).astype(int)
    expected = np.asarray(foveal.render(scene, camera=camera_of(SIDE))).astype(int)
    is_model = (seen.max(axis=2) > 20) & (expected.max(axis=2) > 20)
    steps, wanted = steps_of(seen), steps_of(expected)
    is_even = is_model & ~near(steps_of(seen, 4) | steps_of(expected, 4), 2)
    assert is_even.mean() > 0.1
    assert np.abs(seen - expected).max(axis=2)[is_even].max() <= 3
    inside = ~near(~is_model, 4)  # where no outline is: the crease
    assert (wanted & inside).sum() > 200
    assert near(steps, 2)[wanted & inside].mean() > 0.95


def steps_of(picture, least=11):
    """Where a pixel differs by so much from the next one."""
    steps = np.zeros(picture.shape[:2], bool)
    steps[:-1] |= np.abs(np.diff(picture, axis=0)).max(axis=2) >= least
    steps[:, :-1] |= np.abs(np.diff(picture, axis=1)).max(axis=2) >= least
    return steps


def near(marks, pixels):
    """Within so many pixels of a mark."""
    out = marks.copy()
    for y in range(-pixels, pixels + 1):
        for x in range(-pixels, pixels + 1):
            out |= np.roll(marks, (y, x), axis=(0, 1))
    return out


def test_depth_radius_and_rules_are_chosen_in_the_panel(open_page):
    page = open_page(PLAIN)
    usual = go(page, SIDE)["triangles"]
    press(page, "r")
    assert "The Catmull-Clark surface of 6 faces." in page.locator("#refinement").inner_text()
    slide(page, "radius", 0)
    finer = stats(page)["triangles"]
    assert finer > usual
    slide(page, "frontIterations", 0)
    assert stats(page)["triangles"] == 12  # a quadrangle a face
    page.get_by_text("Back to the scene's own").click()
    page.evaluate("foveal.idle()")
    assert stats(page)["triangles"] == usual
    page.get_by_label("Silhouettes deeper").uncheck()
    page.evaluate("foveal.idle()")
    assert stats(page)["triangles"] < usual
    press(page, "Escape")


def test_the_budget_is_held(open_page):
    page = open_page(PLAIN)
    go(page, SIDE)
    press(page, "r")
    slide(page, "radius", 0)
    assert stats(page)["triangles"] > 2000
    slide(page, "refined-triangles", 0)
    assert 500 < stats(page)["triangles"] <= 1000


@pytest.fixture
def odd_site(scene, viewer_folder, tmp_path):
    """Quadrangles and heptagons with tags of all kinds; static files."""
    mesh = creased(prism(7), 3)
    write_cage(mesh, tmp_path / "odd.fov", refinement=REFINEMENT)
    odd = Scene("Odd", (Layer("odd", tmp_path / "odd.fov", refinement=REFINEMENT),), background="#000000")
    server = StaticServer(published(odd, tmp_path / "odd", viewer_folder))
    yield mesh, server
    server.close()


@pytest.mark.parametrize("site", ["static"], indirect=True)
def test_static_files_need_no_server_and_become_deeper_from_near(open_page, site, odd_site):
    mesh, server = odd_site
    site.files.clear()
    site.files.update(server.files)
    page = open_page(PLAIN)
    sockets = []
    page.on("websocket", lambda socket: sockets.append(socket.url))
    surface, deepest = Slates(mesh), []
    for away in (30, 8, 2.5):
        view = {**FRONT, "position": [0.6 * away, 0.5 * away, 0.8 * away]}
        shown = go(page, view)
        done = surface.update(camera_of(view), depths=REFINEMENT.depths)
        assert shown["triangles"] == pytest.approx(done.triangles, rel=0.02)
        deepest.append((done.deepest, shown["triangles"]))
    assert deepest == sorted(set(deepest))
    assert sockets == []
