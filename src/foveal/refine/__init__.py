"""Refinement that follows the eye: √3 subdivision of a control mesh where it is looked at."""

from .criteria import Criteria, Region
from .rgb import Rgb, rgb
from .rgb_edges import Edges, by_distance, by_length
from .sqrt3 import Sqrt3, Update, sqrt3

__all__ = [
    "Criteria",
    "Edges",
    "Region",
    "Rgb",
    "Sqrt3",
    "Update",
    "by_distance",
    "by_length",
    "rgb",
    "sqrt3",
]
