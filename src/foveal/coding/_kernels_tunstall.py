# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of Tunstall coding.

Sequences are numbered as in the paper's figure 4: column 0 holds the symbols by falling probability;
each later column holds the extensions of one expanded sequence, in the same order of last symbols.
So sequence `column * m + rank` ends in the symbol of that rank, and a row of the figure is a queue
that is sorted without effort. A sequence is a word of the code unless it was expanded.
"""

import numpy as np

from foveal.base.jit import kernel

SCALE_BITS = 16
"""A symbol's probability is a whole number of 2^-16; a sequence's, rounded down, one of 2^-32."""


@kernel
def build(weights, parents, chances, lengths, heads):
    """Expand the most probable sequence `len(parents) - 1` times (Baer 2009).

    weights[rank] are the symbols' probabilities, falling, in units of 2^-16. Fills parents[column]
    (the sequence a column extends), chances and lengths of all sequences, and heads[rank], the number
    of sequences of that row which were expanded. Of equal candidates the lowest row goes first.
    """
    m = len(weights)
    for rank in range(m):
        chances[rank] = weights[rank] << 16
        lengths[rank] = 1
        heads[rank] = 0
    for column in range(1, len(parents)):
        best = 0
        chance = np.int64(-1)
        for rank in range(m):
            head = heads[rank]
            if head < column and chances[head * m + rank] > chance:
                chance = chances[head * m + rank]
                best = rank
        parent = heads[best] * m + best
        heads[best] += 1
        parents[column] = parent
        for rank in range(m):
            chances[column * m + rank] = (chance * weights[rank]) >> 16
            lengths[column * m + rank] = lengths[parent] + 1


@kernel
def number_words(m, parents, heads, children, codes):
    """children[s] = column that extends sequence s, or 0; codes[s] = its word, or -1. Returns words."""
    for s in range(len(children)):
        children[s] = 0
    for column in range(1, len(parents)):
        children[parents[column]] = column
    words = 0
    for s in range(len(children)):
        if s // m >= heads[s % m]:
            codes[s] = words
            words += 1
        else:
            codes[s] = -1
    return words


@kernel
def fill_table(m, symbols, parents, codes, lengths, starts, sizes, table):
    """Write each word's symbols to table[starts[w] : starts[w] + sizes[w]].

    Words of one column differ in their last symbol only, so all but the first copy what is before it.
    """
    at = 0
    for column in range(len(parents)):
        kept = -1  # where the sequence of the column's last word begins
        for rank in range(m):
            s = column * m + rank
            word = codes[s]
            if word < 0:
                continue
            size = lengths[s]
            starts[word] = at
            sizes[word] = size
            if kept >= 0:
                for k in range(size - 1):
                    table[at + k] = table[kept + k]
            else:
                here = parents[column]
                for k in range(at + size - 2, at - 1, -1):
                    table[k] = symbols[here % m]
                    here = parents[here // m]
            table[at + size - 1] = symbols[rank]
            kept = at
            at += size


@kernel
def encode(data, ranks, m, children, codes, out):
    """Parse `data` into words; returns how many. A cut-off end is filled with the likeliest symbol.

    ranks[symbol] is -1 for a symbol without a probability; meeting one returns -1 - its index.
    """
    words = 0
    column = 0
    waiting = False
    for i in range(len(data)):
        rank = ranks[data[i]]
        if rank < 0:
            return -1 - i
        s = column * m + rank
        column = children[s]
        waiting = column > 0
        if not waiting:
            out[words] = codes[s]
            words += 1
    if waiting:
        s = column * m
        while children[s] > 0:
            s = children[s] * m
        out[words] = codes[s]
        words += 1
    return words


@kernel
def decode(words, width, available, starts, sizes, table, out):
    """Fill `out` from at most `available` words of `width` bits; returns the words used.

    -1: the words end too early. -2: a word that the code does not have. `table` is eight symbols
    longer than its sequences, so that short ones are copied as eight without a look at their length.
    """
    count = len(out)
    at = 0
    used = 0
    mask = np.uint64((1 << width) - 1)
    while at < count:
        if used >= available:
            return -1
        bit = used * width
        used += 1
        window = np.uint64(words[bit >> 5]) | (np.uint64(words[(bit >> 5) + 1]) << np.uint64(32))
        word = np.int64((window >> np.uint64(bit & 31)) & mask)
        if word >= len(starts):
            return -2
        begin = starts[word]
        size = sizes[word]
        if size <= 8 and at + 8 <= count:
            for k in range(8):
                out[at + k] = table[begin + k]
        else:
            for k in range(min(size, count - at)):
                out[at + k] = table[begin + k]
        at += size
    return used
