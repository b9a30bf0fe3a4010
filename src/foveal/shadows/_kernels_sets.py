# mypy: allow-untyped-defs, allow-untyped-calls
"""Sets of legal values as a few intervals, and what most of a node's children agree on.

An interval is two int64, both ends legal, from 0 to FAR. A set is a row of `low` and `high` with the number
of its intervals, ascending and apart from each other.
"""

from foveal.base.jit import lean

KEPT = 8
"""Intervals a set keeps at most; of more the narrowest go: the tree is as right, by hardly a node larger."""


@lean
def agree(counts, low, high, children, most, ends, steps, out_low, out_high):
    """The values that lie in most of the children's sets: number of intervals, and in how many sets they lie.

    The set of a node that costs the fewest stored values, whatever is above it (Hartigan 1973, for the
    parsimony of trees with many branches). With `most` = 1 the lowest interval alone is kept, which is the
    greedy rule of Scandolo et al. 2016, algorithm 2. `ends` and `steps` are scratch, for 2 KEPT numbers of
    each child.
    """
    if all_single(counts, children):
        lower, upper = low[0, 0], high[0, 0]
        for child in range(1, children):
            lower = max(lower, low[child, 0])
            upper = min(upper, high[child, 0])
        if lower <= upper:
            out_low[0] = lower
            out_high[0] = upper
            return 1, children
    size = 0
    for child in range(children):
        for i in range(counts[child]):
            size = insert(ends, steps, size, low[child, i], 1)
            size = insert(ends, steps, size, high[child, i] + 1, -1)
    # Ends at one place are one event: intervals that touch go on, and what is over before is not counted.
    found, best, depth, begin = 0, 0, 0, 0
    at = 0
    while at < size:
        place = ends[at]
        before = depth
        while at < size and ends[at] == place:
            depth += steps[at]
            at += 1
        if depth == before:
            continue
        if before == best and best > 0:
            found = keep(out_low, out_high, found, begin, place - 1, most)
        if depth > best:
            best, found = depth, 0
        begin = place
    return found, best


@lean
def all_single(counts, children):
    """Whether each set is one interval."""
    many = 0
    for child in range(children):
        many += counts[child] != 1
    return many == 0


@lean
def insert(ends, steps, size, place, step):
    """Put an end in order; the new size."""
    at = size
    while at > 0 and ends[at - 1] > place:
        ends[at] = ends[at - 1]
        steps[at] = steps[at - 1]
        at -= 1
    ends[at] = place
    steps[at] = step
    return size + 1


@lean
def keep(low, high, found, begin, end, most):
    """Append an interval, in place of the narrowest where there are `most`; how many there are then."""
    if found < most:
        low[found] = begin
        high[found] = end
        return found + 1
    if most == 1:
        return 1
    narrowest = 0
    for i in range(1, found):
        if high[i] - low[i] < high[narrowest] - low[narrowest]:
            narrowest = i
    if high[narrowest] - low[narrowest] < end - begin:
        for i in range(narrowest, found - 1):
            low[i] = low[i + 1]
            high[i] = high[i + 1]
        low[found - 1] = begin
        high[found - 1] = end
    return found


@lean
def shortest(low, high):
    """Fewest bits b, and v with low <= v <= high, such that v + 1 is a multiple of 2^(32 - b)."""
    # The highest bit in which low and high + 1 differ is where the shortest multiple ends; where the bits
    # from there up have zeros at their end, it is shorter still.
    top = high + 1
    differ = low ^ top
    bit = 0
    while differ >> (bit + 1):
        bit += 1
    value = (top >> bit) << bit
    while bit < 32 and value & ((2 << bit) - 1) == 0 and value > low:
        bit += 1
    return 32 - bit, value - 1
