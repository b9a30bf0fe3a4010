"""Ordinary shadow maps of what moves, beside the precomputed ones of what does not."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh

from . import _kernels_moving as kernels
from .bias import Window, window_of
from .projection import Projection
from .tree import FAR

__all__ = ["Moving"]


@dataclass(frozen=True, slots=True)
class Moving:
    """Depths of things that move, as the light sees them.

    Attributes
    ----------
    depths : tuple of (side, side) uint32
        For each projection the first step at which the ray of a pixel hits something, row by row.
    windows : tuple of Window
    """

    depths: tuple[NDArray[np.uint32], ...]
    windows: tuple[Window, ...]

    @classmethod
    def of(cls, mesh: TriMesh, projections: Sequence[Projection], resolution: int, /) -> Self:
        """Draw a mesh along each projection.

        Raises
        ------
        ValueError
            If the resolution is no power of two up to 2^14.
        """
        levels = resolution.bit_length() - 1
        if not (0 <= levels <= 14 and resolution == 1 << levels):
            raise ValueError(f"resolution must be a power of two up to 16384, got {resolution}")
        faces = np.require(mesh.faces, np.int32, ["C_CONTIGUOUS", "WRITEABLE"])
        depths = []
        for projection in projections:
            matrix = projection.matrix
            corners = np.ascontiguousarray(mesh.positions @ matrix[:, :3].T + matrix[:, 3])
            drawn = np.full((resolution, resolution), FAR, np.uint32)
            kernels.draw(corners, faces, drawn)
            depths.append(drawn)
        return cls(tuple(depths), tuple(window_of(projection, levels) for projection in projections))

    def darken(
        self,
        number: int,
        points: NDArray[np.float64],
        normals: NDArray[np.float64],
        radius: int,
        shares: NDArray[np.float32],
        /,
    ) -> None:
        """Bring shares down to those that a projection's map says; normals may be empty, (0, 3)."""
        kernels.darken(self.depths[number], self.windows[number], radius, points, normals, shares)
