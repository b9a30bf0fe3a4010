"""Commands run in this process, which is quick, or as a process of their own, which is the truth."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import foveal
from foveal.base.jit import cache_folder
from foveal.cli.app import app
from foveal.mesh.io import write_ply
from foveal.mesh.shapes import bumpy_sphere

SOURCE = Path(foveal.__file__).parents[1]


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setattr("foveal.scene.prepare.cache_folder", lambda: tmp_path / "cache")


@pytest.fixture
def run():
    """`run("info", path)` gives exit code, stdout and stderr."""

    def call(*words):
        return CliRunner().invoke(app, [str(word) for word in words])

    return call


@pytest.fixture
def environment(tmp_path):
    # The user's cache is the test's own; the machine code is not, since making it takes half a minute.
    kept = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    (tmp_path / "tmp").mkdir(exist_ok=True)
    return {
        **kept,
        "PYTHONPATH": str(SOURCE),
        "XDG_CACHE_HOME": str(tmp_path / "user-cache"),
        "NUMBA_CACHE_DIR": str(cache_folder.parent),
        "TMPDIR": str(tmp_path / "tmp"),
        "PYTHONUNBUFFERED": "1",
    }


@pytest.fixture
def spawn(environment, tmp_path):
    """A command as a process, not waited for."""
    children = []

    def call(*words):
        # A signal may come between the opening of a file and the block that closes it, within Python's own
        # import; what is then closed late is told of only under `-W error`, and no user runs that.
        warnings = ["-W", "error", "-W", "ignore::ResourceWarning"]
        command = [sys.executable, *warnings, "-m", "foveal", *map(str, words)]
        pipe = subprocess.PIPE
        child = subprocess.Popen(command, env=environment, cwd=tmp_path, stdout=pipe, stderr=pipe, text=True)
        children.append(child)
        return child

    yield call
    for child in children:
        if child.poll() is None:
            child.kill()
        child.communicate()


@pytest.fixture(scope="session")
def ball_mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("meshes") / "ball.ply"
    write_ply(bumpy_sphere(4), path)
    return path


@pytest.fixture(scope="session")
def ball(ball_mesh):
    path = ball_mesh.with_suffix(".fov")
    assert CliRunner().invoke(app, ["build", str(ball_mesh), "-o", str(path)]).exit_code == 0
    return path
