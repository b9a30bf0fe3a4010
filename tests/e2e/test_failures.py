"""What goes wrong is said in a sentence, and what can still be shown is shown."""

import struct

import pytest

from e2e.page import idle, stats

CAMERA = {"position": [0.3, 0.2, 1.25], "target": [0.1, 0.1, 0.9], "up": [0, 1, 0], "fieldOfViewDegrees": 40}


def sentence(page):
    page.wait_for_selector("#alerts p")
    assert page.get_attribute("#alerts", "role") == "alert"
    return page.inner_text("#alerts p")


def fails(open_page):
    page = open_page(is_ready=False, errors_wanted=True)
    text = sentence(page)
    assert page.evaluate("foveal.ready.then(() => '', error => error.message)") == text
    assert page.inner_text("#alerts button") == "Try again"
    return text


def test_server_without_ranges(open_page, site):
    site.has_ranges = False
    page = open_page()
    assert stats(page)["isWholeFile"]
    assert stats(page)["errorPx"] <= 1
    assert "whole file" in page.inner_text("#toast")
    assert [address for address, _ in site.requests].count("data/ball.fov") == 1


def test_missing_file(open_page, site):
    del site.files["data/ball.fov"]
    assert "ball.fov is not there" in fails(open_page)


def test_missing_scene(open_page, site):
    del site.files["scene.json"]
    assert "scene.json is not there" in fails(open_page)


@pytest.mark.parametrize("text", [b"", b"{}", b"<html>", b'{"version": 9, "layers": [{"asset": "a"}]}'])
def test_scene_that_is_none(open_page, site, text):
    site.files["scene.json"] = text
    assert "scene.json" in fails(open_page)


def test_something_that_is_no_fov(open_page, site):
    site.files["data/ball.fov"] = b"ply\nformat ascii 1.0\n" * 5000
    assert "not a .fov" in fails(open_page)


def test_empty_file(open_page, site):
    site.files["data/ball.fov"] = b""
    assert "not a .fov" in fails(open_page)


def test_newer_version(open_page, site, ball_file):
    data = bytearray(ball_file.read_bytes())
    struct.pack_into("<H", data, 4, 2)
    site.files["data/ball.fov"] = bytes(data)
    assert "version 2" in fails(open_page)


def test_damaged_header(open_page, site, ball_file):
    data = bytearray(ball_file.read_bytes())
    data[40] ^= 1
    site.files["data/ball.fov"] = bytes(data)
    assert "damaged" in fails(open_page)


def test_file_that_was_cut(open_page, site, ball_file):
    site.files["data/ball.fov"] = ball_file.read_bytes()[:-1000]
    assert "not copied whole" in fails(open_page)


def test_no_webgl2(browser, site, open_page):
    page = open_page(is_ready=False, errors_wanted=True)
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.reload()
    assert "WebGL2" in sentence(page)


def test_damaged_part_is_left_out_and_told(open_page, site):
    """The last quarter of the file always arrives wrong; the rest is shown."""
    sound = int(0.75 * len(site.read("data/ball.fov")))

    def spoil(address, start, data):
        if not address.endswith(".fov"):
            return data
        return bytes(byte ^ 255 if start + i > sound else byte for i, byte in enumerate(data))

    site.spoil = spoil
    page = open_page("#v=1&e=0.1")
    page.evaluate("camera => foveal.setCamera(camera)", CAMERA)
    assert "ball.fov" in sentence(page)
    idle(page)
    assert stats(page)["patches"] > 0
    site.spoil = lambda address, start, data: data
    coarse = stats(page)["errorPx"]
    page.click("#alerts button:has-text('Try again')")
    idle(page)
    assert stats(page)["errorPx"] < coarse


def test_one_wrong_answer_is_asked_for_again_without_a_word(open_page, site):
    spoiled = []

    def spoil(address, start, data):
        if address.endswith(".fov") and start > 0 and not spoiled:
            spoiled.append(start)
            return bytes(len(data))
        return data

    site.spoil = spoil
    page = open_page("#v=1&e=0.1")
    assert spoiled
    assert stats(page)["errorPx"] < 1
    assert page.locator("#alerts *").count() == 0


def test_file_replaced_while_it_is_read(open_page, site, ball_file):
    site.delay = 0.02
    page = open_page("#v=1&e=16")
    data = bytearray(ball_file.read_bytes())
    data[-1] ^= 1
    site.files["data/ball.fov"] = bytes(data)
    page.evaluate("camera => { foveal.setErrorPx(0.1); foveal.setCamera(camera); }", CAMERA)
    assert "was replaced" in sentence(page)
    assert stats(page)["patches"] > 0


def test_graphics_lost_and_given_back(open_page):
    page = open_page()
    before = stats(page)
    page.evaluate("""() => {
      const context = document.querySelector("#picture").getContext("webgl2");
      window.lost = context.getExtension("WEBGL_lose_context");
      window.lost.loseContext();
    }""")
    assert "graphics were lost" in sentence(page)
    page.evaluate("window.lost.restoreContext()")
    page.wait_for_selector("#alerts .strip", state="detached")
    page.wait_for_function("foveal.stats().patches > 0 && foveal.stats().inFlight === 0")
    idle(page)
    after = stats(page)
    assert after["triangles"] == before["triangles"]
    assert after["errorPx"] == before["errorPx"]
