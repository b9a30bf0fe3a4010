# mypy: allow-untyped-defs, allow-untyped-calls
"""What a message is put together from."""

from foveal.base.jit import lean


@lean
def gather(words, ranges, out):
    """The words of all ranges, one after the other: by NumPy's slices each range takes a microsecond."""
    o = 0
    for r in range(len(ranges)):
        for i in range(ranges[r, 0], ranges[r, 1]):
            out[o] = words[i]
            o += 1
