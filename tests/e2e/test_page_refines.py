"""A published control mesh is refined where the page looks, by the page: static files, no server of ours."""

import shutil

import pytest

from e2e.page import idle, picture, stats
from e2e.refined import CRITERIA, FRONT, HEIGHT, NEAR, PLAIN, WIDTH, assert_as_asked
from e2e.static_server import StaticServer
from foveal.mesh.shapes import bumpy_sphere
from foveal.refine import Sqrt3
from foveal.scene import Scene
from foveal.scene.cage_file import write_cage
from foveal.scene.publish import publish
from foveal.scene.refinement import Refinement
from foveal.scene.scene import Layer
from refine.test_sharp import cube


def published(folder, viewer, refinement, *, mesh=None, sharp_edges=None):
    """The files of a site with a ball of 320 triangles, or another mesh."""
    write_cage(mesh or bumpy_sphere(2), folder / "ball.fov", refinement=refinement, sharp_edges=sharp_edges)
    scene = Scene("A ball from few triangles", (Layer("ball", folder / "ball.fov", refinement=refinement),))
    site = publish(scene, folder / "site", viewer=viewer)
    return {p.relative_to(site).as_posix(): p for p in site.rglob("*") if p.is_file()}


@pytest.fixture(scope="module")
def files(tmp_path_factory, viewer_folder):
    return published(tmp_path_factory.mktemp("site"), viewer_folder, Refinement("sqrt3", CRITERIA))


@pytest.fixture
def site(files):
    """In the place of the static files of the other tests."""
    server = StaticServer(dict(files))
    yield server
    server.close()


def go(page, camera):
    page.evaluate("camera => foveal.setCamera(camera)", camera)
    idle(page)
    return stats(page)


def test_the_page_makes_the_mesh_that_its_camera_asks_for(open_page):
    page = open_page(PLAIN)
    sockets = []
    page.on("websocket", lambda socket: sockets.append(socket.url))
    refined = Sqrt3(bumpy_sphere(2))
    for camera in (FRONT, NEAR, FRONT):
        shown = go(page, camera)
        assert_as_asked(shown, refined, camera)
    assert sockets == []


def test_sharp_edges_stay_sharp_in_the_page(open_page, site, tmp_path, viewer_folder):
    mesh, sharp = cube()
    refinement = Refinement("sqrt3", CRITERIA)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    camera = {**FRONT, "position": [3, 2.2, 4], "target": (0.5 * (low + high)).tolist()}
    covered = {}
    for angle in (1.0, None):
        site.files.update(published(tmp_path, viewer_folder, refinement, mesh=mesh, sharp_edges=angle))
        page = open_page(PLAIN + "&b=black")
        shown = go(page, camera)
        assert_as_asked(shown, Sqrt3(mesh, sharp=None if angle is None else sharp), camera)
        covered[angle] = (picture(page).max(axis=2) > 20).sum()
        shutil.rmtree(tmp_path / "site")
    # as a whole cube the picture is convex and of six sides; without its corners it is rounder, and smaller
    assert covered[1.0] > 1.2 * covered[None]


def test_what_is_shown_has_no_hole(open_page):
    page = open_page(PLAIN + "&b=black")
    go(page, FRONT)
    middle = picture(page)[HEIGHT // 2 - 80 : HEIGHT // 2 + 80, WIDTH // 2 - 80 : WIDTH // 2 + 80]
    assert (middle.max(axis=2) > 20).all()


def test_nothing_happens_while_nothing_changes(open_page):
    page = open_page(PLAIN)
    before = stats(page)["refinement"]["updates"]
    page.wait_for_timeout(400)
    assert stats(page)["refinement"]["updates"] == before


def test_a_budget_of_the_file_is_kept_by_longer_edges(open_page, site, tmp_path, viewer_folder):
    free = stats(open_page(PLAIN))["refinement"]["triangles"]
    site.files.update(published(tmp_path, viewer_folder, Refinement("sqrt3", CRITERIA, budget=free // 2)))
    shown = stats(open_page(PLAIN))["refinement"]
    assert free // 4 < shown["triangles"] <= free // 2
    assert shown["threshold"] > 1


def test_a_scheme_that_needs_a_server_is_told(open_page, site, tmp_path, viewer_folder):
    site.files.update(published(tmp_path, viewer_folder, Refinement("loop", CRITERIA)))
    page = open_page(is_ready=False, errors_wanted=True)
    page.wait_for_function("document.body.innerText.includes('Open it with: foveal view')")


def test_a_damaged_control_mesh_is_told(open_page, site):
    name = next(name for name in site.files if name.endswith(".fov"))
    data = bytearray(site.files[name].read_bytes())
    data[-8] ^= 1
    site.files[name] = bytes(data)
    page = open_page(is_ready=False, errors_wanted=True)
    page.wait_for_function("document.body.innerText.includes('damaged')")
