# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops that carry triangles between partitions: join and split pieces, weld vertices, odd edges."""

import numpy as np

from foveal.base.jit import lean
from foveal.mesh._kernels_area import area_vector

MISSING = -1


@lean
def to_grid(positions, faces, ratio, offset, moved, out, errors):
    """Round positions * ratio to `out`; errors[f] bounds how far face f moved, `offset` included.

    moved (n,) is scratch.
    """
    for v in range(len(positions)):
        squared = 0.0
        for axis in range(3):
            x = positions[v, axis] * ratio
            q = np.rint(x)
            out[v, axis] = np.int32(q)
            squared += (q - x) * (q - x)
        moved[v] = np.sqrt(squared) + offset
    for f in range(len(faces)):
        most = max(moved[faces[f, 0]], max(moved[faces[f, 1]], moved[faces[f, 2]]))
        errors[f] = most * (1 + 1e-6)


@lean
def join(ids, table, keys, local, unique):
    """Number equal ids: local[i] is the number of ids[i], unique[local[i]] the first i that has it.

    table and keys are scratch of a power of two, at least twice as many as there are ids.
    """
    mask = len(table) - 1
    table[:] = MISSING
    count = 0
    for i in range(len(ids)):
        slot = (ids[i] * 2654435761) & mask
        while table[slot] != MISSING and keys[slot] != ids[i]:
            slot = (slot + 1) & mask
        if table[slot] == MISSING:
            table[slot] = count
            keys[slot] = ids[i]
            unique[count] = i
            count += 1
        local[i] = table[slot]
    return count


@lean
def claim(ids, cell, owner):
    """Write down that `cell` uses these ids: owner -1 nobody yet, -2 several."""
    for i in ids:
        if owner[i] == -1:
            owner[i] = cell
        elif owner[i] != cell:
            owner[i] = -2


@lean
def is_shared(ids, owner, out):
    """Whether several cells use the id."""
    for i in range(len(ids)):
        out[i] = owner[ids[i]] == -2


@lean
def split(faces, cell_of, number, first_face, order, stamps, index, vertices, first_vertex, local_faces):
    """Group faces by cell, each group with vertices of its own.

    number : how many cells. Out: order (m,) the faces grouped, first_face (number + 1,); vertices, the
    original index of each group's vertices one group after the other, first_vertex (number + 1,);
    local_faces (m, 3) in the order of `order`. stamps (n,) and index (n,) are scratch.
    """
    first_face[:] = 0
    for f in range(len(faces)):
        first_face[cell_of[f] + 1] += 1
    for c in range(number):
        first_face[c + 1] += first_face[c]
    for f in range(len(faces)):
        c = cell_of[f]
        order[first_face[c]] = f
        first_face[c] += 1
    for c in range(number, 0, -1):
        first_face[c] = first_face[c - 1]
    first_face[0] = 0
    stamps[:] = -1
    total = 0
    for c in range(number):
        first_vertex[c] = total
        for i in range(first_face[c], first_face[c + 1]):
            for k in range(3):
                v = faces[order[i], k]
                if stamps[v] != c:
                    stamps[v] = c
                    index[v] = total - first_vertex[c]
                    vertices[total] = v
                    total += 1
                local_faces[i, k] = index[v]
    first_vertex[number] = total
    return total


@lean
def vertex_normals(positions, faces, out):
    """Sum of the area vectors of the faces around each vertex, (n, 3) float64."""
    out[:] = 0.0
    for f in range(len(faces)):
        x, y, z = area_vector(positions, faces, f)
        for k in range(3):
            v = faces[f, k]
            out[v, 0] += x
            out[v, 1] += y
            out[v, 2] += z


@lean
def mix(a, b, c):
    """A hash of three 64-bit patterns."""
    h = a * np.uint64(0x9E3779B97F4A7C15)
    h = (h ^ (h >> np.uint64(29))) + b
    h = h * np.uint64(0xBF58476D1CE4E5B9)
    h = (h ^ (h >> np.uint64(32))) + c
    h = h * np.uint64(0x94D049BB133111EB)
    return h ^ (h >> np.uint64(31))


@lean
def weld(bits, first, group, groups, table, keys, twin):
    """twin[i] = number of the first vertex with exactly the same position, for hashes that fall into `group`.

    bits (k, 3) uint64 are the coordinates' bit patterns of a block whose first vertex has number `first`;
    table (-1 where free) and keys are kept between blocks. Returns how many new positions came.
    """
    mask = np.uint64(len(table) - 1)
    fresh = 0
    for i in range(len(bits)):
        h = mix(bits[i, 0], bits[i, 1], bits[i, 2])
        if (h >> np.uint64(40)) % np.uint64(groups) != np.uint64(group):
            continue
        slot = h & mask
        while table[slot] != MISSING and not (
            keys[slot, 0] == bits[i, 0] and keys[slot, 1] == bits[i, 1] and keys[slot, 2] == bits[i, 2]
        ):
            slot = (slot + np.uint64(1)) & mask
        if table[slot] == MISSING:
            table[slot] = first + i
            keys[slot, 0], keys[slot, 1], keys[slot, 2] = bits[i, 0], bits[i, 1], bits[i, 2]
            fresh += 1
        twin[i] = table[slot]
    return fresh


@lean
def odd_edges(faces, starts, counts, refs, locked, open_edges, totals):
    """Count what is odd: totals = (edges of one face, edges of more than two, faces there already, open).

    Edges between locked vertices may have more faces elsewhere: they go to `open_edges` (k, 3) as (a, b,
    faces here). starts, counts and refs are the faces around each vertex.
    """
    totals[:] = 0
    for f in range(len(faces)):
        for k in range(3):
            a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            if counts[b] < counts[a]:
                a, b = b, a
            uses, is_first, is_copy = 0, True, False
            for i in range(starts[a], starts[a] + counts[a]):
                g = refs[i]
                if faces[g, 0] == b or faces[g, 1] == b or faces[g, 2] == b:
                    uses += 1
                    if g < f:
                        is_first = False
                        is_copy |= faces[g, 0] == c or faces[g, 1] == c or faces[g, 2] == c
            if k == 0 and is_copy:
                totals[2] += 1
            if not is_first:
                continue
            if locked[a] and locked[b]:
                open_edges[totals[3], 0] = a
                open_edges[totals[3], 1] = b
                open_edges[totals[3], 2] = uses
                totals[3] += 1
            elif uses == 1:
                totals[0] += 1
            elif uses > 2:
                totals[1] += 1
