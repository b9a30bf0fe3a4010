"""The one script: whose file it shows, where it looks for it, and how it ends."""

import importlib.machinery
import importlib.util
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from foveal.cli.view import view

DO = Path(__file__).parents[2] / "do"


@pytest.fixture
def do():
    loader = importlib.machinery.SourceFileLoader("do_script", str(DO))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("do_script", loader))
    is_silent, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        loader.exec_module(module)
    finally:
        sys.dont_write_bytecode = is_silent
    return module


@pytest.mark.parametrize(
    ("words", "is_dragon"),
    [
        ([], True),
        (["--no-browser"], True),
        (["--port", "9000", "-q"], True),
        (["--step", "0.1", "--memory", "2GB"], True),
        (["--radius-px", "2", "9", "--without", "backs"], True),
        (["--radius-px", "2", "9", "statue.ply"], False),
        (["statue.ply"], False),
        (["--no-browser", "statue.ply"], False),
        (["--port", "9000", "statue.ply"], False),
        (["--port=9000", "statue.ply"], False),
    ],
)
def test_the_dragon_is_shown_where_no_file_is_named(do, monkeypatch, words, is_dragon):
    calls = []
    monkeypatch.setattr(do, "call", lambda *command, **options: calls.append((command, options)))
    do.view(list(words))
    ((_, verb, *rest), options) = calls[0]
    assert verb == "view"
    assert rest == ([str(do.DRAGON)] if is_dragon else []) + words
    assert options["cwd"] == Path.cwd()  # a file is named from where one stands


def test_it_knows_which_options_take_a_value(do):
    flags = {"no_browser", "json", "quiet", "verbose", "debug", "return", "file", "pair_triangles"}
    known = {name.removeprefix("--").replace("-", "_") for name in do.TAKES_A_VALUE}
    assert known == {"bind" if name == "host" else name for name in set(view.__annotations__) - flags}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one child alone")
def test_ctrl_c_lets_the_child_end_in_its_own_time_and_with_its_own_code():
    child = "import time\nprint(1, flush=True)\ntry: time.sleep(30)\n"
    child += "except KeyboardInterrupt: time.sleep(1); exit(7)"
    program = f"import runpy, sys; runpy.run_path({str(DO)!r})['call'](sys.executable, '-c', {child!r})"
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, start_new_session=True, text=True
    )
    assert process.stdout.readline() == "1\n"
    time.sleep(0.2)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does it
    assert process.wait(timeout=30) == 7
    process.stdout.close()
