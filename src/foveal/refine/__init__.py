"""Refinement of a control mesh: where it is looked at (√3, RGB), or everywhere (Loop, modified butterfly)."""

from .criteria import Criteria, Region
from .hidden import Hidden
from .rgb import Rgb, rgb
from .rgb_edges import Edges, by_distance, by_length
from .sharp import sharp_edges
from .sqrt3 import Sqrt3, Update, sqrt3
from .uniform import butterfly, loop

__all__ = [
    "Criteria",
    "Edges",
    "Hidden",
    "Region",
    "Rgb",
    "Sqrt3",
    "Update",
    "butterfly",
    "by_distance",
    "by_length",
    "loop",
    "rgb",
    "sharp_edges",
    "sqrt3",
]
