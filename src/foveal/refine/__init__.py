"""Refinement that follows the eye: √3 subdivision of a control mesh where it is looked at."""

from .criteria import Criteria, Region
from .rgb import Rgb, rgb
from .sqrt3 import Sqrt3, Update, sqrt3

__all__ = ["Criteria", "Region", "Rgb", "Sqrt3", "Update", "rgb", "sqrt3"]
