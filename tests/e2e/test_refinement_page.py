"""What a page with a refinement offers: tools, panel, link, the picture from elsewhere, at every size."""

import numpy as np
import pytest

from e2e.page import idle, picture, stats
from e2e.refined import FRONT, PLAIN, cage, differs, go, press, site, slide

__all__ = ["cage", "site"]  # fixtures: in the place of the static files of the other tests

PHONE = {"viewport": {"width": 360, "height": 640}, "has_touch": True, "is_mobile": True}


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
