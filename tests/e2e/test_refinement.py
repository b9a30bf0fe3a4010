"""A control mesh is refined where the page looks: by the project's own server, steered by the viewer."""

import math

import numpy as np
import pytest

from e2e.page import idle, picture, stats
from foveal.mesh.shapes import bumpy_sphere
from foveal.refine import Criteria, Region, Sqrt3
from foveal.refine.session import warm
from foveal.scene import Scene, View
from foveal.scene.cage_file import write_cage
from foveal.scene.refinement import Refinement
from foveal.scene.scene import Layer
from foveal.server import start
from foveal.view.camera import Camera

WIDTH, HEIGHT = 640, 480
CRITERIA = Criteria(Region(5, 12.0), Region(6, 6.0), Region(0))
FRONT = {"position": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0], "fieldOfViewDegrees": 40}
NEAR = {"position": [0.3, 0.2, 1.6], "target": [0.1, 0.1, 0.9], "up": [0, 1, 0], "fieldOfViewDegrees": 40}
PHONE = {"viewport": {"width": 360, "height": 640}, "has_touch": True, "is_mobile": True}
#: Without the picture from elsewhere, which would be in the pictures that are compared.
PLAIN = "#v=1&n=0"


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


def test_the_page_has_the_mesh_that_its_camera_asks_for(open_page, cage):
    page = open_page(PLAIN)
    refined = Sqrt3(cage[0])
    for camera in (FRONT, NEAR, FRONT):
        shown = go(page, camera)
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


def test_what_is_shown_is_smooth_and_where_it_belongs(open_page):
    page = open_page(PLAIN + "&b=black")
    go(page, FRONT)
    seen = picture(page).astype(int)
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    radius = np.hypot(rows - HEIGHT / 2 + 0.5, columns - WIDTH / 2 + 0.5)
    is_model = seen.max(axis=2) > 20
    assert is_model[radius < 100].all()  # no hole
    assert not is_model[radius > 230].any()
    inside = seen[HEIGHT // 2 - 60 : HEIGHT // 2 + 60, WIDTH // 2 - 60 : WIDTH // 2 + 60].sum(axis=2)
    assert np.abs(np.diff(inside, axis=0)).max() < 60  # no facet's edge
    assert np.abs(np.diff(inside, axis=1)).max() < 60


def test_nothing_is_drawn_or_sent_while_nothing_changes(open_page):
    page = open_page(PLAIN)
    page.wait_for_timeout(700)
    before = stats(page)
    page.wait_for_timeout(700)
    after = stats(page)
    assert after["frames"] == before["frames"]
    assert after["refinement"] == before["refinement"]


def test_two_pages_look_at_one_model_each_with_its_own_view(open_page):
    far, near = open_page(PLAIN), open_page(PLAIN)
    go(near, NEAR)
    first = go(far, FRONT)["triangles"]
    go(near, FRONT | {"position": [0, 0.5, 1.4]})
    assert stats(far)["triangles"] == first


def test_tools_of_a_refinement_and_only_those(open_page):
    page = open_page(PLAIN)
    names = page.locator("#tools button:visible").evaluate_all(
        "buttons => buttons.map(button => button.getAttribute('aria-label'))"
    )
    assert {"Colour by level", "The mesh from elsewhere", "Refinement"} <= set(names)
    assert not {"Patch colours", "Bounding spheres"} & set(names)
    plain = picture(page)
    for key, name in (("m", "Colour by level"), ("w", "Wireframe"), ("e", "The mesh from elsewhere")):
        press(page, key)
        button = page.get_by_role("button", name=name, exact=True)
        assert button.get_attribute("aria-pressed") == "true"
        assert differs(picture(page), plain) > 0.01, name
        press(page, key)
        assert button.get_attribute("aria-pressed") == "false"
        assert differs(picture(page), plain) < 0.001, name


def test_levels_and_lines_are_those_of_the_true_triangles(open_page):
    page = open_page(PLAIN + "&m=levels&b=black")
    go(page, FRONT)
    hues = {tuple(np.round(pixel / 24)) for pixel in picture(page)[100:380:4, 180:460:4].reshape(-1, 3)}
    assert len(hues) > 8  # several levels in light and shade
    press(page, "w")
    lines = picture(page)
    press(page, "w")
    assert differs(lines, picture(page)) > 0.05


def test_panel_steers_and_the_link_holds_it(open_page):
    page = open_page(PLAIN)
    before = go(page, FRONT)["triangles"]
    press(page, "r")
    assert page.locator("#refinement").is_visible()
    assert "√3 subdivision of 320 triangles" in page.inner_text("#refinement")
    slide(page, "frontPx", 30)
    finer = stats(page)["triangles"]
    assert finer != before
    slide(page, "frontIterations", 1)
    coarser = stats(page)["triangles"]
    assert coarser < before
    page.select_option("#set-positions", "limit")
    page.select_option("#set-faces", "levels")
    idle(page)
    assert page.locator(".legend").is_visible()
    page.wait_for_function("location.hash.includes('m=levels')")
    state = page.evaluate("foveal.getState()")
    assert state["refinement"]["frontIterations"] == 1
    assert state["refinement"]["positions"] == "limit"
    other = open_page(page.evaluate("location.hash"))
    assert other.evaluate("foveal.getState()")["refinement"] == state["refinement"]
    assert stats(other)["triangles"] == pytest.approx(stats(page)["triangles"], rel=2e-3)
    page.get_by_role("button", name="Back to the scene's own").click()
    page.keyboard.press("Escape")
    idle(page)
    assert go(page, FRONT)["triangles"] == before


def test_budget_is_held_by_longer_edges(open_page):
    page = open_page(PLAIN)
    go(page, FRONT)
    press(page, "r")
    slide(page, "refined-triangles", 0)
    shown = stats(page)
    assert shown["triangles"] <= 1000
    assert shown["refinement"]["threshold"] > 1
    page.keyboard.press("Escape")
    page.wait_for_function("document.querySelector('#status').innerText.includes('edges ×')")
    assert go(page, NEAR)["triangles"] <= 1000


def test_limit_positions_are_another_surface(open_page):
    page = open_page(PLAIN + "&r=1,,1&b=black")
    go(page, FRONT)
    control = picture(page)
    page.evaluate("location.hash = location.hash.replace(/r=[^&]*/, 'r=1,,1,,,limit')")
    page.wait_for_function("foveal.getState().refinement.positions === 'limit'")
    idle(page)
    assert differs(picture(page), control) > 0.002


def turn_of(page):
    return page.evaluate("foveal.getState().insetTurn")


def test_the_mesh_from_elsewhere_turns_and_closes(open_page):
    page = open_page()
    camera = page.evaluate("foveal.getState().camera")
    assert page.locator("#inset").is_visible()
    turn, before = turn_of(page), picture(page)
    page.focus("#inset > div")
    page.keyboard.press("ArrowLeft")
    idle(page)
    assert turn_of(page) == [turn[0] - 15, turn[1]]
    box = page.locator("#inset").bounding_box()
    after = picture(page)
    rows = slice(int(box["y"]) - 1, int(box["y"] + box["height"]) + 2)
    columns = slice(int(box["x"]) - 1, int(box["x"] + box["width"]) + 2)
    assert differs(after[rows, columns], before[rows, columns]) > 0.05
    mask = np.ones(after.shape[:2], bool)
    mask[rows, columns] = False
    assert np.abs(after[mask].astype(int) - before[mask]).max() < 20
    page.mouse.move(box["x"] + 60, box["y"] + 60)
    page.mouse.down()
    page.mouse.move(box["x"] + 90, box["y"] + 70, steps=4)
    page.mouse.up()
    assert turn_of(page)[1] > turn[1]
    assert page.evaluate("foveal.getState().camera") == camera
    page.get_by_role("button", name="Close: The mesh from elsewhere").click()
    idle(page)
    assert not page.locator("#inset").is_visible()
    page.wait_for_function("location.hash.includes('n=0')")


@pytest.mark.parametrize(("width", "height"), [(360, 640), (640, 360), (1280, 720)], ids=str)
def test_nothing_lies_over_anything_at_any_size(open_page, width, height):
    page = open_page("#v=1&n=1", viewport={"width": width, "height": height})
    boxes = {
        name: page.locator(name).bounding_box()
        for name in ("#label", "#inset", "#tools", "#status")
        if page.locator(name).is_visible()
    }
    assert "#inset" in boxes
    for name, box in boxes.items():
        assert box["x"] >= 0, name
        assert box["x"] + box["width"] <= width, name
        assert box["y"] >= 0, name
        assert box["y"] + box["height"] <= height, name
    inset = boxes.pop("#inset")
    for name, box in boxes.items():
        is_beside = inset["x"] >= box["x"] + box["width"] or box["x"] >= inset["x"] + inset["width"]
        is_above = inset["y"] >= box["y"] + box["height"] or box["y"] >= inset["y"] + inset["height"]
        assert is_beside or is_above, name
    page.keyboard.press("r")
    panel = page.locator("#refinement").bounding_box()
    assert panel["x"] >= 0
    assert panel["x"] + panel["width"] <= width
    assert panel["height"] <= height


def test_a_phone_has_no_picture_from_elsewhere_until_asked(open_page):
    page = open_page(**PHONE)
    assert not page.locator("#inset").is_visible()
    page.get_by_role("button", name="The mesh from elsewhere").tap()
    assert page.locator("#inset").is_visible()


def test_all_is_allowed_by_the_policy_of_the_server(browser, site):
    errors = []
    page = browser.new_page()
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("console", lambda message: message.type == "error" and errors.append(message.text))
    page.goto(site.url + "#v=1&m=levels&n=1")
    page.evaluate("foveal.ready")
    page.evaluate("foveal.idle()")
    page.keyboard.press("r")
    assert (
        page.locator(".legend span").first.evaluate("s => getComputedStyle(s).borderTopColor")
        != "rgb(0, 0, 0)"
    )
    page.close()
    assert errors == []


def test_picks_views_and_pictures_work_as_for_patches(open_page):
    page = open_page(PLAIN, reduced_motion="reduce")
    page.mouse.dblclick(330, 230)
    idle(page)
    target = page.evaluate("foveal.getState().camera.target")
    assert 0.75 < float(np.linalg.norm(target)) < 1.25  # on the surface
    page.keyboard.press("1")
    idle(page)
    np.testing.assert_allclose(page.evaluate("foveal.getState().camera.position"), [4, 0, 0], atol=1e-3)
    with page.expect_download() as download:
        page.keyboard.press("s")
    assert len(download.value.path().read_bytes()) > 5000


LOSE = """async () => {
  const lost = document.getElementById("picture").getContext("webgl2").getExtension("WEBGL_lose_context");
  lost.loseContext();
  await new Promise(resolve => setTimeout(resolve, 300));
  lost.restoreContext();
  await new Promise(resolve => setTimeout(resolve, 300));
}"""


def test_lost_graphics_come_back_with_all_that_was_shown(open_page):
    page = open_page(PLAIN)
    before = picture(page)
    page.evaluate(LOSE)
    idle(page)
    assert differs(picture(page), before) < 0.001
    press(page, "m")
    press(page, "m")
    assert differs(picture(page), before) < 0.001


def test_no_hole_while_the_mesh_changes(open_page):
    page = open_page(PLAIN + "&b=black")
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    inside = np.hypot(rows - HEIGHT / 2, columns - WIDTH / 2) < 100  # well within the ball, which is closed
    for step in range(24):
        angle, away = 0.15 * step, 4 - 0.1 * step
        position = [away * math.sin(angle), 0.2 * away, away * math.cos(angle)]
        page.evaluate("camera => foveal.setCamera(camera)", FRONT | {"position": position})
        assert picture(page)[inside].max(axis=1).min() > 15, "the black background shows through"
    idle(page)
    assert stats(page)["refinement"]["updates"] > 10


def test_a_server_that_ends_is_told_and_the_picture_stays(open_page, site):
    page = open_page(PLAIN, allow=("WebSocket", "ERR_CONNECTION_REFUSED"))
    before = stats(page)["triangles"]
    site.close()
    page.wait_for_selector("#alerts .strip")
    assert "no longer follows" in page.inner_text("#alerts")
    press(page, "ArrowLeft")
    assert stats(page)["triangles"] == before
    assert page.locator("#alerts .strip").is_visible()
