"""A `.fov` made by hand: three nodes over three levels, so that every number can be worked out."""

import numpy as np
import pytest

from foveal.base.progress import SILENT
from foveal.container import create


def write_fov(path, **header):
    """Node 0 shows 10 + 20 triangles; node 1 refines the first patch by 40; node 2 that one by 90."""
    columns = [
        np.array([0, 2, 3, 4], "<u4"),
        np.array([[0, 0, 0, 9]] * 3, "<f4"),
        np.array([np.inf, 0.5, 0.25], "<f4"),
        np.array([1, -1, 2, -1], "<i4"),
        np.array([10, 20, 40, 90], "<u4"),
        np.array([8, 12, 25, 50], "<u4"),
        np.array([5, 6, 7, 9], "<u4"),
    ]
    facts = {
        "origin": [100.0, 0.0, 0.0],
        "step": 0.5,
        "box": [[0, 0, 0], [4, 8, 2]],
        "up": "z",
        "triangles": 110,
        "vertices": 62,
        "nodes": 3,
        "patches": 4,
        "levels": 3,
        "streams": [{"name": "position", "type": "grid3"}, {"name": "colour", "type": "srgb8"}],
        "codec": "by hand",
    }
    with create(path, kind="multires", version=1) as writer:
        for length in (11, 7, 9):
            writer.add_chunk(bytes(length))
        writer.finish({**facts, **header}, b"".join(column.tobytes() for column in columns))
    return path


@pytest.fixture
def fov(tmp_path):
    return write_fov(tmp_path / "statue.fov")


@pytest.fixture
def make_fov():
    return write_fov


@pytest.fixture
def viewer(tmp_path):
    folder = tmp_path / "viewer"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<!doctype html><title>foveal</title>")
    (folder / "assets" / "index-0a1B2c3D.js").write_text("1")
    (folder / ".hidden").write_text("a secret")
    (folder / "bundle.json").write_text("{}")
    return folder


class Notes:
    """What a person is told, in `said`."""

    def __init__(self):
        self.said = []

    def stage(self, what, total):
        return SILENT.stage(what, total)

    def note(self, sentence):
        self.said.append(sentence)


@pytest.fixture
def notes():
    return Notes()
