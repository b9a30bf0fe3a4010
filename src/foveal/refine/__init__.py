"""Refinement of a control mesh: where it is looked at (√3, RGB, slates), or everywhere (Loop, butterfly)."""

from .criteria import Criteria, Region
from .extract import front_faces, frustum_faces, silhouette_faces
from .filter import Sqrt3Filter
from .hidden import Hidden
from .rgb import Rgb, rgb
from .rgb_edges import Edges, by_distance, by_length
from .sharp import sharp_edges
from .slates import Slates, slates
from .slates_depth import Depths
from .slates_rate import FrameRate
from .slates_result import SlateArrays, Tessellated
from .sqrt3 import Sqrt3, Update, sqrt3
from .uniform import butterfly, loop

__all__ = [
    "Criteria",
    "Depths",
    "Edges",
    "FrameRate",
    "Hidden",
    "Region",
    "Rgb",
    "SlateArrays",
    "Slates",
    "Sqrt3",
    "Sqrt3Filter",
    "Tessellated",
    "Update",
    "butterfly",
    "by_distance",
    "by_length",
    "front_faces",
    "frustum_faces",
    "loop",
    "rgb",
    "sharp_edges",
    "silhouette_faces",
    "slates",
    "sqrt3",
]
