"""A Chromium, the built viewer, a small scene and a server for it."""

import importlib.util
import os
import shutil
from pathlib import Path

import pytest

from e2e.page import build, coloured_ball, scene_of
from e2e.static_server import StaticServer

ROOT = Path(__file__).parents[2]
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]
#: Machines that only test are slow and shared; what waits, waits for a state of the page, not for a time.
PATIENCE_MS = 40_000


def pytest_collection_modifyitems(items):
    """All tests of this folder need a browser."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.browser)
            item.add_marker(pytest.mark.timeout(180))  # a page that never rests shall not hold up the rest


@pytest.fixture(scope="module")
def browser():
    """For one file only: while Playwright is open, no other test of the thread can run an event loop."""
    program = next((found for name in NAMES if (found := shutil.which(name))), None)
    if program is None:
        sentence = "No Chromium was found, so the viewer is not tested. Install Debian's package chromium."
        if os.environ.get("CI") == "true":
            pytest.fail(sentence)
        pytest.skip(sentence)
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def viewer_folder():
    """The bundle, made anew if its sources are newer."""
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    hatch_build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hatch_build)
    hatch_build.build_viewer()
    return ROOT / "src" / "foveal" / "viewer"


@pytest.fixture(scope="session")
def ball_file(tmp_path_factory):
    return build(coloured_ball(), tmp_path_factory.mktemp("ball") / "ball.fov")


VIEWS = [
    {"name": "Front", "camera": {"position": [0, 0, 4], "target": [0, 0, 0]}},
    {"name": "Close", "camera": {"position": [0.6, 0.5, 1.5], "target": [0.2, 0.2, 0.9]}},
]


@pytest.fixture
def site(viewer_folder, ball_file):
    """The viewer with the ball; a test may change what the server does."""
    files = {p.relative_to(viewer_folder).as_posix(): p for p in viewer_folder.rglob("*") if p.is_file()}
    files["scene.json"] = scene_of("data/ball.fov", views=VIEWS)
    files["data/ball.fov"] = ball_file
    server = StaticServer(files)
    yield server
    server.close()


@pytest.fixture
def open_page(browser, site):
    """Open the viewer in a context of its own; fails the test for console errors and foreign addresses.

    `open_page(fragment, allow=(), is_ready=True, **context)`: `allow` are parts of console errors that
    the test provokes.
    """
    contexts, complaints = [], []

    def open_it(fragment="", *, allow=(), is_ready=True, errors_wanted=False, **options):
        # the policy of foveal's own server forbids what waiting for a state of the page needs
        own = {"viewport": {"width": 640, "height": 480}, "bypass_csp": True}
        context = browser.new_context(**{**own, **options})
        contexts.append(context)
        context.set_default_timeout(PATIENCE_MS)
        page = context.new_page()

        def complain(text):
            if not errors_wanted and not any(part in text for part in allow):
                complaints.append(text)

        def guard(route):
            if route.request.url.startswith((site.url, "data:", "blob:")):
                route.continue_()
            else:
                complaints.append(f"foreign address: {route.request.url}")
                route.abort()

        page.on("pageerror", lambda error: complain(str(error)))
        page.on("console", lambda message: message.type == "error" and complain(message.text))
        context.route("**/*", guard)
        page.goto(site.url + fragment)
        if is_ready:
            page.wait_for_function("document.documentElement.dataset.phase !== undefined")
            page.evaluate("foveal.ready")
            page.evaluate("foveal.idle()")
        return page

    yield open_it
    for context in contexts:
        context.close()
    assert complaints == []
