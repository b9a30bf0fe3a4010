"""What one worker computes patches in: two slates with their corners' rings, of a fixed size."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._kernels_slates_layout import LANES, WORDS
from .slates_cage import SlateNet

__all__ = ["Rows", "Work"]


class Work(NamedTuple):
    """Two slates, used in turn.

    Attributes
    ----------
    slates : (2, (2^depth + 3)^2 · WORDS) float64
    rings : (2, 4 · LANES, 3 (1 + ring)) float64
        Of the corners of each lane's patch; as long as the longest ring of the control mesh.
    limits : (4 · WORDS,) float64
        Limit point, tangents and normal of the point of the moment.
    """

    slates: NDArray[np.float64]
    rings: NDArray[np.float64]
    limits: NDArray[np.float64]

    @property
    def depth(self) -> int:
        """Of the deepest patches that it is for."""
        return (math.isqrt(self.slates.shape[1] // WORDS) - 3).bit_length() - 1

    @classmethod
    def of(cls, net: SlateNet, depth: int, /) -> "Work":
        """For patches up to a depth."""
        ring = 1 + int(np.diff(net.ring_starts).max(initial=0))
        # The narrow slates of borders, three rows of 2^depth + 1, fit into the same.
        return cls(
            np.zeros((2, ((1 << depth) + 3) ** 2 * WORDS)),
            np.zeros((2, 4 * LANES, 3 * ring)),
            np.zeros(4 * WORDS),
        )


class Rows(NamedTuple):
    """Limit points and unit normals, (n, 3) each, float64 or float32."""

    positions: NDArray[np.floating]
    normals: NDArray[np.floating]
