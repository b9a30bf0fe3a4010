"""Limit points and normals of control vertices as weights on their rings.

A ring is closed under a step of subdivision. So while a vertex is semi-sharp the weights of its limit are
pulled back through its steps, and nothing has to be refined further than it is drawn: limit points of depth 0
are those of any depth. The same holds on the sides of a patch. The page has the same weights to the last bit,
so sums are in one order and cosines are those of `turn`.

A normal belongs to a sector, the faces between two sharp spokes, and is the sum of cross products of pairs of
rows: one pair of tangents, or for corners of several faces, which have no tangent plane, the faces' areas at
the level from which all of the mesh is settled.

Based on: Halstead, Kass, DeRose 1993, appendix A (limits, tangents); DeRose, Kass, Truong 1998 (creases). The
tangent across a crease is the left eigenvector of the standard rule's own step; the published mask
(Biermann, Levin, Zorin 2000) belongs to another edge rule and gives normals that change with the level.
"""

import functools
import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _kernels_slates_masks as kernels
from ._kernels_slates_layout import MOST_DEPTH
from ._kernels_turn import turn

__all__ = ["Mask", "Ring", "Sector", "mask_of", "side_masks"]

Floats = NDArray[np.float64]

# Of the iteration for darts, whose second eigenvalue comes nearer to the first as 14 over the square of the
# valence: 36 / 14 of that square give all digits. Beyond 110 faces the tangent is as near as it gets.
_MOST_WORK = 5_000_000


@dataclass(frozen=True, slots=True)
class Ring:
    """What a vertex's limit depends on.

    Attributes
    ----------
    faces : int
        At the vertex; one spoke more if it is on the border.
    spokes : tuple of float
        Their sharpness, counter-clockwise; infinite at borders.
    sharpness : float
        The vertex's own.
    """

    faces: int
    spokes: tuple[float, ...]
    sharpness: float = 0.0

    @property
    def steps(self) -> int:
        """After how many it is settled."""
        finite = [s for s in (*self.spokes, self.sharpness) if s < math.inf]
        return math.ceil(max(finite, default=0))

    def after(self, steps: int) -> "Ring":
        """The same after so many steps."""
        spokes = tuple(max(s - steps, 0.0) for s in self.spokes)
        return Ring(self.faces, spokes, max(self.sharpness - steps, 0.0))

    @property
    def sharp(self) -> list[int]:
        """Which spokes are sharp."""
        return [i for i, s in enumerate(self.spokes) if s > 0]

    @property
    def kind(self) -> str:
        """Which rule moves the vertex."""
        if self.sharpness > 0 or len(self.sharp) > 2:
            return "corner"
        return "crease" if len(self.sharp) == 2 else "smooth"


@dataclass(frozen=True, slots=True)
class Sector:
    """Faces between two sharp spokes, and rows whose cross products are its normal: (p, 2) of a mask's rows.

    `areas` are taken where `pairs` give no direction.
    """

    faces: list[int]
    pairs: list[tuple[int, int]]
    areas: list[tuple[int, int]]


@dataclass(frozen=True, slots=True)
class Mask:
    """Weights (rows, 1 + spokes + faces) of the vertex, e_i, f_i; row 0 is the limit point."""

    rows: Floats
    sectors: list[Sector]


@functools.lru_cache(4096)
def mask_of(ring: Ring, settled: int, /) -> Mask:
    """The mask of a vertex; areas are those after `settled` steps."""
    if ring.faces == 0:  # a vertex of no face stays, and has no normal
        return Mask(np.ones((1, 1)), [])
    n = len(ring.spokes)
    last = ring.after(ring.steps)
    rows: list[Floats] = [_pulled(ring, _limit_row(last), ring.steps)]
    sectors = []
    for faces in _sectors(last):
        areas = []
        for f in faces:
            across, along = np.zeros(1 + n + ring.faces), np.zeros(1 + n + ring.faces)
            across[1 + n + f], across[0] = 1, -1
            along[1 + (f + 1) % n], along[1 + f] = 1, -1
            rows += [_pulled(ring, row, settled) for row in (across, along)]
            areas.append((len(rows) - 2, len(rows) - 1))
        pairs = areas
        if last.kind != "corner" or len(faces) == 1:
            rows += [_pulled(ring, row, ring.steps) for row in _tangents(last, faces)]
            pairs = [(len(rows) - 2, len(rows) - 1)]
        sectors.append(Sector(faces, pairs, areas))
    return Mask(np.array(rows), sectors)


def _pulled(ring: Ring, row: Floats, steps: int) -> Floats:
    """Weights on a ring that give what `row` gives after so many steps."""
    centres = np.empty(ring.faces)
    for i in reversed(range(steps)):
        then, out = ring.after(i), np.empty(len(row))
        kernels.pull(ring.faces, np.array(then.spokes), float(then.sharpness), row, centres, out)
        row = out
    return row


def _sectors(ring: Ring) -> list[list[int]]:
    """The faces of each, counter-clockwise."""
    sharp, n = ring.sharp, len(ring.spokes)
    if not sharp:
        return [[*range(ring.faces)]]
    if n > ring.faces:
        return [[*range(a, b)] for a, b in itertools.pairwise(sharp)]
    turns = zip(sharp, [*sharp[1:], sharp[0] + n], strict=True)
    return [[i % n for i in range(a, b)] for a, b in turns]


def _limit_row(ring: Ring) -> Floats:
    n, k = len(ring.spokes), ring.faces
    row = np.zeros(1 + n + k)
    if ring.kind == "corner":
        row[0] = 1
    elif ring.kind == "crease":
        row[0] = 4 / 6
        row[[1 + i for i in ring.sharp]] = 1 / 6
    else:
        row = _turned(_smooth(n, bool(ring.sharp))[0], ring)
    return row


def _tangents(ring: Ring, faces: list[int]) -> tuple[Floats, Floats]:
    n, k = len(ring.spokes), ring.faces
    if ring.kind == "smooth":
        _, one, two = _smooth(n, bool(ring.sharp))
        return _turned(one, ring), _turned(two, ring)
    spokes = [1 + faces[0] % n, *(1 + (f + 1) % n for f in faces)]
    one, two = np.zeros(1 + n + k), np.zeros(1 + n + k)
    if ring.kind == "corner":
        one[spokes[0]], two[spokes[1]], one[0], two[0] = 1, 1, -1, -1
        return one, two
    one[spokes[0]], one[spokes[-1]] = 1, -1
    weights = across(len(faces))
    # Where the crease goes round to itself (no such ring is left open) both ends add up.
    np.add.at(two, [0, *spokes, *(1 + n + f for f in faces)], weights)
    return one, two


def _turned(weights: Floats, ring: Ring) -> Floats:
    """From e_0 being the sharp spoke to where it is."""
    n, first = len(ring.spokes), (ring.sharp or [0])[0]
    return np.concatenate([weights[:1], np.roll(weights[1 : 1 + n], first), np.roll(weights[1 + n :], first)])


@functools.cache
def _smooth(n: int, is_dart: bool) -> tuple[Floats, Floats, Floats]:
    """Limit point and two tangents of an inner vertex; of a dart its edge to e_0 is sharp for ever."""
    if is_dart:
        return _dart(n)
    point = np.array([n**2] + n * [4] + n * [1]) / (n * (n + 5))
    if n == 2:  # where the formula gives nothing: eigenvectors of its step, both for 1/4
        return point, np.array([0.0, 1, -1, 0, 0]), np.array([0.0, 0, 0, 1, -1])
    cosine = turn(1, n)[0]
    a = 1 + cosine + turn(1, 2 * n)[0] * math.sqrt(2 * (9 + cosine))
    waves = np.array([turn(i % n, n) for i in range(n + 1)]).T
    one, two = (np.concatenate([[0], a * wave[:-1], wave[:-1] + wave[1:]]) for wave in waves)
    return point, one, two


def _dart(n: int) -> tuple[Floats, Floats, Floats]:
    """Left eigenvectors of the dart's own step, by pulling rows back again and again.

    Of those that the reflection which keeps e_0 turns over, the first is the tangent across. There v and e_0
    are nothing, so that the edge does not matter: it is the smooth vertex's.
    """
    spokes = np.array([math.inf] + (n - 1) * [0.0])
    point, one, two = (row.copy() for row in _smooth(n, False))
    turns, centres, out = min(4 * n * n + 100, _MOST_WORK // n), np.empty(n), np.empty(1 + 2 * n)
    kernels.settle_point(spokes, turns, point, centres, out)
    kernels.settle_tangent(spokes, turns, point, one, centres, out)
    return point, one, np.array([0.0, 0, 0, 1, -1]) if n == 2 else two


@functools.cache
def across(k: int, /) -> Floats:
    """Of the tangent across a crease into a sector of k faces: v, e_0 .. e_k, f_0 .. f_(k-1)."""
    if k == 1:
        return np.array([-2.0, 1, 1, 0])
    (cosine, sine), (half, half_sine) = turn(1, 2 * k), turn(1, 4 * k)
    size = (5 + cosine + half * math.sqrt(2 * (9 + cosine))) / 16
    a, cot = 16 * size - 4, half / half_sine
    centre = -(8 * size * sine + (8 * size - 4) * (8 * size - 1) * cot) / (4 * size - 1)
    end = -(centre + (16 * size - 2) * cot) / 2
    wave = np.array([turn(i, 2 * k)[1] for i in range(k + 1)])
    return np.array([centre, end, *(a * wave[1:-1]), end, *(wave[:-1] + wave[1:])])


@functools.lru_cache(256)
def side_masks(sharpness: float, /) -> Floats:
    """(MOST_DEPTH + 1, 8): weights of a point inside a side, by depth, while the side is semi-sharp.

    Of the limit point those of itself, its neighbours along, those across, the diagonal ones; of the tangent
    along those of e_0 - e_2 and of the diagonals, of the tangent across the same. The side runs from e_2 to
    e_0, and the rest follows by symmetry.
    """
    rows = []
    for depth in range(MOST_DEPTH + 1):
        left = max(sharpness - depth, 0.0)
        ring = Ring(4, (left, 0.0, left, 0.0))
        rows_of = mask_of(ring, 0).rows
        point, along, over = rows_of[0], rows_of[-2], rows_of[-1]
        rows.append([*point[[0, 1, 2, 5]], along[1], along[5], over[2], over[5]])
    return np.array(rows)
