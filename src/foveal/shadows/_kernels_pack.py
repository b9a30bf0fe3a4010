# mypy: allow-untyped-defs, allow-untyped-calls
"""Where the blocks of a packed tree lie, and its words."""

from foveal.base.jit import kernel


@kernel
def block_words(mask):
    """Words of a block of children: one for a leaf or an empty node, two for an inner one."""
    count = 0
    while mask:
        mask &= mask - 1
        count += 1
    return count


@kernel
def lay(masks, below, scale, extents):
    """Lay out what lies below the nodes of one level: `extents[m]` words from the block of node m on.

    `below` has the extents of the level below. Returns the longest distance from a link to its block, as
    padded to a multiple of `scale`, and the words of padding.
    """
    longest, padding, child = 0, 0, 0
    for m in range(len(masks)):
        mask = int(masks[m])
        link, free = 0, block_words(mask)
        while mask:
            kind = mask & 3
            if kind >= 2:
                pad = -(free - link) % scale
                padding += pad
                longest = max(longest, free + pad - link)
                free += pad + below[child]
                child += 1
            link += (kind & 1) + (kind >> 1)
            mask >>= 2
        extents[m] = free
    return longest, padding


@kernel
def write(masks, links, blocks, scale, below, scale_below, values, links_below, blocks_below, words):
    """Write the links of one level's nodes and the values of their children.

    `links` and `blocks` are where the words of these nodes and their blocks begin; those of the level below
    are filled in. `below` has its extents, `values` its values.
    """
    child, value = 0, 0
    for m in range(len(masks)):
        mask = int(masks[m])
        words[links[m]] = mask | (blocks[m] - links[m]) // scale << 16
        link, free = blocks[m], blocks[m] + block_words(mask)
        while mask:
            kind = mask & 3
            if kind & 1:
                words[link + (kind >> 1)] = values[value]
                value += 1
            if kind >= 2:
                free += -(free - link) % scale_below
                links_below[child], blocks_below[child] = link, free
                free += below[child]
                child += 1
            link += (kind & 1) + (kind >> 1)
            mask >>= 2
