"""Casters as one light sees them: cut to its map, in whole-number places."""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_clip as clip
from ._kernels_flat import BACK, FRONT, SHEET, Flat
from .casters import Casters
from .projection import Projection
from .tree import FAR, STEPS

__all__ = ["PLACE_BITS", "flatten"]

PLACE_BITS = 30
"""There are 2^30 places along a map's side: 1,024 a pixel at 2^20 pixels; products of two fit an int64."""


def flatten(casters: Casters, projection: Projection, /) -> Flat:
    """Project triangles and make them counter-clockwise; those that are seen from the edge are left out."""
    matrix = projection.matrix
    seen = casters.positions @ matrix[:, :3].T + matrix[:, 3]
    scale, shift = projection.lens()
    nearest = -np.inf if projection.is_parallel else -shift / scale
    places, edges, is_closed = _cut(seen, casters, nearest)
    with np.errstate(over="ignore"):
        corners = (
            np.rint(places[..., :2] / places[..., 3:] * (1 << PLACE_BITS)).astype(np.int64).reshape(-1, 6)
        )
    doubled = _doubled_area(corners)
    is_seen = doubled != 0
    places, edges, is_closed = places[is_seen], edges[is_seen], is_closed[is_seen]
    corners, doubled = corners[is_seen], doubled[is_seen]
    is_turned = doubled < 0
    corners[is_turned] = corners[is_turned][:, [0, 1, 4, 5, 2, 3]]
    places[is_turned] = places[is_turned][:, [0, 2, 1]]
    edges[is_turned] = -edges[is_turned][:, [2, 1, 0]]
    depths = np.clip(np.floor(places[..., 2] * STEPS), 0, FAR - 1).astype(np.int64)
    # Where right, up and the way of the light are right-handed, fronts are seen clockwise.
    is_front = is_turned == projection.is_mirrored()
    return Flat(
        corners.astype(np.int32),
        _planes(corners, places[..., 2] if projection.is_parallel else 1 / places[..., 3], abs(doubled)),
        np.stack([depths.min(axis=1), depths.max(axis=1)], axis=1),
        np.ascontiguousarray(edges),
        np.where(is_closed, np.where(is_front, FRONT, BACK), SHEET).astype(np.uint8),
        np.array([not projection.is_parallel, scale, shift], dtype=np.float64),
    )


def _cut(
    seen: NDArray[np.float64], casters: Casters, nearest: float
) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.bool_]]:
    """(k, 3, 4) homogeneous places, (k, 3) edges, and whether they are of closed parts."""
    places = seen[casters.faces]
    where = np.empty(len(places), np.int64)
    clip.is_beyond(places, nearest, where)
    whole, torn = where == 0, where == 1
    parts = [(places[whole], casters.edges[whole], casters.is_closed[whole])]
    if torn.any():
        for is_closed in (True, False):
            these = torn & (casters.is_closed == is_closed)
            cut_places, numbers = _cut_apart(places[these], casters.edges[these], nearest, casters.edge_count)
            parts.append((cut_places, numbers, np.full(len(numbers), is_closed)))
    joined = [np.concatenate(arrays) for arrays in zip(*parts, strict=True)]
    return joined[0], joined[1], joined[2]


def _cut_apart(
    places: NDArray[np.float64], edges: NDArray[np.int32], nearest: float, count: int
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    room = (clip.CORNERS, 4)
    scratch = (
        np.empty(room),
        np.empty(clip.CORNERS, np.int32),
        np.empty(room),
        np.empty(clip.CORNERS, np.int32),
    )
    out, numbers = np.empty((0, 3, 4)), np.empty((0, 3), np.int32)
    for _ in range(2):
        made, _ = clip.cut(places, edges, nearest, count + 1, out, numbers, *scratch)
        out, numbers = (
            (np.empty((made, 3, 4)), np.empty((made, 3), np.int32)) if len(out) != made else (out, numbers)
        )
    return out, numbers


def _doubled_area(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    x0, y0, x1, y1, x2, y2 = corners.T
    doubled: NDArray[np.int64] = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    return doubled


def _planes(
    corners: NDArray[np.int64], measures: NDArray[np.float64], doubled: NDArray[np.int64]
) -> NDArray[np.float64]:
    x0, y0, x1, y1, x2, y2 = corners.T.astype(np.float64)
    m0, m1, m2 = measures.T
    along_x = ((m1 - m0) * (y2 - y0) - (m2 - m0) * (y1 - y0)) / doubled
    along_y = ((m2 - m0) * (x1 - x0) - (m1 - m0) * (x2 - x0)) / doubled
    return np.ascontiguousarray(np.stack([m0, along_x, along_y], axis=1))
