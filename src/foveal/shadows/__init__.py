"""Precomputed shadows: a depth map of any resolution as a tree of few values, lossless for every shadow test.

Based on: Scandolo, Bauszat, Eisemann. Compressed Multiresolution Hierarchies for High-Quality Precomputed
Shadows. Computer Graphics Forum 2016.
"""

from .build import build, intervals
from .light import AreaLight, Directional, Light, Point, Spot, Sun, SunPath, light_from_json
from .projection import Projection
from .shadow_map import ShadowMap
from .tree import Tree

__all__ = [
    "AreaLight",
    "Directional",
    "Light",
    "Point",
    "Projection",
    "ShadowMap",
    "Spot",
    "Sun",
    "SunPath",
    "Tree",
    "build",
    "intervals",
    "light_from_json",
]
