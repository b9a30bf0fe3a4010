# mypy: allow-untyped-defs, allow-untyped-calls
"""Construction from the root down, as published: each node takes the depth that lies in most intervals.

The ends of all pixels' intervals are sorted once, and dealt out to the children with their order kept.

Based on: Scandolo, Bauszat, Eisemann 2016, algorithm 1. There a node sees the pixels alone that no node above
covers; but its value then holds for the others below it too, which may not allow it. Here it sees all.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.jit import lean


class Nodes(NamedTuple):
    """The nodes of one level: those of node i are `starts[i]` to `starts[i + 1]` of the ends."""

    keys: NDArray[
        np.int64
    ]  # ends of intervals, low << 1 | 1 or high + 1 << 1: at one place what is over first
    pixels: NDArray[np.int32]  # whose they are, in the order of the tree
    starts: NDArray[np.int64]
    inherited: NDArray[np.int64]  # the value that holds above, -1 above the root
    parents: NDArray[np.int64]  # which of the masks of the level above, -1 of the root
    numbers: NDArray[np.int64]  # which child


@lean
def best_value(keys, begin, end, inherited):
    """The depth that most of the intervals allow, how many do, and how many the inherited one."""
    depth, most, allowing = 0, 0, 0
    best = np.int64(0)
    for i in range(begin, end):
        place = keys[i] >> 1
        if keys[i] & 1:
            depth += 1
            if depth > most:
                most, best = depth, place
        else:
            depth -= 1
        if place <= inherited:
            allowing = depth
    return best, most, allowing


@lean
def decide(nodes, shift, above, masks, values, below):
    """Give the nodes of a level values and masks, and deal their ends out to their children, in `below`.

    `above` are the masks of the level above, where the nodes' kinds are entered; `shift` is of a child's
    number in a pixel's. Returns how many masks and values there are, how many children, and the kind of the
    last node.
    """
    made_masks, made_values, count, at, kind = 0, 0, 0, 0, 0
    for node in range(len(nodes.starts) - 1):
        begin, end = nodes.starts[node], nodes.starts[node + 1]
        value = nodes.inherited[node]
        best, most, allowing = best_value(nodes.keys, begin, end, value)
        kind = 0
        if most > allowing:
            kind = 1
            value = best
            values[made_values] = value
            made_values += 1
        if max(most, allowing) < (end - begin) >> 1:
            kind |= 2
            masks[made_masks] = 0
            for child in range(4):
                below.starts[count] = at
                for i in range(begin, end):
                    if nodes.pixels[i] >> shift & 3 == child:
                        below.keys[at] = nodes.keys[i]
                        below.pixels[at] = nodes.pixels[i]
                        at += 1
                below.inherited[count] = value
                below.parents[count] = made_masks
                below.numbers[count] = child
                count += 1
            made_masks += 1
        if nodes.parents[node] >= 0:
            above[nodes.parents[node]] |= kind << (2 * nodes.numbers[node])
    below.starts[count] = at
    return made_masks, made_values, count, kind
