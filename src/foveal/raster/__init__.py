"""The CPU rasteriser: depth, G-buffers, shading, PNG. Deterministic, no GPU, no display."""

from .lit import SceneLight
from .picture import Picture, gradient, picture, write_png
from .rasterise import GBuffer, rasterise
from .shade import PLASTER

__all__ = ["PLASTER", "GBuffer", "Picture", "SceneLight", "gradient", "picture", "rasterise", "write_png"]
