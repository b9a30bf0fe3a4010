# mypy: allow-untyped-defs, allow-untyped-calls
"""Construction from the root down, as published: each node takes the depth that lies in most intervals.

The ends of all pixels' intervals are sorted once, and dealt out to the children with their order kept.

Based on: Scandolo, Bauszat, Eisemann 2016, algorithm 1. There a node sees the pixels alone that no node above
covers; but its value then holds for the others below it too, which may not allow it. Here it sees all.
"""

import numpy as np

from foveal.base.jit import lean


@lean
def best_value(keys, begin, end, inherited):
    """The depth that most of keys[begin:end] allow, how many do, and how many allow the inherited one.

    A key is an end of an interval, low << 1 | 1 or high + 1 << 1: at one place what is over goes first.
    """
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
def level_of(keys, pixels, starts, inherited, parents, numbers, shift, masks, values, out):
    """Decide the nodes of one level and deal their ends out to their children.

    Nodes are `starts[i]:starts[i + 1]` of `keys` and `pixels`, with the value that holds above, the place of the
    parent in `masks` (-1 of the root) and the number among its children. `shift` is of a child's number in a
    pixel's, negative at the last level. `out` is as (keys, pixels, starts, inherited, parents, numbers) of the next
    level, whose masks follow those so far in `masks`. Returns how many masks and values there are then, how
    many nodes the next level has, and the kind of the last node.
    """
    made_masks, made_values = masks[0][0], values[0][0]
    count, at, kind = 0, 0, 0
    for node in range(len(starts) - 1):
        begin, end = starts[node], starts[node + 1]
        value = inherited[node]
        best, most, allowing = best_value(keys, begin, end, value)
        kind = 0
        if most > allowing:
            value = best
            kind = 1
            values[1][made_values] = value
            made_values += 1
        if max(most, allowing) < (end - begin) >> 1:
            kind |= 2
            masks[1][made_masks] = 0
            for child in range(4):
                out[2][count] = at
                for i in range(begin, end):
                    if pixels[i] >> shift & 3 == child:
                        out[0][at] = keys[i]
                        out[1][at] = pixels[i]
                        at += 1
                out[3][count] = value
                out[4][count] = made_masks
                out[5][count] = child
                count += 1
            out[2][count] = at
            made_masks += 1
        if parents[node] >= 0:
            masks[1][parents[node]] |= kind << (2 * numbers[node])
    return made_masks, made_values, count, kind
