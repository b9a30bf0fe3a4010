"""Who is beside whom in a polygon mesh, how sharp its edges are, and its first step of Catmull-Clark."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.polymesh import PolyMesh

from . import _kernels_slates_cage as kernels
from ._kernels_slates_layout import INFINITE
from ._kernels_slates_step import step_points

__all__ = ["FirstStep", "Polygons", "unending"]

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Polygons:
    """Faces with their edges, tags and rings. A corner of a face is also the edge from it to the next.

    Attributes
    ----------
    count : int
        Vertices.
    starts, corners : (m + 1,) int64, (c,) int64
        As of a `PolyMesh`.
    following, previous, mates : (c,) int64
        The next and the previous corner of the face; the same edge seen from its other face, or -1.
    edge : (c,) int64
        The edge's number, and `ends` (e, 2) int64 its two vertices.
    sharp : (e,) float64
        Of edges: 0 smooth, infinity at borders and from 10 on; and `vertex_sharp` (count,) of vertices.
    """

    count: int
    starts: Ints
    corners: Ints
    following: Ints
    previous: Ints
    mates: Ints
    edge: Ints
    ends: Ints
    sharp: Floats
    vertex_sharp: Floats

    @classmethod
    def of(cls, mesh: PolyMesh, /) -> "Polygons":
        """Of a checked mesh."""
        starts, corners = mesh.starts.astype(np.int64), mesh.corners.astype(np.int64)
        count = len(mesh.positions)
        tags = mesh.crease_edges.astype(np.int64)
        keys, values = tags[:, 0] * count + tags[:, 1], unending(mesh.crease_sharpness)
        vertex_sharp = np.zeros(count)
        vertex_sharp[mesh.corner_vertices] = unending(mesh.corner_sharpness)
        if mesh.boundary == "edge_and_corner":
            vertex_sharp[np.bincount(corners, minlength=count) == 1] = np.inf
        return cls._joined(count, starts, corners, keys, values, vertex_sharp)

    @classmethod
    def _joined(
        cls, count: int, starts: Ints, corners: Ints, keys: Ints, values: Floats, vertex_sharp: Floats
    ) -> "Polygons":
        """From sharpness by edges' keys, lower vertex times count + upper."""
        own = np.arange(len(corners))
        following, previous = own + 1, own - 1
        following[starts[1:] - 1] = starts[:-1]
        previous[starts[:-1]] = starts[1:] - 1
        begin, end = corners, corners[following]
        lower, upper = np.minimum(begin, end), np.maximum(begin, end)
        known, first, edge = np.unique(lower * count + upper, return_index=True, return_inverse=True)
        mates = np.full(len(corners), -1, np.int64)
        order = np.argsort(edge, kind="stable")
        same = np.flatnonzero(edge[order][1:] == edge[order][:-1])
        mates[order[same]], mates[order[same + 1]] = order[same + 1], order[same]
        sharp = np.zeros(len(known))
        sharp[np.searchsorted(known, keys)] = values
        sharp[edge[mates < 0]] = np.inf
        ends = np.stack([lower[first], upper[first]], axis=1)
        return cls(
            count, starts, corners, following, previous, mates, edge.reshape(-1), ends, sharp, vertex_sharp
        )

    @property
    def faces(self) -> int:
        """How many there are."""
        return len(self.starts) - 1

    def fans(self) -> tuple[Ints, Ints, Ints]:
        """Starts (count + 1,), corners (c,) around each vertex, and where each corner is among them (c,).

        Counter-clockwise: of an inner vertex from its least corner, of a border vertex from the border on.
        """
        own = np.arange(len(self.corners))
        first = np.full(self.count, -1, np.int64)
        first[self.corners[::-1]] = own[::-1]
        border = np.flatnonzero(self.mates < 0)
        first[self.corners[border]] = border
        starts = np.concatenate([[0], np.cumsum(np.bincount(self.corners, minlength=self.count))])
        ring, place = np.empty(len(own), np.int64), np.empty(len(own), np.int64)
        kernels.rings(self.corners, self.previous, self.mates, first, starts, ring, place)
        return starts, ring, place

    def stepped(self) -> "tuple[Polygons, FirstStep]":
        """After one step: all quadrangles, old vertices first, then one an edge, then one a face."""
        middle, centre = self.count + self.edge, self.count + len(self.ends)
        face = np.repeat(np.arange(self.faces), np.diff(self.starts))
        quads = np.stack([self.corners, middle, centre + face, middle[self.previous]], axis=1)
        count = centre + self.faces
        left = np.maximum(self.sharp - 1, 0)
        tagged = np.flatnonzero(left > 0)
        halves = np.stack([self.ends[tagged], np.stack([self.count + tagged] * 2, axis=1)], axis=2)
        keys = (halves[..., 0] * count + halves[..., 1]).reshape(-1)
        vertex_sharp = np.zeros(count)
        vertex_sharp[: self.count] = np.maximum(self.vertex_sharp - 1, 0)
        starts = np.arange(0, 4 * len(quads) + 1, 4)
        after = Polygons._joined(
            count, starts, quads.reshape(-1), keys, np.repeat(left[tagged], 2), vertex_sharp
        )
        return after, FirstStep(self, self._step_weights())

    def _step_weights(self) -> Floats:
        """(4, count): see `FirstStep`."""

        def at_ends(weights: NDArray[np.bool_] | Floats) -> Floats:
            total = np.bincount(self.ends.reshape(-1), np.repeat(weights, 2), minlength=self.count)
            return total.astype(np.float64)

        valence, now, then = at_ends(self.sharp >= 0), at_ends(self.sharp > 0), at_ends(self.sharp > 1)
        corner, corner_then = self.vertex_sharp > 0, self.vertex_sharp > 1
        kinds = [
            np.where(is_corner | (sharp > 2), 2, np.where(sharp == 2, 1, 0))
            for is_corner, sharp in ((corner, now), (corner_then, then))
        ]
        is_ending = (self.sharp > 0) & (self.sharp <= 1)
        ends_too = corner & ~corner_then
        total = at_ends(np.where(is_ending, self.sharp, 0)) + np.where(ends_too, self.vertex_sharp, 0)
        share = np.minimum(total / np.maximum(at_ends(is_ending) + ends_too, 1), 1)
        share = np.where(kinds[0] == kinds[1], 1, share)
        smooth = (share * (kinds[0] == 0) + (1 - share) * (kinds[1] == 0)) * (valence > 0)
        crease, later = share * (kinds[0] == 1), (1 - share) * (kinds[1] == 1)
        inverse = 1 / np.maximum(valence, 1)
        kept = smooth * (1 - 2 * inverse) + 0.75 * (crease + later) + (1 - smooth - (crease + later))
        return np.array([kept, smooth * inverse * inverse, crease / 8, later / 8])


@dataclass(frozen=True, slots=True)
class FirstStep:
    """Catmull and Clark's rules with those of DeRose, Kass and Truong for what is sharp: for rows of three.

    Attributes
    ----------
    polygons : Polygons
        Before it.
    weights : (4, count) float64
        Of each vertex: itself; all around it; its creases; those of the next step.
    """

    polygons: Polygons
    weights: Floats

    def points(self, rows: Floats, /) -> Floats:
        """(new vertices, 3) of (vertices, 3)."""
        old = self.polygons
        out = np.zeros((old.count + len(old.ends) + old.faces, 3))
        faces = old.starts, old.corners, old.edge
        kept, around, now, later = self.weights
        step_points(*faces, old.ends, old.sharp, kept, around, now, later, rows, out)
        return out


def unending(sharpness: NDArray[np.float32]) -> Floats:
    """As float64, infinite from 10 on."""
    values = sharpness.astype(np.float64)
    return np.where(values >= INFINITE, np.inf, values)
