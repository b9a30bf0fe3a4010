"""The version of foveal, down here so that every room may name it; only the front door is above them all."""

__all__ = ["__version__"]

__version__ = "0.1.0"
