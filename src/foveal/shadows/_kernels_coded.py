# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the coded tree: nodes with children, level by level (spec/shadows.md, "The coded tree").

One loop both writes and reads, as `foveal.coding._kernels_binary.code` does: where it reads, masks and values
are overwritten by what they are.

A *cell* is a child of a node with children, numbered node * children + child. A *side* is a direction to
the cells around: sides 0 .. dims - 1 towards lower x, y, image, the others towards higher ones.
"""

import numpy as np

from foveal.base.jit import inlined, kernel, lean
from foveal.coding._kernels_binary import AT, code

FAR = 0xFFFFFFFF
MOST_SIDES = 6

# Where the contexts of each kind of decision begin.
SPLIT = 0  # 2^14: has it children
HAS = SPLIT + (1 << 14)  # 2^15: has it a value
SAME = HAS + (1 << 15)  # 2^7: is the value that of a side
IS_FAR = SAME + (1 << 7)  # 4
BIT = IS_FAR + 4  # 9 * 16 while a guess holds, then 8
STOP = BIT + 9 * 16 + 8  # 8 * 8 * 16: was this the last bit that is 1
CONTEXTS = STOP + 8 * 8 * 16


@inlined
def is_inside(child, side, dims):
    """Whether the cell beyond a side of a child is a child of the same node: child ^ 1 << side % dims."""
    return (child >> side % dims & 1) != (side >= dims)


@inlined
def look_round(level, node, child, dims, held, known):
    """known[side] = the value beyond, as far as it is known yet; how many are not `held`."""
    others = 0
    for side in range(2 * dims):
        at = node if is_inside(child, side, dims) else np.int64(level.links[node, side])
        beyond = child ^ (1 << side % dims)
        known[side] = level.cells[(at << dims) + beyond] if at >= 0 else level.outer[node, side]
        others += known[side] != held
    return others


@lean
def code_value(coder, value, held, known, sides, is_split):
    """A value where `held` held before: that of a side, or its bits from the highest to the last 1."""
    first, second, found = held, held, 0
    for side in range(sides):
        guess = known[side]
        is_new = guess != held
        times = 1
        for before in range(side):
            is_new = is_new and known[before] != guess
        if not is_new:
            continue
        for after in range(side + 1, sides):
            times += known[after] == guess
        if code(coder, SAME + ((found << 3 | times) << 1 | is_split), value == guess):
            return guess
        if found == 0:
            first, second = guess, held
        elif found == 1:
            second = guess
        found += 1
    if code(coder, IS_FAR + (2 * (held == FAR) | is_split), value == FAR):
        return np.int64(FAR)
    return code_bits(coder, value + 1, first + 1, second + 1) - 1


@lean
def code_bits(coder, value, first, second):
    """A value from 1 to 2^32 - 1 by its bits, with two guesses of it, to 2^32."""
    read = 0
    lost_first = lost_second = 0  # how many bits ago a guess was wrong, 0 while it is not
    for place in range(31, -1, -1):
        depth = min(31 - place, 15)
        lost = min(lost_first, lost_second)
        if lost == 0:
            a = 1 + (first >> place & 1) if lost_first == 0 else 0
            b = 1 + (second >> place & 1) if lost_second == 0 else 0
            context = BIT + 16 * (3 * a + b) + depth
        else:
            context = BIT + 9 * 16 + min(lost, 7)
        bit = code(coder, context, value >> place & 1)
        read |= bit << place
        lost_first += lost_first > 0 or bit != first >> place & 1
        lost_second += lost_second > 0 or bit != second >> place & 1
        if bit:
            longest = min(max(lost_first, lost_second), 7)
            context = STOP + 16 * (8 * min(lost_first, lost_second, 7) + longest) + depth
            if code(coder, context, value & ((1 << place) - 1) == 0):
                break
    return max(read, 1)


@kernel
def code_nodes(level, values, at, begin, end, dims, is_last, coder):
    """Masks of the nodes begin .. end - 1 and the values of their children, from values[at] on.

    Returns how many values there are now, or -1 if that is too many, a mask is 0, or what is read ends.
    """
    known = np.empty(MOST_SIDES, np.int64)
    for node in range(begin, end):
        held = np.int64(level.held[node])
        mask = np.int64(level.masks[node])
        node_context = np.int64(2 * is_last + level.is_inner[node]) << 12
        history = 0
        for child in range(1 << dims):
            others = look_round(level, node, child, dims, held, known)
            context = node_context | child << 9 | (history & 63) << 3 | others
            is_split = 0 if is_last else code(coder, SPLIT + context, mask >> 2 * child + 1 & 1)
            has = code(coder, HAS + (context << 1 | is_split), mask >> 2 * child & 1)
            kind = is_split << 1 | has
            history = history << 2 | kind
            mask = mask & ~(3 << 2 * child) | kind << 2 * child
            if has:
                if at == len(values):
                    return -1
                value = code_value(coder, np.int64(values[at]), held, known, 2 * dims, is_split)
                values[at] = value
                level.cells[(node << dims) + child] = value
                at += 1
        level.masks[node] = mask
        if mask == 0 or coder.state[AT] > len(coder.data):
            return -1
    return at


@kernel
def number(masks, dims, numbers):
    """numbers[cell] = which node of the next level it is, -1 where it has no children; how many there are."""
    count = 0
    for node in range(len(masks)):
        for child in range(1 << dims):
            is_split = masks[node] >> 2 * child + 1 & 1
            numbers[(node << dims) + child] = count if is_split else -1
            count += is_split
    return count


@kernel
def descend(level, numbers, dims, below):
    """What the level below knows before its own masks: values from above, what is beside what."""
    for node in range(len(level.masks)):
        for child in range(1 << dims):
            cell = (node << dims) + child
            to = numbers[cell]
            if to < 0:
                continue
            held = level.cells[cell]
            below.held[to] = held
            below.is_inner[to] = level.masks[node] >> 2 * child & 1
            below.cells[np.int64(to) << dims : (np.int64(to) + 1) << dims] = held
            for side in range(2 * dims):
                at = node if is_inside(child, side, dims) else np.int64(level.links[node, side])
                if at < 0:
                    below.links[to, side] = -1
                    below.outer[to, side] = level.outer[node, side]
                else:
                    beyond = (at << dims) + (child ^ (1 << side % dims))
                    below.links[to, side] = numbers[beyond]
                    below.outer[to, side] = level.cells[beyond]
