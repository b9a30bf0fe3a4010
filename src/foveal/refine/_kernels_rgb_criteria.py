# mypy: allow-untyped-defs, allow-untyped-calls
"""Whether an edge of uniform subdivision is to be split for a view: from what both its triangles share.

`view` and `limits` are those of `_kernels_criteria.py`; level, frustum, facing, silhouette, edge length come
in the same order. An edge knows the normals of its ends, each that of the two triangles between which the end
was born, and how far those spread; so it is on the silhouette if they face different ways, or would if the
surface bent as much again.
"""

import math

from foveal.base.jit import lean

from ._kernels_criteria import (
    BACK,
    BALL,
    EYE,
    FRONT,
    ITERATIONS,
    PIXELS,
    PLANES,
    SILHOUETTE,
    judge,
    trusted,
)
from ._kernels_rgb_address import LEVELS
from ._kernels_rgb_layout import WANTED
from ._kernels_rgb_points import ensure_at, position


@lean
def is_asked(net, a, b, level):
    """Whether it matters if the edge a, b of a level meets the criteria, by the splits that make it.

    Those of the control mesh always matter; a half of a split edge if that is wanted; an inner edge, which
    joins the middles of two, if one of these is wanted, and the other wanted or taken by a half that is.
    Were both to be wanted, one in eight triangles seen of a machine's part kept too long an edge beside thin
    triangles. Would one do, it might not be there yet: to ask it all the same was a third of an orbit's time.
    """
    if level == 0:
        return True
    one, two = net.vertices[a].flags & WANTED != 0, net.vertices[b].flags & WANTED != 0
    if net.vertices[a].birth != level:
        return two
    if net.vertices[b].birth != level:
        return one
    return (one and (two or net.vertices[b].halves > 0)) or (two and net.vertices[a].halves > 0)


@lean
def spread_of(net, a, b, level):
    """How much normals vary about an edge and as much again: of what its newest ends were born between."""
    spread = 0.0
    if net.vertices[a].birth == level:
        spread = max(spread, net.vertices[a].spread)
    if net.vertices[b].birth == level:
        spread = max(spread, net.vertices[b].spread)
    return spread


@lean
def wants_edge(net, a, b, level, view, limits):
    """(is wanted, near, far) of the edge a, b of a level, whatever its parents are.

    For how long the answer stays the same `near` and `far` say as in `_kernels_drift.py`.
    """
    most = max(limits[FRONT, ITERATIONS], max(limits[SILHOUETTE, ITERATIONS], limits[BACK, ITERATIONS]))
    if level >= min(most, LEVELS):
        return False, math.inf, math.inf
    ensure_at(net, a, level)
    ensure_at(net, b, level)
    ax, ay, az = position(net, a, level)
    bx, by, bz = position(net, b, level)
    x, y, z = 0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz)
    ux, uy, uz = bx - ax, by - ay, bz - az
    length = math.sqrt(ux * ux + uy * uy + uz * uz)
    dx, dy, dz = view[EYE] - x, view[EYE + 1] - y, view[EYE + 2] - z
    away = math.sqrt(dx * dx + dy * dy + dz * dz)
    near = math.inf
    for i in range(PLANES, PLANES + 20, 4):
        inside = view[i] * x + view[i + 1] * y + view[i + 2] * z + view[i + 3] + BALL * length
        if inside < 0.0:
            return False, trusted(-inside, away), math.inf
        near = min(near, inside)
    n, m = net.vertices[a].normal, net.vertices[b].normal
    one, two = n[0] * dx + n[1] * dy + n[2] * dz, m[0] * dx + m[1] * dy + m[2] * dz
    spread = spread_of(net, a, b, level)
    # The surface is that much off the edge, too: an eye beneath a coarse edge may yet be above the surface.
    margin = spread * (away + length)
    front, back = min(one, two) - margin, -max(one, two) - margin
    kind = FRONT if front > 0.0 else (BACK if back > 0.0 else SILHOUETTE)
    # 1 - cos of the angle along the edge, and across it of half of what the newest ends have seen.
    bend = max(1.0 - (n[0] * m[0] + n[1] * m[1] + n[2] * m[2]), 0.125 * spread * spread)
    # A facing changes as quickly as the eye moves at most, the margin as quickly as the spread says.
    ease = 1.0 / (1.0 + spread)
    size = view[PIXELS] * length
    answer, margin, far = judge(limits, kind, level, bend, size, away, front * ease, back * ease)
    return answer, trusted(min(near, margin), away), trusted(far, away)
