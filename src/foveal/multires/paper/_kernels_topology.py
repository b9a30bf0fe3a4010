# mypy: allow-untyped-defs, allow-untyped-calls
"""Which half-edge lies on the other side of which.

Half-edge 3 f + k goes from corner k of triangle f to corner (k + 1) mod 3. The paper sorts all edges by
their two vertices; two passes of a counting sort do the same in linear time, whatever the valences.
"""

from foveal.base.jit import kernel


@kernel
def _count_sort(keys, order, counts, out):
    """out = `order` sorted by keys[order[i]], equal ones as they were; `counts` is scratch."""
    for i in range(len(counts)):
        counts[i] = 0
    for i in range(len(order)):
        counts[keys[order[i]] + 1] += 1
    for i in range(1, len(counts)):
        counts[i] += counts[i - 1]
    for i in range(len(order)):
        key = keys[order[i]]
        out[counts[key]] = order[i]
        counts[key] += 1


@kernel
def pair_edges(faces, low, high, order, spare, counts, twins):
    """twins[h] = the half-edge that runs the other way between the same vertices, or -1.

    Of several triangles at an edge, the first half-edge one way is paired with the first the other way,
    and so on; the rest are artificial boundaries, as are an edge from a vertex to itself and two edges
    of one triangle. `low`, `high`, `order`, `spare` hold a number a half-edge, `counts` one a vertex
    and two more.
    """
    for f in range(len(faces)):
        for k in range(3):
            a = faces[f, k]
            b = faces[f, (k + 1) % 3]
            low[3 * f + k] = min(a, b)
            high[3 * f + k] = max(a, b)
            order[3 * f + k] = 3 * f + k
            twins[3 * f + k] = -1
    _count_sort(high, order, counts, spare)
    _count_sort(low, spare, counts, order)
    begin = 0
    while begin < len(order):
        first = order[begin]
        end = begin + 1
        while end < len(order) and low[order[end]] == low[first] and high[order[end]] == high[first]:
            end += 1
        if low[first] != high[first]:
            _pair_group(faces, order, low, begin, end, twins)
        begin = end


@kernel
def _pair_group(faces, order, low, begin, end, twins):
    """Pair the half-edges order[begin:end], all between the same two vertices, first with first."""
    up = begin
    down = begin
    while True:
        while up < end and faces[order[up] // 3, order[up] % 3] != low[order[up]]:
            up += 1
        while down < end and faces[order[down] // 3, order[down] % 3] == low[order[down]]:
            down += 1
        if up >= end or down >= end:
            return
        if order[up] // 3 != order[down] // 3:
            twins[order[up]] = order[down]
            twins[order[down]] = order[up]
        up += 1
        down += 1
