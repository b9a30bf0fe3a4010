"""A refined mesh as slots: what is drawn, and compared with what was drawn before."""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Placing", "Slots"]

Placing = Literal["control", "limit"]
"""Where vertices are shown: as subdivision has them on their faces' level, or where they go in the limit."""


class Slots(NamedTuple):
    """Faces and vertices in slots that are taken and given back, while what is in them does not move.

    Attributes
    ----------
    faces : (F, 3) int32
        Vertices in [0, V), counter-clockwise seen from outside; a free slot is (0, 0, 0).
    positions : (V, 3) float64
        In the unit and axes of the control mesh. Of a free slot: anything finite.
    starts : (V, 3) float64
        Where a vertex was born; a control mesh's vertex where it is in it.
    levels : (F,) uint8
        How often a face was refined.
    colours : (F,) uint8
        0 green, 1 red, 2 blue. √3 faces are green.
    """

    faces: NDArray[np.int32]
    positions: NDArray[np.float64]
    starts: NDArray[np.float64]
    levels: NDArray[np.uint8]
    colours: NDArray[np.uint8]

    @classmethod
    def empty(cls, faces: int, vertices: int, /) -> "Slots":
        """Room for so many faces, all free and green, and vertices."""
        return cls(
            np.zeros((faces, 3), np.int32),
            np.zeros((vertices, 3)),
            np.zeros((vertices, 3)),
            np.zeros(faces, np.uint8),
            np.zeros(faces, np.uint8),
        )
