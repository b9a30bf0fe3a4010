"""Refinement of a control mesh: where it is looked at (√3, RGB), or everywhere (Loop, modified butterfly)."""

from .criteria import Criteria, Region
from .extract import front_faces, frustum_faces, silhouette_faces
from .filter import Sqrt3Filter
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
    "Sqrt3Filter",
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
    "sqrt3",
]
