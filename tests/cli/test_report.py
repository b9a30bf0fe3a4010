"""What the person sees: bars on a terminal, lines in a log, JSON that any program reads."""

import io
import json
import math
import sys

import numpy as np

from foveal.cli.report import reporter
from foveal.cli.result import print_json


class Terminal(io.StringIO):
    def isatty(self):
        return True


def work(progress):
    with progress.stage("simplifying", 3.0) as stage:
        for _ in range(3):
            stage.advance(1.0)
    progress.note("two holes [were] closed")


def test_lines_where_there_is_no_terminal(monkeypatch, capsys):
    clock = iter(range(0, 1000, 10))
    monkeypatch.setattr("time.monotonic", lambda: next(clock))
    with reporter(is_quiet=False, is_verbose=True) as progress:
        work(progress)
    out, error = capsys.readouterr()
    assert out == ""
    assert error.splitlines() == [
        "simplifying ...",
        "simplifying: 33 %, about 20 s left",
        "simplifying: 67 %, about 10 s left",
        "simplifying: 100 %, about 0 s left",
        "simplifying: 40.0 s",
        "two holes [were] closed",
    ]


def test_bars_on_a_terminal(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    with reporter(is_quiet=False, is_verbose=True) as progress:
        work(progress)
    assert "simplifying" in terminal.getvalue()
    assert "100%" in terminal.getvalue()
    assert "two holes [were] closed" in terminal.getvalue()


def test_nothing_when_quiet(capsys):
    with reporter(is_quiet=True, is_verbose=True) as progress:
        work(progress)
    assert capsys.readouterr() == ("", "")


def test_json_is_json_for_everybody(capsys):
    print_json({"a": np.float64(1.5), "b": np.arange(2), "c": math.inf, 3: (None, True), "d": np.bool_(True)})
    assert json.loads(capsys.readouterr().out) == {
        "a": 1.5,
        "b": [0, 1],
        "c": None,
        "3": [None, True],
        "d": True,
    }
