# mypy: allow-untyped-defs, allow-untyped-calls
"""Whether a triangle is to be refined for a view: from its corners and limit normals alone.

`view` (24 or more,): the eye, pixels per radian, five frustum planes as (normal, offset). `limits` (3 or
more, 3): for front faces, silhouettes and back faces the most iterations, the edge in pixels that is short
enough, the bend that is flat enough. What else they hold is for `_kernels_hidden.py`.
"""

import math

from foveal.base.jit import lean

EYE, PIXELS, PLANES = 0, 3, 4

THIRD = 1.0 / 3.0

FRONT, SILHOUETTE, BACK = 0, 1, 2
ITERATIONS, EDGE, BEND = 0, 1, 2


#: A triangle is outside if a ball around its middle is, of this radius in longest edges: corners are at
#: most 1 / sqrt(3) away, and as much again is left for where refinement moves it.
BALL = 1.16


@lean
def longest_edge(ax, ay, az, bx, by, bz, cx, cy, cz):
    """Of the triangle a, b, c."""
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    wx, wy, wz = cx - bx, cy - by, cz - bz
    uu, vv, ww = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz
    return math.sqrt(max(uu, max(vv, ww)))


@lean
def is_wanted(view, limits, level, ax, ay, az, bx, by, bz, cx, cy, cz, normals, u, v, w):
    """(is wanted, near, far) of the triangle a, b, c of a level, at vertices u, v, w: whether to split it.

    In the paper's order: frustum, then facing, then silhouette. A silhouette passes where the triangle and
    the limit surface at its corner face different ways, or would if it bent as much again. Above level 0
    only the first corner's normal is asked: those of the others may not be there yet.

    For how long the answer stays the same `near` and `far` say as in `_kernels_drift.py`.
    """
    most = max(limits[FRONT, ITERATIONS], max(limits[SILHOUETTE, ITERATIONS], limits[BACK, ITERATIONS]))
    if level >= most:
        return False, math.inf, math.inf
    ux, uy, uz = bx - ax, by - ay, bz - az
    vx, vy, vz = cx - ax, cy - ay, cz - az
    longest = longest_edge(ax, ay, az, bx, by, bz, cx, cy, cz)
    x, y, z = (ax + bx + cx) * THIRD, (ay + by + cy) * THIRD, (az + bz + cz) * THIRD
    dx, dy, dz = view[EYE] - x, view[EYE + 1] - y, view[EYE + 2] - z
    away = math.sqrt(dx * dx + dy * dy + dz * dz)
    near = math.inf
    for i in range(PLANES, PLANES + 20, 4):
        inside = view[i] * x + view[i + 1] * y + view[i + 2] * z + view[i + 3] + BALL * longest
        if inside < 0.0:
            return False, trusted(-inside, away), math.inf
        near = min(near, inside)
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    length = math.sqrt(nx * nx + ny * ny + nz * nz)
    scale = 1.0 / length if length > 0.0 else 0.0
    low = high = (nx * dx + ny * dy + nz * dz) * scale
    least = 1.0
    for i in range(3 if level == 0 else 1):
        k = u if i == 0 else (v if i == 1 else w)
        mx, my, mz = normals[k, 0], normals[k, 1], normals[k, 2]
        facing = mx * dx + my * dy + mz * dz
        low, high = min(low, facing), max(high, facing)
        least = min(least, (mx * nx + my * ny + mz * nz) * scale)
    front, back = 2.0 * low - high, low - 2.0 * high
    kind = FRONT if front > 0.0 else (BACK if back > 0.0 else SILHOUETTE)
    # `low` changes as quickly as the eye moves at most, `high - low` by the normals' distance times that.
    spread = math.sqrt(max(2.0 - 2.0 * least, 0.0)) if level > 0 else 2.0
    ease = 1.0 / (1.0 + spread)
    size = view[PIXELS] * longest
    answer, margin, far = judge(limits, kind, level, 1.0 - least, size, away, front * ease, back * ease)
    return answer, trusted(min(near, margin), away), trusted(far, away)


@lean
def judge(limits, kind, level, bend, size, away, front, back):
    """(whether a kind's limits ask for more, how far distances, and the eye, may go before that changes).

    `front` and `back` say how far the eye is, at least, from where this would be a front or no front any
    more, a back or no back any more. Another kind that says the same is none to beware of: silhouettes become
    fronts as one looks around, but many are fine enough for both, or coarse enough: on an orbit a fourth
    of the answers that had to be given anew were such.
    """
    answer, near = is_coarse(limits, kind, level, bend, size, away)
    far = math.inf
    for other in range(3):
        if other == kind:
            continue
        until = -front if other == FRONT else (-back if other == BACK else max(front, back))
        same, beyond = is_coarse(limits, other, level, bend, size, away)
        if same == answer and beyond > until:
            near = min(near, beyond)
        else:
            far = min(far, until)
    return answer, near, far


@lean
def is_coarse(limits, kind, level, bend, size, away):
    """(whether a kind's limits ask for more, by how much distances may change before that does)."""
    if level >= limits[kind, ITERATIONS] or bend < limits[kind, BEND]:
        return False, math.inf
    if limits[kind, EDGE] <= 0.0:
        return True, math.inf
    reach = size / limits[kind, EDGE]
    return reach > away, abs(reach - away)


@lean
def trusted(slack, away):
    """A slack that rounding cannot have made too large."""
    return 0.999 * slack - 1e-12 * away
