"""What a command may import: waiting for libraries that it does not use is what makes tools feel slow."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from foveal.container import create

SOURCE = Path(__file__).parents[2] / "src"
HEAVY = {"numba", "scipy", "trimesh", "starlette", "uvicorn", "rich", "fsspec", "PIL", "distributed"}


def imported_by(code: str) -> set[str]:
    """The top-level modules in memory after `code`."""
    program = (
        f"import sys\ntry:\n    {code}\nfinally:\n    print('\\n' + ' '.join(sys.modules), file=sys.stderr)"
    )
    child = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(SOURCE)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert child.returncode == 0, child.stderr
    return {name.partition(".")[0] for name in child.stderr.splitlines()[-1].split()}


@pytest.mark.parametrize("words", [["--help"], ["build", "--help"], ["--version"]])
def test_help_needs_no_numbers(words):
    found = imported_by(f"from foveal.cli.main import run; sys.argv = ['foveal', *{words!r}]; run()")
    assert not found & (HEAVY | {"numpy"})


def test_import_foveal_is_next_to_nothing():
    assert not imported_by("import foveal") & (HEAVY | {"numpy"})


def test_info_compiles_nothing(tmp_path):
    import numpy as np

    graph = [
        np.array([0, 1], "<u4"),
        np.zeros(4, "<f4"),
        np.array([np.inf], "<f4"),
        np.array([-1], "<i4"),
        np.array([1, 3, 4], "<u4"),
    ]
    header = {
        **{"origin": [0, 0, 0], "step": 1.0, "box": [[0, 0, 0], [1, 1, 1]], "nodes": 1, "patches": 1},
        **{"triangles": 1, "vertices": 3, "streams": [{"name": "position"}], "codec": "none"},
    }
    path = tmp_path / "one.fov"
    with create(path, kind="multires", version=1) as writer:
        writer.add_chunk(b"four")
        writer.finish(header, b"".join(column.tobytes() for column in graph))
    code = f"from foveal.cli.main import run; sys.argv = ['foveal', 'info', {str(path)!r}]; run()"
    assert not imported_by(code) & HEAVY


def test_info_of_shadows_compiles_nothing(tmp_path):
    path = tmp_path / "shadow.fov"
    facts = {"levels": 1, "images": 1, "projections": [[]], "light": {"kind": "point"}}
    with create(path, kind="shadow", version=1) as writer:
        writer.finish(facts | {"nodes": {"leaf": 1, "empty": 0, "inner": 0}}, b"counts")
    code = f"from foveal.cli.main import run; sys.argv = ['foveal', 'info', {str(path)!r}]; run()"
    assert not imported_by(code) & HEAVY


def test_serving_compiles_nothing():
    assert not imported_by("import foveal.server") & (HEAVY - {"starlette", "uvicorn"})
