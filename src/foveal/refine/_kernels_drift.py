# mypy: allow-untyped-defs, allow-untyped-calls
"""How long answers about a view hold.

An answer stays the same while neither distances between the eye and the surface, nor offsets of the surface
from planes of the frustum, have changed by more than its `near`, nor the eye has gone further than its `far`:
the frustum and lengths in pixels lean on the first, facings on the second. On an orbit distances change a
third to a sixth as fast as the eye goes. One count for both had half as many answers again end with a degree.

`drift` is (word, steps): the sum of both until now, in whole steps, and how many of those are in a unit of
length. A word holds two counts, `near` above `far`, each below 2^31; another is up to where an answer holds.
"""

import math

from foveal.base.jit import inlined, kernel

from ._kernels_criteria import PLANES

#: Up to where an answer holds that is to be asked anew in any case, or that no drift can end.
EXPIRED, NEVER = 0, 2**63 - 1

#: A count's most: two of these are below 2^31.
MOST = 2**30 - 1

LOW = 2**32 - 1


@inlined
def until(drift, near, far):
    """The word up to which an answer holds that was given now."""
    word, steps = drift
    above, below = min(max(near * steps, 0.0), MOST * 1.0), min(max(far * steps, 0.0), MOST * 1.0)
    return word + (int(above) << 32) + int(below)


@inlined
def holds(word, drift):
    """Whether an answer up to a word still holds."""
    return (word >> 32) > (drift[0] >> 32) and (word & LOW) > (drift[0] & LOW)


@inlined
def both(one, other):
    """The word up to which two answers hold."""
    return (min(one >> 32, other >> 32) << 32) + min(one & LOW, other & LOW)


@kernel
def moved(before, view, corners):
    """(near, far) from one view to the next; corners (8, 3) of a box around all points."""
    dx, dy, dz = view[0] - before[0], view[1] - before[1], view[2] - before[2]
    far = math.sqrt(dx * dx + dy * dy + dz * dz)
    near, along = 0.0, 0.0
    for i in range(len(corners)):
        x, y, z = corners[i, 0], corners[i, 1], corners[i, 2]
        for k in range(PLANES, PLANES + 20, 4):
            nx, ny, nz = view[k] - before[k], view[k + 1] - before[k + 1], view[k + 2] - before[k + 2]
            near = max(near, abs(nx * x + ny * y + nz * z + view[k + 3] - before[k + 3]))
        for eye in (before, view):
            along = max(along, abs(dx * (eye[0] - x) + dy * (eye[1] - y) + dz * (eye[2] - z)))
    # A distance changes by the cosine between the way and the line of sight, which is linear in both the eye
    # and the point before it is divided by the distance; and that is nowhere less than this.
    gap = 0.5 * (outside(before, corners) + outside(view, corners) - far)
    return max(near, min(far, along / gap) if gap > 0.0 else far), far


@inlined
def outside(view, corners):
    """How far the eye is from the box."""
    total = 0.0
    for axis in range(3):
        low = high = corners[0, axis]
        for i in range(len(corners)):
            low, high = min(low, corners[i, axis]), max(high, corners[i, axis])
        gap = max(0.0, max(low - view[axis], view[axis] - high))
        total += gap * gap
    return math.sqrt(total)
