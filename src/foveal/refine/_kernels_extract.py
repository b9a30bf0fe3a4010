# mypy: allow-untyped-defs, allow-untyped-calls
"""Which faces are in the vision frustum, face the eye, lie along the silhouette.

`view` is as in `_kernels_criteria.py`; `corners`, `beside` are (m, 3): vertices, and the face beyond the edge
from corner k to k + 1 or a negative number. `flags` (m,) carry what is known from one search, and iteration,
to the next.

Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
√3-subdivision, sections 6.1 and 6.2.
"""

import numpy as np

from foveal.base.jit import lean
from foveal.mesh._kernels_area import area_vector

from ._kernels_criteria import EYE, PLANES

NONE = -1

#: Flags of faces: wholly in the frustum; faces the eye; off the silhouette, so that all its parts are to face
#: alike; to be refined as front or back; along the silhouette; waiting for its swap; tested for facing.
INSIDE, FRONT, KNOWN, AREA, STRIP, SWAP, TESTED = 1, 2, 4, 8, 16, 32, 64

OUTSIDE, PARTLY, WHOLLY = 0, 1, 2


@lean
def side(positions, corners, f, view):
    """Whether face f is OUTSIDE a plane of the frustum, WHOLLY inside all of them, or neither."""
    found = WHOLLY
    for i in range(PLANES, PLANES + 20, 4):
        inside = 0
        for k in range(3):
            v = corners[f, k]
            x, y, z = positions[v, 0], positions[v, 1], positions[v, 2]
            if view[i] * x + view[i + 1] * y + view[i + 2] * z + view[i + 3] >= 0.0:
                inside += 1
        if inside == 0:
            return OUTSIDE
        if inside < 3:
            found = PARTLY
    return found


@lean
def is_front(positions, corners, f, view):
    """Whether the eye is on the outer side of face f; a face without area faces away."""
    x, y, z = area_vector(positions, corners, f)
    a = corners[f, 0]
    return (
        x * (view[EYE] - positions[a, 0])
        + y * (view[EYE + 1] - positions[a, 1])
        + z * (view[EYE + 2] - positions[a, 2])
    ) > 0.0


@lean
def keep_inside(positions, corners, flags, view, faces):
    """Move those of `faces` that are not outside the frustum to the front; returns how many.

    The others lose all flags. Those INSIDE by inheritance are not tested.
    """
    count = 0
    for i in range(len(faces)):
        f = np.int64(faces[i])
        if not flags[f] & INSIDE:
            found = side(positions, corners, f, view)
            if found == OUTSIDE:
                flags[f] = 0
                continue
            if found == WHOLLY:
                flags[f] |= INSIDE
        faces[count] = f
        count += 1
    return count


@lean
def face_the_eye(positions, corners, flags, view, faces):
    """Set FRONT anew for those of `faces` of which it is not KNOWN."""
    for i in range(len(faces)):
        f = np.int64(faces[i])
        if not flags[f] & KNOWN:
            flags[f] = (flags[f] & ~FRONT & 0xFF) | TESTED
            if is_front(positions, corners, f, view):
                flags[f] |= FRONT


@lean
def strips(positions, corners, beside, flags, marks, view, seeds, found):
    """found: the faces around the ends of silhouette edges; each is set STRIP. Returns how many.

    A silhouette edge is between one of `seeds` that is FRONT and a face that is not front; seeds that are not
    found are off the silhouette: KNOWN. `marks`, of vertices, are 0 and will be again: they are set where all
    faces around are found.
    """
    count = 0
    for i in range(len(seeds)):
        f = np.int64(seeds[i])
        if not flags[f] & FRONT:
            continue
        for k in range(3):
            n = np.int64(beside[f, k])
            if n < 0:
                continue
            # Most neighbours were tested with f: asked again, silhouettes took 1.3 times as long.
            is_tested = flags[n] & TESTED
            if not (flags[n] & FRONT if is_tested else is_front(positions, corners, n, view)):
                for j in (k, (k + 1) % 3):
                    v = corners[f, j]
                    if not marks[v]:
                        marks[v] = 1
                        count = gather_around(corners, beside, flags, f, j, found, count)
    for i in range(count):
        for k in range(3):
            marks[corners[found[i], k]] = 0
    for i in range(len(seeds)):
        if not flags[seeds[i]] & STRIP:
            flags[seeds[i]] |= KNOWN
    return count


@lean
def gather_around(corners, beside, flags, f, k, found, count):
    """Add the faces around corner k of face f to the `count` found ones, those that are no STRIP yet."""
    v = corners[f, k]
    for is_back in (False, True):
        g, j = f, k
        while True:
            if not flags[g] & STRIP:
                flags[g] = (flags[g] & ~KNOWN & 0xFF) | STRIP
                found[count] = g
                count += 1
            g = np.int64(beside[g, j if is_back else (j + 2) % 3])
            if g == f:
                return count
            if g < 0:
                break
            j = corner_of(corners, g, v)
    return count


@lean
def corner_of(corners, f, v):
    """Which corner of face f vertex v is."""
    return 0 if corners[f, 0] == v else (1 if corners[f, 1] == v else 2)
