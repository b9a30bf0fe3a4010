"""What the `foveal` script calls: so little that Ctrl-C during its own imports is met with grace too."""

import signal
import sys
from io import TextIOWrapper
from types import FrameType

__all__ = ["run"]


def run() -> None:
    """Read the command line and do what it says."""
    for name in ("SIGTERM", "SIGHUP"):  # asked to end, or left by its terminal: no scratch is left behind
        number = getattr(signal, name, None)  # Windows has but one of them
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _end)
    for stream in (sys.stdout, sys.stderr):  # a name that cannot be said is spelled, and never an error
        if isinstance(stream, TextIOWrapper):  # None where it is closed
            stream.reconfigure(errors="backslashreplace")
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
