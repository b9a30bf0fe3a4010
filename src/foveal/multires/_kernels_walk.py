# mypy: allow-untyped-defs, allow-untyped-calls
"""Upper bounds of the way from single triangles to another triangulation of nearly the same surface.

A triangle is cut into pieces, each of which is given to a triangle of the other. The distance to a
triangle is a convex function, since a triangle is a convex set: on a piece it is largest at a corner. So
whatever the cuts and whoever gets a piece, the largest corner distance is a true bound; good cuts only
make it tight. The cuts are along walls.
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_surface import squared_to_face, wall


@lean
def farthest(polygons, at, count, positions, faces, g):
    """Largest squared distance from the corners of polygon `at` to face g."""
    worst = 0.0
    for i in range(count):
        x, y, z = polygons[at, i, 0], polygons[at, i, 1], polygons[at, i, 2]
        worst = max(worst, squared_to_face(x, y, z, positions, faces, g))
    return worst


@lean
def cut(work, now, count, sides, stack, top):
    """Both parts of the convex polygon work[now]: what is inside to work[1 - now], outside to stack[top].

    sides[i] are its corners' signed distances to the wall. Returns the numbers of corners.
    """
    n_in, n_out, other = 0, 0, 1 - now
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        p, q = sides[i], sides[j]
        if p >= 0.0:
            for axis in range(3):
                work[other, n_in, axis] = work[now, i, axis]
            n_in += 1
        if p <= 0.0:
            for axis in range(3):
                stack[top, n_out, axis] = work[now, i, axis]
            n_out += 1
        if (p > 0.0 and q < 0.0) or (p < 0.0 and q > 0.0):
            s = p / (p - q)
            for axis in range(3):
                x = work[now, i, axis] + s * (work[now, j, axis] - work[now, i, axis])
                work[other, n_in, axis] = x
                stack[top, n_out, axis] = x
            n_in += 1
            n_out += 1
    return n_in, n_out


@lean
def measure(
    positions,
    faces,
    which,
    onto_positions,
    onto_faces,
    onto_twins,
    start,
    carried,
    is_coarse_to_fine,
    suspicious,
    slack,
    stack,
    stack_info,
    work,
    sides,
    errors,
    later,
    later_face,
):
    """Raise `errors` of the coarse faces to bound the way from those of `faces` in `which`.

    start[f] is where the search for face f's pieces begins. carried are the fine faces' own errors, which
    a piece brings along. errors are of the coarse faces: `faces` if is_coarse_to_fine, else `onto_faces`.
    Triangles of pieces farther than `suspicious` go to `later` (k, 3, 3) with their face, as long as there
    is room. stack (k, 20, 3), stack_info (k, 4), work (2, 20, 3) and sides (20,) are scratch. Returns how
    many wait in `later`.
    """
    limit = len(stack) - 4
    waiting = 0
    for f in which:
        for i in range(3):
            for axis in range(3):
                stack[0, i, axis] = positions[faces[f, i], axis]
        stack_info[0, 0], stack_info[0, 1], stack_info[0, 2], stack_info[0, 3] = 3, start[f], -1, 0
        top = 1
        while top > 0:
            top -= 1
            count, g, came, depth = (
                np.int64(stack_info[top, 0]),
                np.int64(stack_info[top, 1]),
                np.int64(stack_info[top, 2]),
                np.int64(stack_info[top, 3]),
            )
            now = np.int64(0)  # no literal: each would be a signature of its own to compile
            for i in range(count):
                work[0, i, 0] = stack[top, i, 0]
                work[0, i, 1] = stack[top, i, 1]
                work[0, i, 2] = stack[top, i, 2]
            for k in range(3):
                beyond = np.int64(onto_twins[g, k])
                if beyond < 0 or 3 * g + k == came or depth >= 24 or top >= limit or count > 9:
                    continue
                a, b, c, d = wall(onto_positions, onto_faces, onto_twins, g, k)
                least = 0.0
                for i in range(count):
                    side = a * work[now, i, 0] + b * work[now, i, 1] + c * work[now, i, 2] + d
                    sides[i] = side
                    least = min(least, side)
                if least >= -slack:  # not worth a cut: the distance tells the truth all the same
                    continue
                n_in, n_out = cut(work, now, count, sides, stack, top)
                stack_info[top, 0], stack_info[top, 1] = n_out, beyond // 3
                stack_info[top, 2], stack_info[top, 3] = beyond, depth + 1
                top += 1
                now = 1 - now
                count = n_in
                if n_in < 3:
                    break
            if count < 3:
                continue
            coarse, base = (f, carried[g]) if is_coarse_to_fine else (g, carried[f])
            d = math.sqrt(farthest(work, now, count, onto_positions, onto_faces, g))
            if d <= suspicious or waiting + count > len(later):
                errors[coarse] = max(errors[coarse], base + d)
                continue
            for i in range(2, count):
                for axis in range(3):
                    later[waiting, 0, axis] = work[now, 0, axis]
                    later[waiting, 1, axis] = work[now, i - 1, axis]
                    later[waiting, 2, axis] = work[now, i, axis]
                later_face[waiting] = f
                waiting += 1
    return waiting
