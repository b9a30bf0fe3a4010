"""What the parts of an RGB triangulation share: its arrays, and making more room."""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_rgb_base as base_kernels
from . import _kernels_rgb_show as show_kernels
from ._kernels_rgb_layout import (
    BASE_COUNT,
    BORN,
    BUTTERFLY,
    DOUBTFUL,
    FACES,
    FACES_IN_USE,
    FREE_FACE,
    FREE_VERTEX,
    IN_USE,
    PRESENT_COUNT,
    SCHEME,
    VERTICES,
)
from .cage import Cage
from .rgb_net import RgbNet

__all__ = ["State"]

#: Room to begin with, beyond the control mesh: pages that are never touched cost nothing.
_FACES, _VERTICES = 1 << 17, 1 << 17


class State:
    """An RGB triangulation's arrays, replaced when they grow."""

    def __init__(self, cage: Cage, scheme: int) -> None:
        count, faces = len(cage.positions), len(cage.faces)
        self.net = net = RgbNet.empty(2 * faces + _FACES, 2 * count + _VERTICES, cage)
        net.counts[[FACES, FACES_IN_USE]] = faces
        net.counts[[VERTICES, IN_USE, PRESENT_COUNT]] = count
        net.counts[[FREE_FACE, FREE_VERTEX, DOUBTFUL]] = -1
        net.counts[SCHEME], net.counts[BASE_COUNT] = scheme, count
        net.faces["corners"][:faces], net.faces["beside"][:faces] = cage.faces, cage.beside
        net.faces["base"][:faces] = np.arange(faces)
        net.vertices["around"][cage.faces] = np.arange(faces, dtype=np.int32)[:, None]
        base_kernels.base_vertices(net, cage.positions, cage.starts, cage.ring, cage.is_border)
        base_kernels.base_normals(net)

    def grow(self) -> None:
        """Twice the room."""
        self.net = self.net.grown(2 * len(self.net.faces), 2 * len(self.net.vertices))
        base_kernels.fill_table(self.net)

    def box(self) -> NDArray[np.float64]:
        """(8, 3): the corners of a box around all that was computed yet."""
        # Loop's surface stays in the control mesh's box, the butterfly's does not.
        is_loop = self.net.counts[SCHEME] != BUTTERFLY
        count = int(self.net.counts[BASE_COUNT if is_loop else VERTICES])
        points = self.net.vertices["born"][:count][self.net.vertices["flags"][:count] & BORN != 0]
        sides = np.stack([points.min(axis=0), points.max(axis=0)], axis=1)
        return np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 3)

    @property
    def faces(self) -> int:
        """Of the mesh."""
        return int(self.net.counts[FACES_IN_USE])

    @property
    def slots(self) -> int:
        """Of vertices that were ever used."""
        return int(self.net.counts[VERTICES])

    @property
    def vertices(self) -> int:
        """Of the mesh."""
        return int(self.net.counts[PRESENT_COUNT])

    def placed(self, is_limit: bool) -> NDArray[np.float64]:
        """(V, 3): where the vertices of the mesh stand on the highest level beside them, or in the limit."""
        count = int(self.net.counts[VERTICES])
        levels, out = np.empty(count, np.int8), np.zeros((count, 3))
        show_kernels.shown_levels(self.net, levels)
        begin = 0
        while (begin := int(show_kernels.place_all(self.net, levels, begin, is_limit, out))) < count:
            self.grow()
        return out
