"""A live scene for tests of refinements, and what they share: cameras, keys, sliders, compared pictures."""

import math
from contextlib import closing, contextmanager

import numpy as np
import pytest

from e2e.page import idle, stats
from e2e.static_server import StaticServer
from foveal.mesh.shapes import bumpy_sphere
from foveal.refine import Criteria, Region
from foveal.refine.session import warm
from foveal.scene import Scene, View
from foveal.scene.cage_file import write_cage
from foveal.scene.publish import publish
from foveal.scene.refinement import Refinement
from foveal.scene.scene import Layer
from foveal.server import start
from foveal.view.camera import Camera

WIDTH, HEIGHT = 640, 480
CRITERIA = Criteria(Region(5, 12.0), Region(6, 6.0), Region(0))
FRONT = {"position": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0], "fieldOfViewDegrees": 40}
NEAR = {"position": [0.3, 0.2, 1.6], "target": [0.1, 0.1, 0.9], "up": [0, 1, 0], "fieldOfViewDegrees": 40}
#: Without the picture from elsewhere, which would be in the pictures that are compared.
PLAIN = "#v=1&n=0"


def published(scene, folder, viewer):
    """The files of its site."""
    site = publish(scene, folder, viewer=viewer)
    return {p.relative_to(site).as_posix(): p for p in site.rglob("*") if p.is_file()}


@contextmanager
def served(way, scene, viewer, folder):
    """A scene "live", or as static files once it is published into a folder."""
    if way == "live":
        with start(scene, port=0, viewer=viewer) as server:
            yield server
        return
    with closing(StaticServer(published(scene, folder, viewer))) as server:
        yield server


@pytest.fixture(scope="module")
def cage(tmp_path_factory):
    """A control mesh of 320 triangles; no page waits for its kernels."""
    warm("sqrt3")
    mesh = bumpy_sphere(2)
    path = tmp_path_factory.mktemp("cage") / "ball.fov"
    write_cage(mesh, path, refinement=Refinement("sqrt3", CRITERIA))
    return mesh, path


@pytest.fixture
def site(cage, viewer_folder):
    """In the place of the static files of the other tests: foveal's server with a live layer."""
    refinement = Refinement("sqrt3", CRITERIA)
    views = (View("Side", Camera.of([4, 0, 0], [0, 0, 0])),)
    scene = Scene("A ball from few triangles", (Layer("ball", cage[1], refinement=refinement),), views)
    with start(scene, port=0, viewer=viewer_folder) as server:
        yield server


def go(page, camera):
    page.evaluate("camera => foveal.setCamera(camera)", camera)
    idle(page)
    return stats(page)


def press(page, key):
    page.keyboard.press(key)
    page.evaluate("new Promise(requestAnimationFrame)")
    idle(page)


def differs(a, b):
    return (np.abs(a.astype(int) - b).max(axis=2) > 20).mean()


def slide(page, name, position):
    """Bring a slider to a position, as a hand would."""
    page.evaluate(
        """([id, position]) => {
          const input = document.getElementById(id);
          input.value = position;
          input.dispatchEvent(new Event("input", { bubbles: true }));
        }""",
        [f"set-{name}", position],
    )
    idle(page)


def assert_as_asked(shown, refined, camera):
    """The page shows the mesh that Python has for the same camera and CRITERIA."""
    same = Camera.of(
        camera["position"],
        camera["target"],
        up=camera["up"],
        field_of_view=math.radians(camera["fieldOfViewDegrees"]),
        width=WIDTH,
        height=HEIGHT,
        near=1e-3,
    )
    wanted = refined.update(same, criteria=CRITERIA).faces
    # the page's own frame rounds the last digits of the camera, and decides by them now and then
    assert shown["refinement"]["triangles"] == pytest.approx(wanted, rel=2e-3)
    assert shown["triangles"] == shown["refinement"]["triangles"]
    assert shown["refinement"]["threshold"] == 1
