"""Shadow tests of a map against rays, which know nothing of it: how many are wrong, of how many.

Rays go through the middles of pixels, along the light. Receivers are put where the truth is beyond doubt:

- a little before the first surface: lit;
- where that is a solid's, at the ends of each gap between solids behind it (inside of them there is nobody
  to see): dark;
- where it is an open part's, a little behind each later surface: dark (from the first to the second a map's
  value is free, for nothing is there that could receive).

A little is: triangles are seen with corners at multiples of 2^-30 of the map's side, so up to 2^-31 off in
each direction. A plane of slopes a and b is then off by (|a| + |b|) 2^-31 at a ray, to the first order; twice
that is left, and two steps of 2^-32 for rounding down. Where a triangle is less than 16 of those places wide
the first order says nothing, but its depths at its corners still bound it.

Embree finds the surfaces, in float32: corners are off by up to 2^-25 of the map's side, a thirtieth of a
pixel at a million pixels a side, so beside silhouettes it may be it that is wrong. Each test that it calls
wrong is therefore asked again of all triangles in float64. That says as well where a ray passes an edge by
less than 2^-29, twice what rounded corners may be off: there the test is no test.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.mesh import TriMesh
from foveal.shadows import ShadowMap
from foveal.shadows.casters import casters_of

__all__ = ["Checked", "check", "random_pixels", "silhouettes"]

Array = NDArray[np.float64]
Hits = tuple[NDArray[np.int64], NDArray[np.int64], Array]
"""Ray, triangle, depth: each ray's together and in order of depth."""
PLACE = 2.0**-30
_UNIT = 2.0**-40
_MOST_LAYERS = 400


@dataclass(frozen=True)
class Checked:
    """What came out; `wrong` are (x, y, depth, should be lit) of the tests that failed."""

    rays: int
    tests: int
    asked_again: int
    no_tests: int
    wrong: Array


class Triangles(NamedTuple):
    """As the light sees them, u and v across and depth ahead."""

    corners: Array  # (m, 3, 3)
    slopes: Array  # (m, 2) of depth along u and v; zero if seen from the edge
    doubt: Array  # (m,) of depth
    sides: NDArray[np.int64]  # (m,) +1 a solid's front, -1 its back, 0 an open part


def random_pixels(count: int, side: int, seed: int = 5) -> NDArray[np.int64]:
    """(count, 2) x, y."""
    return np.random.default_rng(seed).integers(0, side, (count, 2))


def silhouettes(lower: NDArray[np.uint32], upper: NDArray[np.uint32]) -> NDArray[np.int64]:
    """(n, 2) x, y of pixels that have no legal value in common with a neighbour, and the four around each."""
    side = len(lower)
    is_edge = np.zeros((side + 2, side + 2), bool)
    inner = is_edge[1:-1, 1:-1]
    for low, high, here in ((lower, upper, inner), (lower.T, upper.T, inner.T)):
        is_step = (low[1:] > high[:-1]) | (high[1:] < low[:-1])
        here[1:] |= is_step
        here[:-1] |= is_step
    around = inner | is_edge[:-2, 1:-1] | is_edge[2:, 1:-1] | is_edge[1:-1, :-2] | is_edge[1:-1, 2:]
    y, x = np.nonzero(around)
    return np.stack([x, y], axis=1)


def seen(meshes: list[TriMesh], shadow: ShadowMap) -> Triangles:
    """The triangles before a parallel light, in float64."""
    casters, (projection,) = casters_of(meshes), shadow.projections
    assert projection.is_parallel
    corners = projection.project(casters.positions)[casters.faces]
    e, f = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    doubled = e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]
    longest = np.sqrt(
        np.maximum.reduce([(e[:, :2] ** 2).sum(1), (f[:, :2] ** 2).sum(1), ((e - f)[:, :2] ** 2).sum(1)])
    )
    is_wide = np.abs(doubled) > 16 * PLACE * longest
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.stack([e[:, 2] * f[:, 1] - f[:, 2] * e[:, 1], f[:, 2] * e[:, 0] - e[:, 2] * f[:, 0]], 1)
        slopes = np.where(doubled[:, None] != 0, slopes / doubled[:, None], 0.0)
    extent = np.ptp(corners[:, :, 2], axis=1)
    doubt = np.where(is_wide, np.minimum(extent, np.abs(slopes).sum(1) * PLACE), extent) + 2.0**-31
    # Counter-clockwise in (u, v) is seen from outside where right, up and ahead are left-handed.
    outward = doubled if not projection.is_mirrored() else -doubled
    sides = np.where(casters.is_closed, np.sign(outward), 0).astype(np.int64)
    return Triangles(corners, slopes, doubt, sides)


def depths(triangles: Triangles, which: NDArray[np.int64], places: Array) -> Array:
    """Of triangles' planes at places, within those of their corners."""
    corner, slopes = triangles.corners[which, 0], triangles.slopes[which]
    z = triangles.corners[which][:, :, 2]
    depth = corner[:, 2] + ((places - corner[:, :2]) * slopes).sum(1)
    return np.clip(depth, z.min(1), z.max(1))


def check(meshes: list[TriMesh], shadow: ShadowMap, pixels: NDArray[np.int64], /) -> Checked:
    """Test a map at the middles of pixels; needs embreex."""
    triangles, side = seen(meshes, shadow), shadow.resolution
    places = (pixels + 0.5) / side
    rays, receivers, is_lit = tests_of_hits(triangles, places, embree_hits(triangles, places))
    said = ask(shadow, places[rays], receivers)
    doubtful = np.unique(rays[said != is_lit])
    wrong, none, again = [], 0, 0
    for ray in doubtful:
        hits = hits_of_one(triangles, places[ray])
        again += 1
        if hits is None:
            none += 1
            continue
        one = places[ray : ray + 1]
        _, mine, truth = tests_of_hits(triangles, one, hits)
        answers = ask(shadow, np.repeat(one, len(mine), axis=0), mine)
        wrong += [(*pixels[ray], z, t) for z, t, a in zip(mine, truth, answers, strict=True) if t != a]
    return Checked(len(places), len(receivers), again, none, np.array(wrong, float).reshape(-1, 4))


def ask(shadow: ShadowMap, places: Array, receivers: Array) -> NDArray[np.bool_]:
    """What the map says of receivers, which are brought to the world for that."""
    matrix = shadow.projections[0].matrix
    seen_places = np.column_stack([places, receivers])
    points = np.linalg.solve(matrix[:3, :3], (seen_places - matrix[:3, 3]).T).T
    return shadow.lookup(points)


def embree_hits(triangles: Triangles, places: Array) -> Hits:
    """All that rays meet, by embree."""
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene

    scene = EmbreeScene()
    TriangleMesh(scene, triangles.corners.astype(np.float32))
    alive = np.arange(len(places))
    begins = np.full(len(places), -0.01)
    rays, hits, found = [], [], []
    for _ in range(_MOST_LAYERS):
        origins = np.column_stack([places[alive], begins[alive]]).astype(np.float32)
        ahead = np.tile(np.array([0, 0, 1], np.float32), (len(alive), 1))
        hit = scene.run(origins, ahead, output=True)["primID"].astype(np.int64)
        alive, hit = alive[hit >= 0], hit[hit >= 0]
        if len(alive) == 0:
            break
        depth = depths(triangles, hit, places[alive])
        rays.append(alive)
        hits.append(hit)
        found.append(depth)
        # Surfaces nearer to each other than this are taken for one: what lies between is not tested.
        begins[alive] = np.maximum(depth, begins[alive]) + 2.0**-21
    ray, triangle, depth = (np.concatenate(part) for part in (rays, hits, found))
    _, once = np.unique(ray * len(triangles.corners) + triangle, return_index=True)
    ray, triangle, depth = ray[once], triangle[once], depth[once]
    order = np.lexsort((depth, ray))
    return ray[order], triangle[order], depth[order]


def hits_of_one(triangles: Triangles, place: Array) -> Hits | None:
    """The same of one ray and all triangles, in float64; None where it passes an edge too near."""
    corners = triangles.corners[:, :, :2] - place
    near = 2 * PLACE
    is_by = ((corners.min(1) <= near) & (corners.max(1) >= -near)).all(1)
    which = np.flatnonzero(is_by)
    a, b = corners[which], np.roll(corners[which], -1, axis=1)
    lengths = np.linalg.norm(b - a, axis=2)
    sides = (a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]) / np.where(lengths > 0, lengths, 1.0)
    along = ((b - a) * -a).sum(2) / np.where(lengths > 0, lengths, 1.0)
    if ((np.abs(sides) <= near) & (along >= -near) & (along <= lengths + near)).any():
        return None
    which = which[(sides > 0).all(1) | (sides < 0).all(1)]
    depth = depths(triangles, which, np.repeat(place[None], len(which), axis=0))
    order = np.argsort(depth, kind="stable")
    return np.zeros(len(which), np.int64), which[order], depth[order]


def tests_of_hits(
    triangles: Triangles, places: Array, hits: Hits
) -> tuple[NDArray[np.int64], Array, NDArray[np.bool_]]:
    """(ray, depth of a receiver, whether it is lit): tests that are beyond doubt."""
    ray, triangle, depth = hits
    doubt, side = 2 * triangles.doubt[triangle], triangles.sides[triangle]
    nearest = np.floor((depth - doubt) / _UNIT).astype(np.int64)
    farthest = np.ceil((depth + doubt) / _UNIT).astype(np.int64)
    count = len(ray)
    is_first, is_last = np.ones(count, bool), np.ones(count, bool)
    is_first[1:] = is_last[:-1] = ray[1:] != ray[:-1]
    first = np.maximum.accumulate(np.where(is_first, np.arange(count), 0))
    inside = np.cumsum(side)
    inside -= (inside - side)[first]  # of how many solids, behind each surface
    # Doubts overlap where surfaces do: a gap is from the end of all before it to the begin of all behind.
    key = ray << 42
    gap_begin = np.maximum.accumulate(key + farthest) - key
    least = np.minimum.accumulate((key + nearest)[::-1])[::-1] - key
    gap_end = np.append(least[1:], 0)
    gap_end[is_last] = 1 << 40
    is_solid = side[first] == 1
    is_gap = (inside == 0) & is_solid & (gap_begin < gap_end)
    is_behind = ~is_solid & (nearest > farthest[first])
    lit = is_first & (least > 0)
    tests = [
        (ray[lit], least[lit], True),
        (ray[is_gap], gap_begin[is_gap], False),
        (ray[is_gap & ~is_last], gap_end[is_gap & ~is_last], False),
        (ray[is_behind], farthest[is_behind], False),
    ]
    missed = np.setdiff1d(np.arange(len(places)), ray)  # where nothing is met all is lit
    tests.append((missed, np.full(len(missed), (1 << 40) - 1024), True))
    return (
        np.concatenate([rays for rays, _, _ in tests]),
        np.concatenate([receivers for _, receivers, _ in tests]) * _UNIT,
        np.concatenate([np.full(len(rays), truth) for rays, _, truth in tests]),
    )
