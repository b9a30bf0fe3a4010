# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of Huffman coding: a table look-up a symbol, two from each 64-bit window."""

import numpy as np

from foveal.base.jit import kernel


@kernel
def fill_table(codes, lengths, max_bits, table):
    """table[next max_bits bits of the stream] = symbol * 16 + length of its code."""
    for symbol in range(len(lengths)):
        length = np.int64(lengths[symbol])
        if length == 0:
            continue
        for index in range(codes[symbol], 1 << max_bits, 1 << length):
            table[index] = symbol * 16 + length


@kernel
def decode(words, max_bits, total_bits, table, out):
    """Fill `out`; False if that takes more than `total_bits` bits."""
    mask = np.uint64((1 << max_bits) - 1)
    bit = np.int64(0)
    count = len(out)
    for i in range(0, count, 2):
        if bit > total_bits:
            return False
        window = np.uint64(words[bit >> 5]) | (np.uint64(words[(bit >> 5) + 1]) << np.uint64(32))
        window >>= np.uint64(bit & 31)
        entry = np.int64(table[np.int64(window & mask)])
        out[i] = entry >> 4
        length = entry & 15
        if i + 1 < count:
            window >>= np.uint64(length)
            entry = np.int64(table[np.int64(window & mask)])
            out[i + 1] = entry >> 4
            length += entry & 15
        bit += length
    return bit <= total_bits
