"""A control mesh is refined where the page looks, by the project's own server: camera, budget, faults."""

import math

import numpy as np

from e2e.page import idle, picture, stats
from e2e.refined import (
    FRONT,
    HEIGHT,
    NEAR,
    PLAIN,
    WIDTH,
    assert_as_asked,
    cage,
    differs,
    go,
    press,
    site,
    slide,
)
from foveal.refine import Sqrt3

__all__ = ["cage", "site"]  # fixtures: in the place of the static files of the other tests


def test_the_page_has_the_mesh_that_its_camera_asks_for(open_page, cage):
    page = open_page(PLAIN)
    refined = Sqrt3(cage[0])
    for camera in (FRONT, NEAR, FRONT):
        shown = go(page, camera)
        assert_as_asked(shown, refined, camera)


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
