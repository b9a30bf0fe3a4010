"""Patch codec: one patch of triangles to bytes and back, with tables that a whole file shares."""

from .decode import decode
from .encode import encode
from .normals import dequantise_normals, predicted_normals, quantise_normals
from .patch import Patch
from .tables import Tables
from .train import train

__all__ = [
    "Patch",
    "Tables",
    "decode",
    "dequantise_normals",
    "encode",
    "predicted_normals",
    "quantise_normals",
    "train",
]
