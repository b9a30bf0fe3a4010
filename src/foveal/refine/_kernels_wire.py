# mypy: allow-untyped-defs, allow-untyped-calls
"""What a message is put together from."""

import numpy as np

from foveal.base.jit import lean


@lean
def gather(words, ranges, out):
    """The words of all ranges, one after the other: by NumPy's slices each range takes a microsecond."""
    o = 0
    for r in range(len(ranges)):
        for i in range(ranges[r, 0], ranges[r, 1]):
            out[o] = words[i]
            o += 1


@lean
def pack_colours(colours, ranges, out):
    """Colours from 0 to 255 as words, red lowest and 255 highest, of all rows in ranges."""
    for r in range(len(ranges)):
        for v in range(ranges[r, 0], ranges[r, 1]):
            word = 255 << 24
            for k in range(3):
                word |= int(np.rint(min(max(colours[v, k], 0.0), 255.0))) << (8 * k)
            out[v] = word
