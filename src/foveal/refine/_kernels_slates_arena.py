# mypy: allow-untyped-defs, allow-untyped-calls
"""Where runs of rows lie in one growing arena: those given back are lent again by size.

Sizes are rounded up to a quarter of their highest bit: blocks of (2^d + 1)^2 lose a tenth to a fifth so.
"""

from foveal.base.jit import lean

CLASSES = 256


@lean
def class_of(size):
    """The number of the least rounded size that is no smaller: 4 to an octave."""
    if size <= 4:
        return size
    exponent, rest = 0, size - 1
    while rest >= 8:
        rest >>= 1
        exponent += 1
    return 4 * exponent + rest + 1


@lean
def room(kind):
    """The rounded size of a class."""
    if kind <= 4:
        return kind
    exponent = (kind - 5) // 4
    return (kind - 4 * exponent) << exponent


@lean
def allocate(sizes, places, heads, nodes, top):
    """Places for runs; what does not fit in what was given back begins at `top`, which is returned anew.

    nodes[i]: a place that was given back, and the next of its size; heads[-1]: the first node not in
    use, heads[-2]: how many are.
    """
    for i in range(len(sizes)):
        kind = class_of(sizes[i])
        node = heads[kind]
        if kind == 0:
            places[i] = 0
        elif node >= 0:
            places[i], heads[kind] = nodes[node, 0], nodes[node, 1]
            nodes[node, 1], heads[-1] = heads[-1], node
            heads[-2] -= 1
        else:
            places[i] = top
            top += room(kind)
    return top


@lean
def release(sizes, places, heads, nodes):
    """Give runs back; there must be as many nodes not in use."""
    for i in range(len(sizes)):
        kind = class_of(sizes[i])
        if kind > 0:
            node = heads[-1]
            heads[-1] = nodes[node, 1]
            nodes[node, 0], nodes[node, 1], heads[kind] = places[i], heads[kind], node
            heads[-2] += 1


@lean
def clear(sizes, places, rows):
    """Zeros in the rows of runs."""
    for i in range(len(sizes)):
        for o in range(places[i], places[i] + sizes[i]):
            for x in range(rows.shape[1]):
                rows[o, x] = 0
