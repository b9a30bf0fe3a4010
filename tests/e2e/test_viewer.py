"""The viewer draws a `.fov` by view: cuts, budgets, requests, pictures."""

import numpy as np
import pytest

from e2e.page import build, coloured_ball, idle, picture, scene_of, stats
from foveal.container import open_container

NEAR = {"position": [0.3, 0.2, 1.25], "target": [0.1, 0.1, 0.9], "up": [0, 1, 0], "fieldOfViewDegrees": 40}
FAR = {"position": [0, 0, 60], "target": [0, 0, 0], "up": [0, 1, 0], "fieldOfViewDegrees": 40}
FRONT = {"position": [0, 0, 4], "target": [0, 0, 0], "up": [0, 1, 0], "fieldOfViewDegrees": 40}


def go(page, camera):
    page.evaluate("camera => foveal.setCamera(camera)", camera)
    idle(page)
    return stats(page)


def test_shows_the_model_and_refines_to_the_error_asked_for(open_page, site):
    page = open_page()
    shown = stats(page)
    assert shown["patches"] > 0
    assert shown["errorPx"] <= shown["targetPx"] == 1
    assert shown["moments"]["firstPicture"] <= shown["moments"]["firstSettled"]
    assert page.title() == "A ball with bumps"
    assert shown["receivedBytes"] <= shown["allBytes"] + 65536
    assert site.most_at_once <= 6


def test_detail_is_where_one_looks(open_page):
    page = open_page()
    far = go(page, FAR)
    near = go(page, NEAR)
    assert far["triangles"] < 3000
    assert near["triangles"] > far["triangles"]
    assert max(far["errorPx"], near["errorPx"]) <= 1
    again = go(page, FAR)
    assert again["triangles"] == far["triangles"]
    assert again["receivedBytes"] == near["receivedBytes"]  # what is cached is not fetched again


def test_no_frame_is_drawn_while_nothing_changes(open_page):
    page = open_page()
    page.wait_for_timeout(700)  # the address is written, the status line too
    before = stats(page)["frames"]
    page.wait_for_timeout(500)
    assert stats(page)["frames"] == before


def test_budgets_hold(open_page):
    page = open_page()
    go(page, NEAR)
    full = stats(page)
    page.evaluate("foveal.setErrorPx(0.1); foveal.setBudgets({ triangles: 4000 })")
    idle(page)
    few = stats(page)
    assert few["triangles"] <= 4000
    assert few["errorPx"] > 0.1
    budget = full["cacheBytes"] // 3
    page.evaluate("bytes => foveal.setBudgets({ triangles: 1e6, bytes })", budget)
    for camera in (FRONT, NEAR, FRONT, NEAR):
        tight = go(page, camera)
        assert tight["patches"] > 0
        assert tight["cacheBytes"] <= budget
    requests = tight["receivedBytes"]
    idle(page)
    assert stats(page)["receivedBytes"] == requests  # at the limit nothing comes and goes


def test_nothing_grows_over_many_views(open_page, ball_file):
    with open_container(ball_file) as file:
        patches = file.header["patches"]
    page = open_page()
    cached = []
    for _ in range(6):
        for camera in (FAR, NEAR, FRONT):
            go(page, camera)
        cached.append(stats(page)["cacheBytes"])
    assert cached[1:] == cached[:1] * 5
    assert stats(page)["gpu"]["geometries"] <= patches + 4  # each at most once, and the page's own
    page.evaluate("foveal.setBudgets({ bytes: 1e5 })")
    go(page, FAR)
    assert stats(page)["gpu"]["geometries"] < patches / 2
    assert stats(page)["cacheBytes"] <= 1e5


def test_no_hole_while_detail_arrives(open_page, site):
    site.delay = 0.05
    page = open_page("#v=1&b=black&i=0&e=0.5", is_ready=False)
    page.evaluate("foveal.ready")
    page.evaluate("camera => foveal.setCamera(camera)", FRONT)
    rows, columns = np.mgrid[0:480, 0:640]
    inside = np.hypot(rows - 240, columns - 320) < 120  # well within the ball, which is closed
    pictures = 0
    while pictures < 40:
        is_idle = page.evaluate(
            "Promise.race([foveal.idle().then(() => true), new Promise(r => setTimeout(r, 30, false))])"
        )
        seen = picture(page)
        assert seen[inside].min(axis=0).max() > 30, "the black background shows through"
        pictures += 1
        if is_idle and pictures > 3:
            break
    assert stats(page)["errorPx"] <= 0.5


def test_the_picture_is_the_same_far_from_the_origin(open_page, site, tmp_path):
    """UTM-like coordinates: no jitter, no shift."""
    shift = np.array([500_000.0, 4_800_000.0, 100.0])
    pictures = []
    for number, offset in enumerate((np.zeros(3), shift)):
        site.files["data/ball.fov"] = build(coloured_ball(offset), tmp_path / f"{number}.fov")
        page = open_page("#v=1&b=black")
        camera = FRONT | {key: (np.array(FRONT[key]) + offset).tolist() for key in ("position", "target")}
        go(page, camera)
        pictures.append(picture(page).astype(int))
    differing = np.abs(pictures[0] - pictures[1]).max(axis=2) > 16
    assert differing.mean() < 0.01
    assert (pictures[0].max(axis=2) > 30).mean() > 0.1


def test_two_layers_share_the_budgets(open_page, site, tmp_path):
    site.files["data/other.fov"] = build(coloured_ball((2.5, 0, 0)), tmp_path / "other.fov")
    site.files["scene.json"] = scene_of("data/ball.fov", "data/other.fov")
    page = open_page()
    both = stats(page)
    assert both["errorPx"] <= 1
    page.evaluate("foveal.setBudgets({ triangles: 5000 })")
    idle(page)
    assert 0 < stats(page)["triangles"] <= 5000
    hidden = open_page("#v=1&l=1")
    assert 0 < stats(hidden)["triangles"] < both["triangles"]


def test_no_shader_is_left_for_the_first_gesture_to_make(open_page):
    page = open_page()
    programs = stats(page)["gpu"]["programs"]
    page.mouse.move(320, 240)
    page.mouse.wheel(0, -200)
    idle(page)
    page.mouse.dblclick(300, 220)
    idle(page)
    assert stats(page)["gpu"]["programs"] == programs


@pytest.mark.parametrize("motion", ["no-preference", "reduce"])
def test_reduced_motion_has_no_flights(open_page, motion):
    page = open_page(reduced_motion=motion)
    before = stats(page)["frames"]
    page.keyboard.press("ArrowLeft")
    idle(page)
    camera = page.evaluate("foveal.getState().camera.position")
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    idle(page)
    np.testing.assert_allclose(page.evaluate("foveal.getState().camera.position"), camera, atol=1e-3)
    assert stats(page)["frames"] > before
