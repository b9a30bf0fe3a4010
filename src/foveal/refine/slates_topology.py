"""Who is beside whom in a polygon mesh, how sharp its edges are, and its first step of Catmull-Clark."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array, eye_array, vstack

from foveal.mesh.polymesh import PolyMesh

from . import _kernels_slates_cage as kernels
from ._kernels_slates_layout import INFINITE

__all__ = ["Polygons"]

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

    def stepped(self) -> "tuple[Polygons, Any]":
        """After one step: all quadrangles, old vertices first, then one an edge, then one a face.

        Also the sparse matrix (new vertices, vertices) that makes the new positions of the old ones.
        """
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
        return after, self._step_matrix(face)

    def _step_matrix(self, face: Ints) -> Any:
        """Catmull and Clark's rules with those of DeRose, Kass and Truong for what is sharp."""
        sizes, edges, n = np.diff(self.starts), len(self.ends), self.count
        centres = csr_array((1 / sizes[face], (face, self.corners)), shape=(self.faces, n))
        rows = np.arange(edges)
        middles = csr_array(
            (np.full(2 * edges, 0.5), (np.tile(rows, 2), self.ends.T.reshape(-1))), shape=(edges, n)
        )
        sides = csr_array((np.full(len(face), 0.25), (self.edge, face)), shape=(edges, self.faces))
        share = np.minimum(self.sharp, 1)
        edge_points = diags_array(share) @ middles + diags_array(1 - share) @ (
            0.5 * middles + sides @ centres
        )
        valence = np.bincount(self.ends.reshape(-1), minlength=n)
        around = (
            coo_array((np.ones(len(face)), (self.corners, face)), shape=(n, self.faces)).tocsr() @ centres
        )
        ends = self._end_matrix(np.ones(edges))
        smooth, now, then = self._rule_weights()
        inverse = 1 / np.maximum(valence, 1)
        kept = smooth * (1 - 2 * inverse) + 0.75 * (now + then) + (1 - smooth - now - then)
        crease = diags_array(now / 8) @ self._end_matrix(self.sharp > 0)
        later = diags_array(then / 8) @ self._end_matrix(self.sharp > 1)
        round_about = diags_array(smooth * inverse * inverse) @ (ends + around)
        vertex_points = diags_array(kept) @ eye_array(n) + round_about + crease + later
        return csr_array(vstack([vertex_points, edge_points, centres]))

    def _end_matrix(self, weight: NDArray[Any]) -> Any:
        """(count, count): which vertices edges join, as far as they weigh something."""
        kept = np.flatnonzero(weight)
        a, b = self.ends[kept].T
        both = np.concatenate([a, b]), np.concatenate([b, a])
        return csr_array((np.ones(2 * len(kept)), both), shape=(self.count, self.count))

    def _rule_weights(self) -> tuple[Floats, Floats, Floats]:
        """How much of the smooth rule, of the crease rule, and of that for the creases of the next step."""

        def at_ends(weights: NDArray[Any]) -> Floats:
            total = np.bincount(self.ends.T.reshape(-1), np.tile(weights, 2), minlength=self.count)
            return total.astype(np.float64)

        now, then = at_ends(self.sharp > 0), at_ends(self.sharp > 1)
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
        lone = np.bincount(self.ends.reshape(-1), minlength=self.count) == 0
        smooth = (share * (kinds[0] == 0) + (1 - share) * (kinds[1] == 0)) * ~lone
        return smooth, share * (kinds[0] == 1), (1 - share) * (kinds[1] == 1)


def unending(sharpness: NDArray[np.float32]) -> Floats:
    """As float64, infinite from 10 on."""
    values = sharpness.astype(np.float64)
    return np.where(values >= INFINITE, np.inf, values)
