# mypy: allow-untyped-defs, allow-untyped-calls
"""A tree's stream from the intervals of all pixels."""

from foveal.base.jit import lean

from ._kernels_stream import IS_ELSEWHERE, has_room, push, push_one


@lean
def up_from_pixels(up, lower, upper, levels, most):
    """Write the stream of (images, side, side) intervals; images past the last may be anything.

    False where the stream has no room for more.
    """
    images = lower.shape[0]
    dimensions = 3 if up.counts.shape[1] == 8 else 2
    far = 4294967295
    for code in range((1 << dimensions * levels) - 1, -1, -1):
        if not has_room(up):
            return False
        x = y = z = 0
        for bit in range(levels):
            part = code >> (dimensions * bit)
            x |= (part & 1) << bit
            y |= (part >> 1 & 1) << bit
            if dimensions == 3:
                z |= (part >> 2 & 1) << bit
        if z >= images:
            push_one(up, levels, 0, far, most)
        else:
            push_one(up, levels, lower[z, y, x], upper[z, y, x], most)
    return True


@lean
def up_from_roots(up, counts, bounds, is_inner, levels, most):
    """Write the stream above squares that have streams of their own, from their roots' sets."""
    for root in range(len(counts) - 1, -1, -1):
        if not has_room(up):
            return False
        for i in range(counts[root]):
            up.set_low[i] = bounds[root, i, 0]
            up.set_high[i] = bounds[root, i, 1]
        push(up, levels, counts[root], IS_ELSEWHERE if is_inner[root] else 0, most)
    return True
