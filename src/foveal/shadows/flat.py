"""Casters as one light sees them: cut to its map, in whole-number places."""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_clip as clip
from . import _kernels_flat as kernels
from ._kernels_flat import Flat
from .casters import Casters
from .projection import Projection

__all__ = ["PLACE_BITS", "flatten"]

_Part = tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int32], NDArray[np.bool_], NDArray[np.bool_]]
"""Homogeneous places, faces, edges, whether of a closed part, whether wanted."""
PLACE_BITS = 30
"""There are 2^30 places along a map's side: 1,024 a pixel at 2^20 pixels; products of two fit an int64."""


def flatten(casters: Casters, projection: Projection, /) -> Flat:
    """Project triangles and make them counter-clockwise; those that are seen from the edge are left out."""
    matrix = projection.matrix
    seen = casters.positions @ matrix[:, :3].T + matrix[:, 3]
    scale, shift = projection.lens()
    nearest = -np.inf if projection.is_parallel else -shift / scale
    where = np.empty(len(casters.faces), np.uint8)
    clip.sort_out(seen, casters.faces, nearest, where)
    parts = [(seen, casters.faces, casters.edges, casters.is_closed, where == 0)]
    if (where == 1).any():
        parts += [_cut(seen, casters, (where == 1) & casters.is_closed, nearest)]
        parts += [_cut(seen, casters, (where == 1) & ~casters.is_closed, nearest)]
    lens = np.array([not projection.is_parallel, scale, shift], dtype=np.float64)
    laid = [_laid(part, lens, projection.is_mirrored()) for part in parts]
    if len(laid) == 1:
        return laid[0]
    return Flat(
        np.concatenate([flat.corners for flat in laid]),
        np.concatenate([flat.planes for flat in laid]),
        np.concatenate([flat.depths for flat in laid]),
        np.concatenate([flat.edges for flat in laid]),
        np.concatenate([flat.sides for flat in laid]),
        lens,
    )


def _laid(part: _Part, lens: NDArray[np.float64], is_mirrored: bool) -> Flat:
    count = int(np.count_nonzero(part[-1]))
    flat = Flat(
        np.empty((count, 6), np.int32),
        np.empty((count, 3), np.float64),
        np.empty((count, 2), np.int64),
        np.empty((count, 3), np.int32),
        np.empty(count, np.uint8),
        lens,
    )
    count = kernels.lay(flat, *part, is_mirrored, float(1 << PLACE_BITS))
    return Flat(
        flat.corners[:count],
        flat.planes[:count],
        flat.depths[:count],
        flat.edges[:count],
        flat.sides[:count],
        lens,
    )


def _cut(seen: NDArray[np.float64], casters: Casters, torn: NDArray[np.bool_], nearest: float) -> _Part:
    """The torn ones of the triangles, cut: of closed parts, or of open ones."""
    triangles, edges = seen[casters.faces[torn]], casters.edges[torn]
    room = (clip.CORNERS, 4)
    scratch = (
        *(np.empty(room), np.empty(clip.CORNERS, np.int32)),
        *(np.empty(room), np.empty(clip.CORNERS, np.int32)),
    )
    places, numbers = np.empty((0, 3, 4)), np.empty((0, 3), np.int32)
    made = clip.cut(triangles, edges, nearest, casters.edge_count + 1, places, numbers, *scratch)
    places, numbers = np.empty((made, 3, 4)), np.empty((made, 3), np.int32)
    clip.cut(triangles, edges, nearest, casters.edge_count + 1, places, numbers, *scratch)
    faces = np.arange(3 * made, dtype=np.int32).reshape(-1, 3)
    is_closed = np.full(made, bool(casters.is_closed[torn].any()))
    return places.reshape(-1, 4), faces, numbers, is_closed, np.ones(made, bool)
