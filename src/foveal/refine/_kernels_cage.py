# mypy: allow-untyped-defs, allow-untyped-calls
"""One-rings of a control mesh, and its sectors between sharp edges."""

from foveal.base.jit import kernel


@kernel
def first_faces(faces, beside, first, is_border):
    """first[v]: the face where the ring of v begins: at the border, or where the least neighbour is next."""
    first[:] = -1
    is_border[:] = False
    for f in range(len(faces)):
        for k in range(3):
            if beside[f, k] < 0:
                first[faces[f, k]] = f
                is_border[faces[f, k]] = True
    for f in range(len(faces)):
        for k in range(3):
            v, w = faces[f, k], faces[f, (k + 1) % 3]
            if is_border[v]:
                continue
            g = first[v]
            if g < 0:
                first[v] = f
                continue
            j = 0 if faces[g, 0] == v else (1 if faces[g, 1] == v else 2)
            if w < faces[g, (j + 1) % 3]:
                first[v] = f


@kernel
def rings(faces, beside, first, is_border, starts, ring):
    """Fill the rings; returns a vertex with several fans, or -1."""
    for v in range(len(first)):
        f, i = first[v], starts[v]
        while i < starts[v + 1]:
            k = 0 if faces[f, 0] == v else (1 if faces[f, 1] == v else 2)
            ring[i] = faces[f, (k + 1) % 3]
            i += 1
            g = beside[f, (k + 2) % 3]
            if g < 0:
                if i < starts[v + 1]:
                    ring[i] = faces[f, (k + 2) % 3]
                    i += 1
                break
            f = g
            if f == first[v]:
                break
        if i != starts[v + 1]:
            return v
    return -1


@kernel
def sectors(faces, beside, count, apart, origins):
    """Give each sector of a vertex's fan, between two edges with no face beside, a vertex of its own.

    apart: the faces at those; origins: -1 before, of each of `count` vertices and of the new ones the vertex
    it was. The first sector keeps its vertex, others get those after the last. Returns how many there are.
    """
    for first in range(len(faces)):
        for begin in range(3):
            if beside[first, begin] >= 0:
                continue
            v, new = faces[first, begin], faces[first, begin]
            if origins[v] >= 0:
                new = count
                count += 1
            origins[new] = v
            f, k = first, begin
            while f >= 0:
                apart[f, k] = new
                f = beside[f, (k + 2) % 3]
                if f >= 0:
                    k = 0 if faces[f, 0] == v else (1 if faces[f, 1] == v else 2)
    return count
