"""Precomputed shadows: a depth map of any resolution as a tree of few values, lossless for every shadow test.

Based on: Scandolo, Bauszat, Eisemann. Compressed Multiresolution Hierarchies for High-Quality Precomputed
Shadows. Computer Graphics Forum 2016.
"""

from .pack import Packed, pack
from .projection import Projection
from .shadow_map import ShadowMap
from .tree import Tree

__all__ = ["Packed", "Projection", "ShadowMap", "Tree", "pack"]
