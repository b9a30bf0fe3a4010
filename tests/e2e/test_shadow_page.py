"""The light of a scene in the page: the CPU's picture, panel and address, what is missing, what moves."""

import numpy as np
import pytest

import foveal
from e2e.lit import PATH, VIEW, lit_scene, yard_files
from e2e.page import idle, picture
from e2e.refined import CRITERIA, differs, go, press, slide
from e2e.static_server import StaticServer
from e2e.test_catmull_clark_page import camera_of
from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh
from foveal.scene.cage_file import write_cage
from foveal.scene.refinement import Refinement

HASH = "#v=1&c=4,4,6,0,0.2,0&u=y&f=38&n=0"
PHONE = {"viewport": {"width": 360, "height": 640}, "has_touch": True, "is_mobile": True}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("yard")
    ball = icosphere(1)
    above = TriMesh.of(ball.positions * 0.5 + np.array([1.6, 1.6, 1.2]), ball.faces)
    write_cage(above, folder / "ball.fov", refinement=Refinement("sqrt3", CRITERIA))
    return {**yard_files(folder), "ball": folder / "ball.fov"}


@pytest.fixture
def site(viewer_folder, files):
    """In the place of the other tests' files: the yard, in sunlight until a test says otherwise."""
    own = {p.relative_to(viewer_folder).as_posix(): p for p in viewer_folder.rglob("*") if p.is_file()}
    server = StaticServer(own)
    server.files |= {"data/yard.fov": files["yard"], "data/ball.fov": files["ball"]}
    server.files |= {"data/light.fov": files["sun"], "scene.json": lit_scene("yard", light={})}
    yield server
    server.close()


def behind(page):
    """The picture behind the panel, which is closed for it."""
    page.keyboard.press("Escape")
    idle(page)
    pixels = picture(page)
    page.keyboard.press("d")
    return pixels


def strip(page):
    page.wait_for_selector(".strip")
    return page.inner_text(".strip p")


FILTERS = {"hard": "hard", "3x3": "pcf3", "5x5": "pcf5", "soft": "soft"}


@pytest.mark.timeout(600)  # the first waits for kernels and shadow maps
@pytest.mark.parametrize(
    ("light", "chosen"),
    [("sun", "hard"), ("sun", "5x5"), ("spot", "3x3"), ("point", "3x3"), ("area", "soft"), ("path", "3x3")],
)
def test_the_page_draws_shadows_as_the_cpu_does(open_page, site, files, light, chosen):
    site.files["data/light.fov"] = files[light]
    page = open_page(f"{HASH}&h={chosen},{PATH.times[2]:%H:%M}")
    go(page, VIEW)
    seen = picture(page).astype(int)
    expected = foveal.render(
        files["yard"],
        camera=camera_of(VIEW),
        shadow=files[light],
        shadow_filter=FILTERS[chosen],
        shadow_image=2 if light == "path" else 0,
    )
    expected = np.asarray(expected)[..., :3].astype(int)
    is_model = seen.max(axis=2) > 0
    assert (np.abs(seen - expected).max(axis=2)[is_model] > 24).sum() <= 0.02 * is_model.size
    unlit = np.asarray(foveal.render(files["yard"], camera=camera_of(VIEW)))[..., :3]
    assert (np.abs(seen - unlit).max(axis=2)[is_model] > 24).sum() > 0.03 * is_model.size


def test_the_panel_turns_the_light_off_and_on_and_chooses_edges(open_page):
    page = open_page(HASH)
    lit = picture(page)
    page.keyboard.press("d")
    assert page.locator("#light").is_visible()
    page.get_by_label("The scene's own light").uncheck()
    assert differs(lit, behind(page)) > 0.1
    page.get_by_label("The scene's own light").check()
    page.select_option("#set-filter", "hard")
    assert 0 < differs(lit, behind(page)) < 0.05
    names = ["Hard", "3 × 3 pixels", "5 × 5 pixels", "Smooth"]
    assert page.locator("#set-filter option").all_inner_texts() == names
    page.wait_for_function("location.hash.includes('h=hard')")
    page.get_by_role("button", name="Back to the scene's own").click()
    assert differs(lit, behind(page)) == 0


def test_a_slider_is_the_time_of_day(open_page, site, files):
    site.files["data/light.fov"] = files["path"]
    page = open_page(HASH)
    noon = picture(page)
    page.keyboard.press("d")
    assert "21 June 2026, 09:00 to 18:00" in page.inner_text("#light .about")
    slide(page, "time", 500)  # minutes after nine
    assert page.inner_text("output[for=set-time]") == "17:20"
    evening = behind(page)
    assert differs(noon, evening) > 0.05
    page.focus("#set-time")
    page.keyboard.press("ArrowLeft")
    page.wait_for_function("location.hash.includes('h=17:19')")
    slide(page, "time", 500)
    page.wait_for_function("location.hash.includes('h=17:20')")
    again = open_page(page.evaluate("location.hash"))
    assert differs(picture(again), evening) < 1e-3


def test_the_panel_fits_a_phone_and_leaves_the_picture_in_sight(open_page, site, files):
    site.files["data/light.fov"] = files["path"]
    page = open_page(HASH, **PHONE)
    page.get_by_role("button", name="Light and shadows").tap()
    box = page.locator("#light").bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= 360
    assert box["height"] <= 0.6 * 640
    for control in page.locator("#light input, #light select").all():
        inner = control.bounding_box()
        assert inner["x"] + inner["width"] <= box["x"] + box["width"]


def test_a_scene_is_there_without_its_light(open_page, site):
    del site.files["data/light.fov"]
    page = open_page(HASH, allow=("404",))
    assert "light.fov is not there" in strip(page)
    assert picture(page).max() > 100


def test_a_damaged_light_is_told_and_what_came_before_is_shown(open_page, site, files):
    size = files["sun"].stat().st_size
    flip = bytes([255])

    def spoil(address, start, data):
        at = size - 5 - start
        is_hit = address == "data/light.fov" and 0 <= at < len(data)
        return (
            data[:at] + (flip if data[at : at + 1] != flip else b"\\0") + data[at + 1 :] if is_hit else data
        )

    site.spoil = spoil
    page = open_page(HASH)
    assert "light.fov" in strip(page)
    spoilt = picture(page)
    site.spoil = lambda address, start, data: data
    page.get_by_role("button", name="Try again").click()
    page.wait_for_function("!document.querySelector('.strip')")
    idle(page)
    assert differs(picture(page), spoilt) < 0.2
    assert differs(picture(open_page(HASH + "&h=off")), spoilt) > 0.05


def test_what_moves_casts_by_an_ordinary_map_and_is_cast_on(open_page, site):
    site.files["scene.json"] = lit_scene("yard", "ball", light={})
    without = picture(open_page(HASH))
    site.files["scene.json"] = lit_scene("yard", "ball", light={"moving": ["ball"]})
    page = open_page(HASH)
    cast = picture(page)
    darker = without.astype(int).sum(axis=2) - cast.astype(int).sum(axis=2) > 60
    assert 0.005 < darker.mean() < 0.1
    page.keyboard.press("o")
    page.get_by_label("ball").uncheck()
    page.keyboard.press("Escape")
    idle(page)
    gone = picture(page)
    # where the ball itself was not seen, its shadow went with it
    assert (differs(gone, cast)) > 0.01
    press(page, "d")
    assert page.locator("#light").is_visible()
