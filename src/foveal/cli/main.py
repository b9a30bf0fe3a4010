"""What the `foveal` script calls: so little that Ctrl-C during its own imports is met with grace too."""

import sys

__all__ = ["run"]


def run() -> None:
    """Read the command line and do what it says."""
    try:
        from .app import app

        app(prog_name="foveal")
    except KeyboardInterrupt:
        sys.exit(130)
    finally:
        # An interrupt within exec of a string (dataclasses and Numba use it) leaves a mark by which CPython
        # ends itself with SIGINT whatever the exit code is; the next such exec takes the mark away.
        exec("")
