"""The page: tools, keys, touch, addresses, small screens, contrast."""

import re

import numpy as np
import pytest

from e2e.page import idle, picture, stats

TOOLS = ["Wireframe", "Patch colours", "Bounding spheres"]
PHONE = {"viewport": {"width": 360, "height": 640}, "has_touch": True, "is_mobile": True}


def camera(page):
    return page.evaluate("foveal.getState().camera")


def distance(state):
    return float(np.linalg.norm(np.subtract(state["position"], state["target"])))


def test_every_tool_has_a_name_and_switches_say_their_state(open_page):
    page = open_page()
    buttons = page.locator("#tools button")
    names = [buttons.nth(i).get_attribute("aria-label") for i in range(buttons.count())]
    assert len(names) == len(set(names)) >= 12
    assert all(names)
    for name in TOOLS:
        plain = picture(page)
        button = page.get_by_role("button", name=name, exact=True)
        assert button.get_attribute("aria-pressed") == "false"
        button.evaluate("button => button.click()")
        idle(page)
        assert button.get_attribute("aria-pressed") == "true"
        assert (np.abs(picture(page).astype(int) - plain).max(axis=2) > 20).mean() > 0.005, name
        button.evaluate("button => button.click()")
        idle(page)
        assert np.abs(picture(page).astype(int) - plain).mean() < 0.5, name


def test_colours_off_is_plaster(open_page):
    page = open_page("#v=1&k=0&b=black")
    seen = picture(page)
    model = seen[seen.max(axis=2) > 60].astype(int)
    assert np.ptp(model, axis=1).max() < 30  # nearly grey everywhere


def test_address_holds_all_and_brings_it_back(open_page, site):
    page = open_page()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Shift+ArrowUp")
    page.keyboard.press("Equal")
    for key in "wpbi":
        page.keyboard.press(key)
    page.keyboard.press("t")
    page.evaluate("foveal.setErrorPx(2.5)")
    idle(page)
    page.wait_for_function("location.hash.includes('e=2.5')")
    page.wait_for_timeout(600)
    address = page.evaluate("location.hash")
    state = page.evaluate("foveal.getState()")
    other = open_page(address)
    found = other.evaluate("foveal.getState()")
    size = distance(state["camera"])
    for key in ("position", "target"):
        np.testing.assert_allclose(found["camera"].pop(key), state["camera"].pop(key), atol=2e-5 * size)
    assert found == state
    assert found["isWireframe"]
    assert found["errorPx"] == 2.5


def test_address_of_a_newer_version_is_told(open_page):
    page = open_page("#v=99&c=1")
    assert "newer version" in page.inner_text("#toast")
    assert stats(page)["patches"] > 0


def test_new_address_in_the_same_page(open_page):
    page = open_page()
    page.evaluate("location.hash = '#v=1&c=0,0,9,0,0,0&u=y&f=30&w=1'")
    page.wait_for_function("foveal.getState().isWireframe")
    assert camera(page)["position"] == pytest.approx([0, 0, 9])


def test_keys_turn_move_zoom_and_go_home(open_page):
    page = open_page(reduced_motion="reduce")
    home = camera(page)
    for key in ("ArrowLeft", "ArrowUp", "Shift+ArrowLeft", "Shift+ArrowDown", "Equal", "Minus"):
        before = camera(page)
        page.keyboard.press(key)
        idle(page)
        after = camera(page)
        assert after != before, key
        if key == "Equal":
            assert distance(after) == pytest.approx(distance(before) / 1.25, rel=1e-3)
        if key.startswith("Shift"):
            assert after["target"] != before["target"]
    page.keyboard.press("f")
    idle(page)
    np.testing.assert_allclose(camera(page)["position"], home["position"], atol=1e-3)
    page.keyboard.press("2")
    idle(page)
    np.testing.assert_allclose(camera(page)["position"], [0.6, 0.5, 1.5], atol=1e-3)


def test_keys_are_left_to_fields(open_page):
    page = open_page()
    page.keyboard.press("o")
    page.focus("#set-error")
    before = camera(page)
    page.keyboard.press("ArrowRight")
    page.keyboard.press("w")
    assert camera(page) == before
    assert not page.evaluate("foveal.getState().isWireframe")
    assert page.evaluate("foveal.stats().targetPx") > 1


def test_help_opens_closes_and_gives_focus_back(open_page):
    page = open_page()
    button = page.get_by_role("button", name="Help")
    button.focus()
    page.keyboard.press("Enter")
    assert page.locator("#help").is_visible()
    assert page.locator("#help th[scope=col]").all_inner_texts() == ["Mouse", "Touch", "Keys"]
    page.keyboard.press("Escape")
    assert not page.locator("#help").is_visible()
    assert page.evaluate("document.activeElement.getAttribute('aria-label')") == "Help"


def test_toolbar_is_one_stop_and_arrows_move_in_it(open_page):
    page = open_page()
    page.focus("#tools button")
    before = camera(page)
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.dataset.tool") == "upAxis"
    page.keyboard.press("End")
    assert page.evaluate("document.activeElement.dataset.tool") == "help"
    assert page.locator("#tools button[tabindex='0']").count() == 1
    assert camera(page) == before


def test_up_axis_goes_round(open_page):
    page = open_page()
    for axis in ("Z", "X", "Y"):
        page.keyboard.press("u")
        assert page.get_by_role("button", name=f"Up axis: {axis}").count() == 1
    idle(page)
    assert camera(page)["up"] == [0, 1, 0]


def test_mouse_turns_moves_zooms_to_the_pointer_and_sets_the_pivot(open_page):
    page = open_page(reduced_motion="reduce")
    start = camera(page)
    page.mouse.move(320, 240)
    page.mouse.down()
    page.mouse.move(400, 260, steps=4)
    page.mouse.up()
    idle(page)
    turned = camera(page)
    assert distance(turned) == pytest.approx(distance(start), rel=1e-6)
    assert turned["position"] != start["position"]
    page.mouse.down(button="right")
    page.mouse.move(430, 240, steps=4)
    page.mouse.up(button="right")
    idle(page)
    assert camera(page)["target"] != turned["target"]
    page.keyboard.press("f")
    idle(page)
    page.mouse.move(360, 200)
    before = camera(page)
    page.mouse.wheel(0, -300)
    idle(page)
    page.wait_for_function(
        "([x, y, z]) => Math.hypot(...foveal.getState().camera.position) < Math.hypot(x, y, z) * 0.97",
        arg=before["position"],
    )
    idle(page)
    page.mouse.dblclick(330, 230)
    idle(page)
    # the pivot is on the surface now: about a unit from the middle of the ball
    assert 0.75 < float(np.linalg.norm(camera(page)["target"])) < 1.25


def touch(page, *frames):
    """Fingers: each frame lists (x, y) of all that are down; the last one lifts them."""
    session = page.context.new_cdp_session(page)
    kinds = ["touchStart"] + ["touchMove"] * (len(frames) - 1)
    for kind, points in zip(kinds, frames, strict=True):
        at = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": at})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def test_touch_turns_pinches_and_moves(open_page):
    page = open_page(**PHONE, reduced_motion="reduce")
    start = camera(page)
    touch(page, [(180, 300)], [(200, 300)], [(230, 310)])
    idle(page)
    turned = camera(page)
    assert turned["position"] != start["position"]
    touch(
        page,
        [(160, 300), (200, 300)],
        [(140, 300), (220, 300)],
        [(110, 300), (250, 300)],
    )
    idle(page)
    near = camera(page)
    assert np.linalg.norm(near["position"]) < np.linalg.norm(turned["position"])
    touch(page, *([(x, 300), (x + 40, 300), (x + 80, 300)] for x in (100, 120, 150)))
    idle(page)
    assert camera(page)["target"] != near["target"]


def test_double_tap_sets_the_pivot(open_page):
    page = open_page(**PHONE, reduced_motion="reduce")
    page.touchscreen.tap(180, 320)
    page.touchscreen.tap(180, 320)
    idle(page)
    page.wait_for_function("Math.hypot(...foveal.getState().camera.target) > 0.75")


def test_small_budgets_on_a_phone(open_page):
    desktop, phone = stats(open_page()), stats(open_page(**PHONE))
    assert phone["memoryBudgetBytes"] * 4 == desktop["memoryBudgetBytes"]
    assert phone["triangleBudget"] * 4 == desktop["triangleBudget"]


@pytest.mark.parametrize(
    ("width", "height"), [(360, 640), (320, 568), (640, 360), (1280, 720)], ids=lambda n: str(n)
)
def test_all_is_reachable_at_every_size(open_page, width, height):
    """360 pixels wide, and 1280 x 720 at 200 %, which is 640 x 360."""
    page = open_page(viewport={"width": width, "height": height})
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    boxes = page.evaluate(
        "[...document.querySelectorAll('#tools button:not([hidden])')]"
        ".map(b => b.getBoundingClientRect().toJSON())"
    )
    for box in boxes:
        assert box["left"] >= 0
        assert box["right"] <= width
        assert box["top"] >= 0
        assert box["bottom"] <= height
        assert min(box["width"], box["height"]) >= 40
    page.keyboard.press("h")
    help_box = page.locator("#help").bounding_box()
    assert help_box["x"] >= 0
    assert help_box["x"] + help_box["width"] <= width
    assert help_box["height"] <= height


CONTRAST = """() => {
  const luminance = ([r, g, b]) => {
    const linear = (c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    const [x, y, z] = [r, g, b].map(c => linear(c / 255));
    return 0.2126 * x + 0.7152 * y + 0.0722 * z;
  };
  const parse = (text) => text.match(/[\\d.]+/g).map(Number);
  const mix = (a, c, d) => a * c + (1 - a) * d;
  const over = (top, under) => top.slice(0, 3).map((c, i) => mix(top[3] ?? 1, c, under[i]));
  const worst = [];
  for (const id of ["title", "subtitle", "status", "views button", "tools button"]) {
    const element = document.querySelector("#" + id);
    const panel = element.closest("#label, #status, #tools");
    const ink = parse(getComputedStyle(element).color);
    for (const behind of [[0, 0, 0], [255, 255, 255]]) {
      const paper = over(parse(getComputedStyle(panel).backgroundColor), behind);
      const [a, b] = [luminance(over(ink, paper)), luminance(paper)].sort((x, y) => y - x);
      worst.push([(a + 0.05) / (b + 0.05), id]);
    }
  }
  return worst.sort((x, y) => x[0] - y[0])[0];
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_contrast_over_any_picture(open_page, scheme):
    page = open_page(color_scheme=scheme)
    assert page.evaluate("document.documentElement.dataset.theme") == scheme
    ratio, where = page.evaluate(CONTRAST)
    assert ratio >= 4.5, where


def test_theme_button_turns_page_and_picture(open_page):
    page = open_page(color_scheme="light")
    light = picture(page)[5, 5].astype(int)
    page.keyboard.press("t")
    idle(page)
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert picture(page)[5, 5].mean() < light.mean() - 100


def test_screen_readers_are_told(open_page):
    page = open_page()
    canvas = page.locator("#picture")
    assert canvas.get_attribute("role") == "application"
    assert "A ball with bumps" in canvas.get_attribute("aria-label")
    described = page.locator("#" + canvas.get_attribute("aria-describedby"))
    assert "Arrow keys" in described.inner_text()
    page.keyboard.press("w")
    page.wait_for_function("document.querySelector('#said').textContent.includes('Wireframe on')")
    page.keyboard.press("ArrowLeft")
    page.wait_for_function("document.querySelector('#said').textContent.includes('front')")


def test_status_line_tells_and_closes(open_page):
    page = open_page()
    page.wait_for_function("document.querySelector('#status').innerText.includes('triangles')")
    text = page.inner_text("#status")
    assert re.search(r"[\d,]+ triangles", text)
    assert re.search(r"B of [\d.]+ [kM]B", text)
    assert re.search(r"error [\d.]+ px", text)
    page.get_by_role("button", name="Close: Status line").evaluate("button => button.click()")
    assert not page.locator("#status").is_visible()
    page.keyboard.press("i")
    assert page.locator("#status").is_visible()


def test_picture_and_link_can_be_taken_away(open_page):
    page = open_page(permissions=["clipboard-read", "clipboard-write"])
    with page.expect_download() as download:
        page.keyboard.press("s")
    assert download.value.suggested_filename == "A-ball-with-bumps.png"
    data = download.value.path().read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert len(data) > 5000
    page.keyboard.press("l")
    page.wait_for_function("document.querySelector('#toast').textContent.includes('Link copied')")
    link = page.evaluate("navigator.clipboard.readText()")
    assert link == page.url
    assert "c=" in link


def test_link_is_shown_where_it_cannot_be_copied(open_page):
    page = open_page()
    page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(new Error('no')); }")
    page.keyboard.press("l")
    page.wait_for_selector("#link input")
    assert page.input_value("#link input") == page.url
