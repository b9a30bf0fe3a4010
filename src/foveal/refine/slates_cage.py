"""A control mesh made ready for tessellation: all that depends on its topology and tags, not on positions."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.polymesh import PolyMesh

from . import _kernels_slates_cage as kernels
from ._kernels_slates_layout import MOST_DEPTH, REGULAR, SMOOTH, TAGGED
from .slates_masks import Mask, Ring, mask_of, side_masks
from .slates_topology import FirstStep, Polygons, unending

__all__ = ["SlateCage", "SlateNet"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Indices = NDArray[np.int32]


class SlateNet(NamedTuple):
    """Quadrangles with what their patches read. Corner h of quadrangle f is 4 f + k, and its edge's name.

    Attributes
    ----------
    corners : (4 m,) int32
        Counter-clockwise; side k of a patch goes from corner k to k + 1.
    mates : (4 m,) int32
        The same edge seen from its other face, or -1.
    grid : (m, 16) int32
        The vertices of the table at depth 0.
    ring_starts : (n + 1,) int32
    ring : (r,) int32
        Of each vertex its spokes e_i, then f_i across its faces, from the ring's own first.
    spokes : (r,) float64
        The spokes' sharpness, where spokes are.
    fans, kinds, vertex_sharp : (n,) int32, int8, float64
        Faces at a vertex; REGULAR, SMOOTH or TAGGED; its own sharpness.
    place : (4 m,) int32
        Which spoke of its vertex's ring a corner's edge is.
    fan_starts, fan : (n + 1,) int32, (4 m,) int32
        The corners around a vertex, in the ring's order.
    sharp : (4 m,) float64
        Of sides; infinite at borders.
    side_class : (4 m,) int32
        A row of `side_masks` of a semi-sharp side.
    side_masks : (s, MOST_DEPTH + 1, 8) float64
    mask_of : (n,) int32
        A vertex's mask, which `mask_starts` places in `weights`, a row after the other.
    mask_starts, weights : (w + 1,) int32, (q,) float64
    sectors : (t, 4) int32
        First row and number of the pairs, first row and number of the areas.
    sector_starts : (w + 1,) int32
        Of masks in `sectors`.
    normal_starts : (n + 1,) int32
        A normal for each sector of a vertex.
    normal_of : (4 m,) int32
        The normal at a corner.
    """

    corners: Indices
    mates: Indices
    grid: Indices
    ring_starts: Indices
    ring: Indices
    spokes: Floats
    fans: Indices
    kinds: NDArray[np.int8]
    vertex_sharp: Floats
    place: Indices
    fan_starts: Indices
    fan: Indices
    sharp: Floats
    side_class: Indices
    side_masks: Floats
    mask_of: Indices
    mask_starts: Indices
    weights: Floats
    sectors: Indices
    sector_starts: Indices
    normal_starts: Indices
    normal_of: Indices


@dataclass(frozen=True, slots=True)
class SlateCage:
    """Quadrangles for slates, of any polygon mesh: one step is made first where a face is none.

    Attributes
    ----------
    net : SlateNet
    first : FirstStep or None
        Makes rows of quadrangles' vertices of the mesh's.
    faces : (m,) int64
        Which face of the mesh a quadrangle is of.
    is_shown : (m,) bool
        False for holes: the mesh's own, and those that the boundary rule "none" leaves.
    """

    net: SlateNet
    first: FirstStep | None
    faces: Ints
    is_shown: NDArray[np.bool_]

    @classmethod
    def of(cls, mesh: PolyMesh, /) -> "SlateCage":
        """Of a checked mesh."""
        polygons, first = Polygons.of(mesh), None
        is_hole = _holes(mesh, polygons)
        faces, tags = np.arange(polygons.faces), (polygons.sharp, polygons.vertex_sharp)
        steps = max(_steps(values) for values in tags)
        if (np.diff(polygons.starts) != 4).any():
            faces = np.repeat(faces, np.diff(polygons.starts))
            polygons, first = polygons.stepped()
            steps = max(steps - 1, 0)
        return cls(_net(polygons, steps), first, faces, ~is_hole[faces])

    def points(self, positions: NDArray[Any], /) -> Floats:
        """(n, 3): of the quadrangles' vertices, of rows of three on the mesh's."""
        columns = np.ascontiguousarray(positions, np.float64)
        return columns if self.first is None else self.first.points(columns)


def _steps(sharpness: Floats) -> int:
    """After how many nothing semi-sharp is left."""
    return int(np.ceil(sharpness[np.isfinite(sharpness)].max(initial=0)))


def _holes(mesh: PolyMesh, polygons: Polygons) -> NDArray[np.bool_]:
    """The mesh's own; with the boundary "none" also faces at the ends of border edges not sharp for ever."""
    is_hole = np.zeros(polygons.faces, np.bool_)
    is_hole[mesh.holes] = True
    if mesh.boundary != "none":
        return is_hole
    is_open = np.zeros(len(polygons.ends), np.bool_)
    is_open[polygons.edge[polygons.mates < 0]] = True
    keys = polygons.ends[:, 0] * polygons.count + polygons.ends[:, 1]
    tags = mesh.crease_edges[unending(mesh.crease_sharpness) == np.inf].astype(np.int64)
    is_open &= ~np.isin(keys, tags[:, 0] * polygons.count + tags[:, 1])
    is_near = np.zeros(polygons.count, np.bool_)
    is_near[polygons.ends[is_open]] = True
    found: NDArray[np.bool_] = np.logical_or.reduceat(is_near[polygons.corners], polygons.starts[:-1])
    return found | is_hole


def _net(polygons: Polygons, steps: int) -> SlateNet:
    corners, mates, count = polygons.corners, polygons.mates, polygons.count
    fan_starts, fan, place = polygons.fans()
    fans = np.diff(fan_starts)
    borders = np.bincount(corners[mates < 0], minlength=count)
    ring_starts = np.concatenate([[0], np.cumsum(2 * fans + borders)])
    ring, spokes = np.empty(ring_starts[-1], np.int64), np.zeros(ring_starts[-1])
    sharp = polygons.sharp[polygons.edge]
    kernels.fill_rings(corners, mates, sharp, fan_starts, fan, ring_starts, ring, spokes)
    is_tagged = polygons.vertex_sharp > 0
    is_tagged[corners[sharp > 0]] = is_tagged[corners[polygons.following[sharp > 0]]] = True
    kinds = np.where(is_tagged, TAGGED, np.where(fans == 4, REGULAR, SMOOTH)).astype(np.int8)
    grid = np.empty((polygons.faces, 16), np.int64)
    kernels.fill_grid(corners, mates, place, fans, ring_starts, ring, grid)
    classes, side_class = np.unique(sharp[(sharp > 0) & np.isfinite(sharp)], return_inverse=True)
    class_of = np.zeros(len(corners), np.int64)
    class_of[(sharp > 0) & np.isfinite(sharp)] = side_class.reshape(-1)
    tables = [side_masks(float(s)) for s in classes] or [np.zeros((MOST_DEPTH + 1, 8))]
    rings = ring_starts, spokes, fans, borders, is_tagged, polygons.vertex_sharp
    numbers, masks = _masks(*rings, steps)
    parts: list[Any] = [
        *(corners, mates, grid, ring_starts, ring, spokes, fans, kinds, polygons.vertex_sharp),
        *(place, fan_starts, fan, sharp, class_of, np.array(tables)),
        *_tables(numbers, masks, corners, place),
    ]
    # Indices as int32: half of what a prepared control mesh takes.
    return SlateNet(*(a.astype(np.int32) if a.dtype == np.int64 else a for a in parts))


def _masks(
    ring_starts: Ints,
    spokes: Floats,
    fans: Ints,
    borders: Ints,
    is_tagged: NDArray[np.bool_],
    sharpness: Floats,
    steps: int,
) -> tuple[Ints, list[Mask]]:
    """Each vertex's number among the masks, and these: one for each kind of ring there is."""
    known: dict[Ring, int] = {}
    numbers = np.zeros(len(fans), np.int64)
    for n in np.unique(fans[~is_tagged]):
        numbers[~is_tagged & (fans == n)] = known.setdefault(Ring(int(n), (0.0,) * int(n)), len(known))
    for v in np.flatnonzero(is_tagged).tolist():
        begin, size = ring_starts[v], fans[v] + borders[v]
        ring = Ring(int(fans[v]), tuple(spokes[begin : begin + size].tolist()), float(sharpness[v]))
        numbers[v] = known.setdefault(ring, len(known))
    return numbers, [mask_of(ring, steps) for ring in known]


def _tables(
    numbers: Ints, masks: list[Mask], corners: Ints, place: Ints
) -> tuple[Ints, Ints, Floats, Ints, Ints, Ints, Ints]:
    """The masks as flat arrays, and where normals are."""
    mask_starts = np.cumsum([0] + [mask.rows.size for mask in masks])
    weights = np.concatenate([mask.rows.reshape(-1) for mask in masks])
    sector_starts = np.cumsum([0] + [len(mask.sectors) for mask in masks])
    sectors = np.array(
        [(s.pairs[0][0], len(s.pairs), s.areas[0][0], len(s.areas)) for mask in masks for s in mask.sectors],
        np.int64,
    ).reshape(-1, 4)
    normal_starts = np.concatenate([[0], np.cumsum(np.diff(sector_starts)[numbers])])
    most = max(max((f for s in mask.sectors for f in s.faces), default=0) for mask in masks) + 1
    sector_of_face = np.zeros((len(masks), most), np.int64)
    for i, mask in enumerate(masks):
        for j, sector in enumerate(mask.sectors):
            sector_of_face[i, sector.faces] = j
    normal_of = normal_starts[corners] + sector_of_face[numbers[corners], place]
    return numbers, mask_starts, weights, sectors, sector_starts, normal_starts, normal_of
