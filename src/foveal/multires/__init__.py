"""Multiresolution meshes: partition, simplify, bound, encode; and reading what was built."""

from .build import BuildReport, build
from .check import CheckReport, check
from .read import Multires, extract
from .read import open_multires as open
from .source import source_of

__all__ = ["BuildReport", "CheckReport", "Multires", "build", "check", "extract", "open", "source_of"]
