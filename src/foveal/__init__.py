"""foveal gives a 3D surface detail where one looks."""

__version__ = "0.1.0"
