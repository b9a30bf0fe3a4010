"""Refinement that follows the eye: √3 subdivision of a control mesh where it is looked at."""

from .criteria import Criteria, Region
from .hidden import Hidden
from .sqrt3 import Sqrt3, Update, sqrt3

__all__ = ["Criteria", "Hidden", "Region", "Sqrt3", "Update", "sqrt3"]
