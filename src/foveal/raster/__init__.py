"""The CPU rasteriser: depth, G-buffers, shading, PNG. Deterministic, no GPU, no display."""

from .picture import Picture, gradient, picture, write_png
from .rasterise import GBuffer, rasterise
from .shade import PLASTER

__all__ = ["PLASTER", "GBuffer", "Picture", "gradient", "picture", "rasterise", "write_png"]
