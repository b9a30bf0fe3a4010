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
