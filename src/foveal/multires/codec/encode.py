"""A patch to bytes."""

import numpy as np

from .patch import Patch
from .tables import Tables

__all__ = ["encode"]


def encode(patch: Patch, tables: Tables, /) -> bytes:
    """The bytes of `patch`."""
    parts = [np.array([len(patch.positions), len(patch.faces)], "<u4").tobytes()]
    parts += [patch.positions.astype("<i4").tobytes(), patch.faces.astype("<i4").tobytes()]
    if patch.normals is not None:
        parts.append(patch.normals.astype("<i2").tobytes())
    if patch.colours is not None:
        parts.append(patch.colours.astype("u1").tobytes())
    return b"".join(parts)
