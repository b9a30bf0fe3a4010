"""Both directions of the distance between a cell and its coarse one, from one overlay of their triangles.

Each fine vertex is given a place on the coarse surface, each fine edge a way over it, each coarse vertex a
place on the fine surface. That makes pairs of points: (vertex, its place), and where ways and coarse edges
cross (point of the fine edge, point of the coarse one). The largest distance of a pair bounds the distance
of the surfaces both ways, if the pairs belong together:

* take a fine face f and a coarse face g. The parts of f's ways inside of g and of g's edges inside of f
  are chords in both; if they close to loops, fill each loop by triangles from one of its corners: every
  point of f in it has a partner in g and the other way round, no farther than the farthest corner pair,
  since a distance between two points that move linearly is convex;
* the fills of all f in one g have, modulo 2, the outline of g, since the ways are there twice, once for
  each face beside a fine edge. So they cover g. In the same way the fills of all g in one f cover f.

Nothing here asks where the places are: bad ones give a large distance, never a wrong one. Loops close if
each fine edge arrives where its end is placed (`trace`) and each coarse edge, crossing by crossing, leads
from the fine face at its one end to that at its other (`verify`). Faces where that fails are *open*, and
so are those with a pair that is suspiciously far; they are to be measured by themselves. Along a border
that both have, the strips of the kernels' first lines close the loops.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _kernels_overlay as kernels
from . import _kernels_trace as trace_kernels

__all__ = ["Surface", "overlay"]

#: Crossings for each fine face that there is room for; the dragon has 2.7.
_CROSSINGS = 6


@dataclass(frozen=True, slots=True)
class Surface:
    """Triangles and their twins.

    Attributes
    ----------
    positions : (n, 3) float64
    faces, twins : (m, 3) int32
        See `simplify.twins`.
    """

    positions: NDArray[np.float64]
    faces: NDArray[np.int32]
    twins: NDArray[np.int32]


def overlay(
    fine: Surface,
    coarse: Surface,
    kept: NDArray[np.int32],
    start: NDArray[np.int32],
    carried: NDArray[np.float64],
    suspicious: float,
    errors: NDArray[np.float64],
    /,
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Raise `errors` of the coarse faces to bound both directions; which faces are left open.

    Parameters
    ----------
    fine, coarse : Surface
    kept : (n',) int32
        Which fine vertex each coarse one was.
    start : (m,) int32
        A coarse face somewhere near each fine one.
    carried : (m,) float64
        The fine faces' own errors, which are added.
    suspicious : float
        A pair farther than this leaves its faces open.
    errors : (m',) float64
        Changed in place.

    Returns
    -------
    is_open : (m,) bool
        Fine faces whose way to the coarse surface is still to be measured.
    is_open_onto : (m',) bool
        Coarse faces whose way to the fine surface is still to be measured.
    """
    vertices, onto_vertices, halves = len(fine.positions), len(coarse.positions), 3 * len(coarse.faces)
    walls = np.empty((len(coarse.faces), 3, 4))
    both = (coarse.positions, coarse.faces, coarse.twins)
    trace_kernels.moved_walls(*both, np.empty((len(coarse.faces), 3)), walls)
    place, distance = np.empty(vertices, np.int32), np.empty(vertices)
    trace_kernels.locate(fine.positions, fine.faces, start, *both, walls, place, distance)
    leaving, begins = np.empty(vertices, np.int32), np.empty(halves, np.int32)
    under, depth = np.empty(onto_vertices, np.int32), np.empty(onto_vertices)
    kernels.outlines(
        fine.positions, fine.faces, fine.twins, place, leaving, *both, kept, begins, under, depth
    )
    is_open, is_open_onto = np.zeros(len(fine.faces), np.bool_), np.zeros(len(coarse.faces), np.bool_)
    room = _CROSSINGS * len(fine.faces) + 64
    head, following = np.empty(halves, np.int32), np.empty(room, np.int32)
    along, fine_half = np.empty(room), np.empty(room, np.int32)
    trace_kernels.trace(
        fine.positions,
        fine.faces,
        fine.twins,
        place,
        leaving,
        *both,
        walls,
        carried,
        suspicious,
        errors,
        is_open,
        is_open_onto,
        head,
        following,
        along,
        fine_half,
    )
    first, votes = np.empty(onto_vertices, np.int32), np.empty((onto_vertices, 2), np.int32)
    kernels.settle(
        fine.positions, fine.faces, fine.twins, *both, head, following, fine_half, first, votes, under, depth
    )
    kernels.begin_inside(coarse.faces, coarse.twins, under, begins, np.empty(onto_vertices, np.bool_))
    kernels.verify(
        fine.faces,
        fine.twins,
        coarse.faces,
        coarse.twins,
        begins,
        head,
        following,
        fine_half,
        is_open,
        is_open_onto,
    )
    kernels.corners(
        fine.faces,
        place,
        distance,
        coarse.faces,
        under,
        depth,
        carried,
        suspicious,
        errors,
        is_open,
        is_open_onto,
    )
    return is_open, is_open_onto
