# mypy: allow-untyped-defs, allow-untyped-calls
"""A step of Catmull and Clark's rules on any polygons, with those of DeRose, Kass and Truong for creases.

In loops of one order, as in the page: products of sparse matrices sum in orders of their own.
"""

from foveal.base.jit import lean


@lean
def step_points(starts, corners, edge, ends, sharp, kept, around, now, later, rows, out):
    """Rows of three after a step: of old vertices, then one an edge, then one a face."""
    vertices, edges = len(rows), len(ends)
    for x in range(3):
        for f in range(len(starts) - 1):
            size, total = starts[f + 1] - starts[f], 0.0
            for h in range(starts[f], starts[f + 1]):
                total += (1 / size) * rows[corners[h], x]
            out[vertices + edges + f, x] = total
        for f in range(len(starts) - 1):
            for h in range(starts[f], starts[f + 1]):
                share = 1 - min(sharp[edge[h]], 1.0)
                out[vertices + edge[h], x] += share * 0.25 * out[vertices + edges + f, x]
        for e in range(edges):
            share = min(sharp[e], 1.0)
            both = rows[ends[e, 0], x] + rows[ends[e, 1], x]
            out[vertices + e, x] += (0.5 * share + 0.25 * (1 - share)) * both
        for v in range(vertices):
            out[v, x] = kept[v] * rows[v, x]
        for e in range(edges):
            for k in range(2):
                v, s = ends[e, k], sharp[e]
                weight = around[v]
                if s > 0:
                    weight += now[v]
                if s > 1:
                    weight += later[v]
                out[v, x] += weight * rows[ends[e, 1 - k], x]
        for f in range(len(starts) - 1):
            for h in range(starts[f], starts[f + 1]):
                out[corners[h], x] += around[corners[h]] * out[vertices + edges + f, x]
