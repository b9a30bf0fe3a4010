# mypy: allow-untyped-defs, allow-untyped-calls
"""The same bounds for the few pieces whose walk may have led to a wrong sheet: by search in boxes."""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_surface import squared_to_face
from ._kernels_walk import farthest


@lean
def file_faces(positions, faces, low, scale, size, starts, refs, is_counting):
    """Put each face into the boxes of a grid that its own box meets: first counting, then filling."""
    total = 0
    for f in range(len(faces)):
        i0, i1 = span(positions, faces, f, np.int64(0), low[0], scale, size[0])
        j0, j1 = span(positions, faces, f, np.int64(1), low[1], scale, size[1])
        k0, k1 = span(positions, faces, f, np.int64(2), low[2], scale, size[2])
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                for k in range(k0, k1 + 1):
                    box = (i * size[1] + j) * size[2] + k
                    if not is_counting:
                        refs[starts[box]] = f
                    starts[box] += 1
                    total += 1
    return total


@lean
def span(positions, faces, f, axis, low, scale, size):
    """First and last box that face f meets along an axis."""
    a, b, c = positions[faces[f, 0], axis], positions[faces[f, 1], axis], positions[faces[f, 2], axis]
    first = int((min(a, min(b, c)) - low) * scale)
    last = int((max(a, max(b, c)) - low) * scale)
    return min(size - 1, max(0, first)), min(size - 1, max(0, last))


@lean
def nearest_face(x, y, z, positions, faces, low, scale, size, starts, refs, guess):
    """(face, squared distance) of the face nearest to a point; `guess` is any face."""
    best = guess
    d_best = squared_to_face(x, y, z, positions, faces, guess)
    ci = min(size[0] - 1, max(0, int((x - low[0]) * scale)))
    cj = min(size[1] - 1, max(0, int((y - low[1]) * scale)))
    ck = min(size[2] - 1, max(0, int((z - low[2]) * scale)))
    most = max(size[0], max(size[1], size[2]))
    for ring in range(most):
        # All in rings before are at least (ring - 1) boxes away, as far as the point is in the grid;
        # outside it they are farther.
        if ring > 1 and (ring - 1) / scale * ((ring - 1) / scale) > d_best:
            break
        for i in range(max(0, ci - ring), min(size[0], ci + ring + 1)):
            for j in range(max(0, cj - ring), min(size[1], cj + ring + 1)):
                is_face = abs(i - ci) == ring or abs(j - cj) == ring
                step = 1 if is_face or ring == 0 else 2 * ring
                for k in range(ck - ring, ck + ring + 1, step):
                    if k < 0 or k >= size[2]:
                        continue
                    box = (i * size[1] + j) * size[2] + k
                    for r in range(starts[box], starts[box + 1]):
                        g = np.int64(refs[r])
                        d = squared_to_face(x, y, z, positions, faces, g)
                        if d < d_best:
                            best, d_best = g, d
    return best, d_best


@lean
def measure_closely(
    pending,
    pending_face,
    onto_positions,
    onto_faces,
    low,
    scale,
    size,
    starts,
    refs,
    start,
    carried,
    is_coarse_to_fine,
    enough,
    stack,
    near,
    far,
    errors,
):
    """Like `measure` for the few triangles that were suspicious: halved until three corners agree on a face.

    A triangle is done when one face is at most `enough` from all its corners, or at most 1.1 times as
    far as the farthest corner is from the surface (no bound can be less), or after 64 halvings. What is
    far below the farthest place found so far decides nothing, so that `enough` grows with it.
    """
    record = 0.0
    for t in range(len(pending)):
        f = pending_face[t]
        for i in range(3):
            for axis in range(3):
                stack[0, i, axis] = pending[t, i, axis]
            near[0, i], far[0, i] = nearest_face(
                pending[t, i, 0],
                pending[t, i, 1],
                pending[t, i, 2],
                onto_positions,
                onto_faces,
                low,
                scale,
                size,
                starts,
                refs,
                start[f] if i == 0 else near[0, i - 1],
            )
        top, halvings = 1, 0
        while top > 0:
            top -= 1
            lower = max(far[top, 0], max(far[top, 1], far[top, 2]))
            best, upper = near[top, 0], math.inf
            for i in range(3):
                worst = farthest(stack, top, np.int64(3), onto_positions, onto_faces, near[top, i])
                if worst < upper:
                    best, upper = near[top, i], worst
            record = max(record, lower)
            fine = max(max(enough * enough, 0.5 * record), 1.21 * lower)
            if upper <= fine or halvings >= 64 or top + 2 > len(stack):
                coarse, base = (f, carried[best]) if is_coarse_to_fine else (best, carried[f])
                errors[coarse] = max(errors[coarse], base + math.sqrt(upper))
                continue
            halvings += 1
            longest, edge = -1.0, 0
            for i in range(3):
                j = (i + 1) % 3
                length = (
                    (stack[top, i, 0] - stack[top, j, 0]) ** 2
                    + (stack[top, i, 1] - stack[top, j, 1]) ** 2
                    + (stack[top, i, 2] - stack[top, j, 2]) ** 2
                )
                if length > longest:
                    longest, edge = length, i
            j = (edge + 1) % 3
            x = 0.5 * (stack[top, edge, 0] + stack[top, j, 0])
            y = 0.5 * (stack[top, edge, 1] + stack[top, j, 1])
            z = 0.5 * (stack[top, edge, 2] + stack[top, j, 2])
            g, d = nearest_face(
                x,
                y,
                z,
                onto_positions,
                onto_faces,
                low,
                scale,
                size,
                starts,
                refs,
                near[top, edge],
            )
            for i in range(3):
                near[top + 1, i], far[top + 1, i] = near[top, i], far[top, i]
                for axis in range(3):
                    stack[top + 1, i, axis] = stack[top, i, axis]
            stack[top, j, 0], stack[top, j, 1], stack[top, j, 2] = x, y, z
            near[top, j], far[top, j] = g, d
            stack[top + 1, edge, 0], stack[top + 1, edge, 1], stack[top + 1, edge, 2] = x, y, z
            near[top + 1, edge], far[top + 1, edge] = g, d
            top += 2
