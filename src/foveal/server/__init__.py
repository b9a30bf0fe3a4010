"""HTTP on localhost: byte ranges, the viewer, the scene."""

from .app import create_app
from .run import Running, start

__all__ = ["Running", "create_app", "start"]
