"""The built viewer: all local, small, and shown by foveal's own server."""

import re

from e2e.page import stats
from foveal.scene import scene_of
from foveal.server import start


def test_bundle_names_no_host_to_fetch_from(viewer_folder):
    page = (viewer_folder / "index.html").read_text()
    assert not re.search(r"""(?:src|href)=["'](?:https?:)?//""", page)
    for file in viewer_folder.rglob("*.css"):
        assert "http" not in file.read_text()
    for file in viewer_folder.rglob("*.js"):
        assert not re.search(r"""(?:fetch|import|Worker|importScripts)\(\s*["'`]https?:""", file.read_text())


def test_every_file_is_relative_and_the_scripts_are_hashed(viewer_folder):
    page = (viewer_folder / "index.html").read_text()
    links = re.findall(r"""(?:src|href)=["']([^"']+)["']""", page)
    assert links
    assert all(link.startswith(("./", "data:")) for link in links)
    names = [file.name for file in (viewer_folder / "assets").iterdir()]
    assert all(re.fullmatch(r".*-[A-Za-z0-9_-]{8}\.[a-z]+", name) for name in names)


def test_first_load_is_small(viewer_folder):
    import gzip

    size = sum(len(gzip.compress(f.read_bytes())) for f in viewer_folder.rglob("*.js"))
    assert size < 260_000


def test_with_the_projects_own_server(browser, ball_file, viewer_folder):
    errors = []
    with start(scene_of(ball_file, title="Ball"), port=0) as server:
        page = browser.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: message.type == "error" and errors.append(message.text))
        page.goto(server.url)
        page.evaluate("foveal.ready")
        page.evaluate("foveal.idle()")
        shown = stats(page)
        page.close()
    assert shown["errorPx"] <= 1
    assert not shown["isWholeFile"]
    assert errors == []
