"""The Python of the documentation runs as it stands, block after block of a page."""

import re
from pathlib import Path

import pytest

from foveal.mesh.io import write_ply
from foveal.mesh.shapes import bumpy_sphere

ROOT = Path(__file__).parents[2]
PAGES = [
    page
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
    if "```python" in page.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_documented_python_runs(page, tmp_path, monkeypatch):
    shown = []
    (tmp_path / "viewer").mkdir()
    (tmp_path / "viewer" / "index.html").write_text("<!doctype html>")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("foveal.scene.viewer_files._BUILT", tmp_path / "viewer")
    monkeypatch.setattr("foveal.scene.prepare.cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setattr("foveal.server.view.can_open_browser", lambda: False)
    monkeypatch.setattr("foveal.server.view.start", lambda scene, **_: shown.append(scene))
    write_ply(bumpy_sphere(4), tmp_path / "statue.ply")
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
    names = {}
    for block in blocks:
        exec(compile(block, page.name, "exec"), names)
    assert len(shown) == sum("\nfoveal.view(" in block for block in blocks)
