# mypy: allow-untyped-defs, allow-untyped-calls
"""Whether traced edges close to loops over all faces: borders, the faces over coarse vertices, chains.

Beside a border edge that both meshes have lies a strip without width, whose outside is the coarse edge
and whose inside the fine one. As a face of the fine mesh its number is -2 - (the fine half-edge).
"""

import math

import numpy as np

from foveal.base.jit import lean

from ._kernels_surface import fan_exit, squared_from
from ._kernels_trace import UNKNOWN

#: A half-edge that begins in no strip but in the face over its first vertex, which is found later.
INSIDE = -(1 << 31)

#: Faces around a border vertex: far beyond what is usual.
FAN = 1000


@lean
def outlines(
    positions,
    faces,
    twins,
    place,
    leaving,
    onto_positions,
    onto_faces,
    onto_twins,
    kept,
    begins,
    under,
    depth,
):
    """Match border edges: begins[half-edge of the coarse mesh] becomes the strip that lies beside it.

    leaving[v], the border half-edge from a fine vertex, becomes the strip's number too. Then the coarse
    half-edges from a matched border's vertex begin in the strip on their side of the fine vertex, which is
    over one of the faces around; those from other border vertices are UNKNOWN, all others INSIDE. Where a
    strip begins, under and depth are set as well.
    """
    leaving[:] = UNKNOWN
    under[:] = UNKNOWN
    begins[:] = INSIDE
    for f in range(len(faces)):
        for k in range(3):
            if twins[f, k] < 0:
                leaving[faces[f, k]] = 3 * f + k
    for half in range(3 * len(onto_faces)):
        g, k = half // 3, half % 3
        if onto_twins[g, k] >= 0:
            continue
        begins[half] = UNKNOWN
        a, b = onto_faces[g, k], onto_faces[g, (k + 1) % 3]
        v, w = kept[a], kept[b]
        fine = np.int64(leaving[v])
        if fine < 0 or faces[fine // 3, (fine % 3 + 1) % 3] != w:
            continue
        if is_same(positions, v, onto_positions, a) and is_same(positions, w, onto_positions, b):
            begins[half] = leaving[v] = -2 - fine
            under[a], depth[a] = fine // 3, 0.0
    for half in range(3 * len(onto_faces)):
        if onto_twins[half // 3, half % 3] < 0:
            fan(onto_faces, onto_twins, kept, place, begins, half)


@lean
def is_same(positions, v, onto_positions, z):
    """Whether two vertices are in one point."""
    return (
        positions[v, 0] == onto_positions[z, 0]
        and positions[v, 1] == onto_positions[z, 1]
        and positions[v, 2] == onto_positions[z, 2]
    )


@lean
def fan(faces, twins, kept, place, begins, border):
    """Let the half-edges around the vertex where a border half-edge begins begin in the strips there."""
    z = faces[border // 3, border % 3]
    under = place[kept[z]]
    last, is_over = np.int64(UNKNOWN), False
    for is_second in (False, True):
        g, is_past = border // 3, False
        for _ in range(FAN):
            is_past |= g == under
            k = fan_exit(faces, g, z, True)
            half = np.int64(twins[g, k])
            if half < 0:
                last = np.int64(begins[3 * g + k])
                break
            if is_second:
                is_known = is_over and begins[border] != UNKNOWN and last != UNKNOWN
                begins[half] = UNKNOWN if not is_known else (last if is_past else begins[border])
            g = half // 3
        is_over = is_past


@lean
def has_edge(twins, f, half):
    """Whether a half-edge or its twin is face f's."""
    twin = twins[half // 3, half % 3]
    return half // 3 == f or (twin >= 0 and twin // 3 == f)


@lean
def settle(
    positions,
    faces,
    twins,
    onto_positions,
    onto_faces,
    onto_twins,
    head,
    following,
    fine_half,
    first,
    votes,
    under,
    depth,
):
    """under[z]: the fine face over coarse vertex z, by the crossings next to it; how far it is.

    The nearest crossing on each edge from z is on an edge of that face, so each votes for the two faces
    that its fine edge has. A search by distance or walls would often come to the face beside.
    """
    first[:] = UNKNOWN
    votes[:] = 0
    for edge in range(3 * len(onto_faces)):
        g, k = edge // 3, edge % 3
        i = np.int64(head[edge])
        if i < 0:
            continue
        for is_end in (False, True):
            z = onto_faces[g, (k + 1) % 3] if is_end else onto_faces[g, k]
            while is_end and following[i] >= 0:
                i = np.int64(following[i])
            half = np.int64(fine_half[i])
            if first[z] == UNKNOWN:
                first[z] = half
            known = np.int64(first[z])
            twin = np.int64(twins[known // 3, known % 3])
            votes[z, 0] += has_edge(twins, known // 3, half)
            votes[z, 1] += twin >= 0 and has_edge(twins, twin // 3, half)
    for z in range(len(onto_positions)):
        if under[z] != UNKNOWN:
            continue
        half = np.int64(first[z])
        if half == UNKNOWN:
            continue
        f, d = half // 3, squared_from(onto_positions, z, positions, faces, half // 3)
        twin = np.int64(twins[f, half % 3])
        if twin >= 0 and votes[z, 1] >= votes[z, 0]:
            other = squared_from(onto_positions, z, positions, faces, twin // 3)
            if votes[z, 1] > votes[z, 0] or other < d:
                f, d = twin // 3, other
        under[z], depth[z] = f, math.sqrt(d)
    for _ in range(2):  # a vertex whose edges nothing crosses is under the same face as their other ends
        for here in range(3 * len(onto_faces)):
            g, k = here // 3, here % 3
            a, b = onto_faces[g, k], onto_faces[g, (k + 1) % 3]
            edge = min(here, onto_twins[g, k]) if onto_twins[g, k] >= 0 else here
            if under[a] == UNKNOWN and under[b] != UNKNOWN and head[edge] < 0:
                under[a] = under[b]
                depth[a] = math.sqrt(squared_from(onto_positions, a, positions, faces, under[b]))


@lean
def verify(faces, twins, onto_faces, onto_twins, begins, head, following, fine_half, is_open, is_open_onto):
    """Follow each coarse edge over the fine faces; where the chain breaks, the faces at it are open."""
    for edge in range(3 * len(onto_faces)):
        twin = np.int64(onto_twins[edge // 3, edge % 3])
        if 0 <= twin < edge:
            continue
        now, last = np.int64(begins[edge]), np.int64(begins[twin]) if twin >= 0 else np.int64(begins[edge])
        is_whole = now != UNKNOWN
        if twin >= 0:  # where faces disagree about the outside, the twin begins at the same end
            is_whole &= onto_faces[twin // 3, twin % 3] == onto_faces[edge // 3, (edge % 3 + 1) % 3]
        i = np.int64(head[edge]) if twin >= 0 else np.int64(-1)
        while i >= 0 and is_whole:
            now = step(twins, following, fine_half, i, now)
            is_whole = now != UNKNOWN
            i = np.int64(following[i])
        if is_whole and now == last:
            continue
        is_open_onto[edge // 3] = True
        if twin >= 0:
            is_open_onto[twin // 3] = True
        if begins[edge] >= 0:
            is_open[begins[edge]] = True
        if last >= 0:
            is_open[last] = True
        i = np.int64(head[edge])
        while i >= 0:
            half = np.int64(fine_half[i])
            is_open[half // 3] = True
            if twins[half // 3, half % 3] >= 0:
                is_open[twins[half // 3, half % 3] // 3] = True
            i = np.int64(following[i])


@lean
def step(twins, following, fine_half, i, now):
    """Over the crossing i of a list: from face `now` to the face beyond, or UNKNOWN.

    Crossings at nearly one place may be listed in the wrong order: the next few are tried in its stead.
    """
    j = i
    for _ in range(6):
        if j < 0:
            break
        half = np.int64(fine_half[j])
        twin = np.int64(twins[half // 3, half % 3])
        outside = twin // 3 if twin >= 0 else -2 - half
        if half // 3 == now or outside == now:
            fine_half[j] = fine_half[i]
            fine_half[i] = half
            return outside if half // 3 == now else half // 3
        j = np.int64(following[j])
    return np.int64(UNKNOWN)


@lean
def begin_inside(onto_faces, onto_twins, under, begins, is_rim):
    """Half-edges that begin inside begin in the face over their first vertex, unless a border is there."""
    is_rim[:] = False
    for half in range(3 * len(onto_faces)):
        g, k = half // 3, half % 3
        if onto_twins[g, k] < 0:
            is_rim[onto_faces[g, k]] = is_rim[onto_faces[g, (k + 1) % 3]] = True
    for half in range(3 * len(onto_faces)):
        if begins[half] == INSIDE:
            z = onto_faces[half // 3, half % 3]
            begins[half] = UNKNOWN if is_rim[z] else under[z]


@lean
def corners(
    faces, place, distance, onto_faces, under, depth, carried, suspicious, errors, is_open, is_open_onto
):
    """What the vertices of both meshes say, as `trace` does of the crossings."""
    for f in range(len(faces)):
        for k in range(3):
            g, d = place[faces[f, k]], distance[faces[f, k]]
            if d <= suspicious:
                errors[g] = max(errors[g], carried[f] + d)
            else:
                is_open[f] = is_open_onto[g] = True
    for g in range(len(onto_faces)):
        for k in range(3):
            f, d = under[onto_faces[g, k]], depth[onto_faces[g, k]]
            if f >= 0 and d <= suspicious:
                errors[g] = max(errors[g], carried[f] + d)
            else:
                is_open_onto[g] = True
                if f >= 0:
                    is_open[f] = True
