"""What the `foveal` script calls: so little that Ctrl-C during its own imports is met with grace too."""

import os
import signal
import sys
import threading
from io import TextIOWrapper
from types import FrameType

from . import interrupts

__all__ = ["run"]


def run() -> None:
    """Read the command line and do what it says."""
    for name in ("SIGTERM", "SIGHUP"):  # asked to end, or left by its terminal: no scratch is left behind
        number = getattr(signal, name, None)  # Windows has but one of them
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _end)
    interrupts.listen()
    for stream in (sys.stdout, sys.stderr):  # a name that cannot be said is spelled, and never an error
        if isinstance(stream, TextIOWrapper):  # None where it is closed
            stream.reconfigure(errors="backslashreplace")
    try:
        _run()
    except SystemExit as end:
        if any(thread.name == "foveal-apart" for thread in threading.enumerate()):
            _leave(end.code)
        raise


def _run() -> None:
    try:
        from .app import app

        app(prog_name="foveal")
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        # An interrupt within exec of a string (dataclasses and Numba use it) leaves a mark by which CPython
        # ends itself with SIGINT whatever the exit code is; the next such exec takes the mark away.
        exec("")


def _end(number: int, frame: FrameType | None) -> None:
    sys.exit(128 + number)


def _leave(code: object) -> None:
    """End though a kernel, or the compiler, still runs for who was interrupted (see `scene/apart.py`).

    It writes nothing; but LLVM is not to be taken down under a thread that compiles.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code if isinstance(code, int) else int(code is not None))
