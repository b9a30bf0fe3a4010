"""Ctrl-C that something else swallowed."""

import signal
import sys

import pytest

from foveal.cli import interrupts
from foveal.cli.report import reporter


@pytest.fixture
def swallowed(monkeypatch):
    """An interrupt that fell where errors are printed only."""
    monkeypatch.setattr(interrupts, "_noted", [])
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(sys, "unraisablehook", lambda _: None)

    class Module:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)

    def swallow():
        interrupts.listen()
        Module()

    yield swallow
    signal.signal(signal.SIGINT, before)


def test_it_is_heeded_when_the_next_stage_begins(swallowed):
    with pytest.raises(KeyboardInterrupt), reporter(is_quiet=True, is_verbose=False) as progress:
        with progress.stage("one", 1):
            swallowed()
        progress.stage("two", 1)
        raise AssertionError("it went on")


def test_it_is_heeded_when_the_last_stage_ends(swallowed):
    is_heeded = False
    try:
        with reporter(is_quiet=False, is_verbose=False) as progress, progress.stage("one", 1):
            swallowed()
    except KeyboardInterrupt:
        is_heeded = True
    assert is_heeded


def test_an_error_that_comes_of_it_is_not_told(swallowed, monkeypatch, run, tmp_path):
    def compiled(*_, **__):
        swallowed()
        raise RuntimeError("no compiled object yet")

    monkeypatch.setattr("foveal.info", compiled)
    with pytest.raises(KeyboardInterrupt):  # of which `main.run` makes the exit code
        run("info", tmp_path)


def test_who_ignores_interrupts_is_left_alone(monkeypatch):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        interrupts.listen()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
    interrupts.heed()
