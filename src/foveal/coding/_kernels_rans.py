# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the range coder: two interleaved states over one stream of 16-bit words.

An operation is one int32, in the order in which the decoder will meet it:

    bit 29       which of the two states
    bit 28       0: a symbol, 1: raw bits
    symbol       bits 8-23 the table, bits 0-7 the symbol
    raw bits     bits 16-20 how many (0 to 16), bits 0-15 their value

Based on: Duda. Asymmetric numeral systems. 2013; Giesen. Interleaved entropy coders. 2014.
"""

import numpy as np

from foveal.base.jit import inlined, kernel

LOW = 1 << 16  # a state lies in [LOW, LOW << 16) between operations
STATE_B = 1 << 29
RAW = 1 << 28


@kernel
def slot_table(frequencies, bits, out):
    """out[slot] = symbol | frequency << 8 | (slot - start) << 20, for each table of `frequencies`."""
    mask = (1 << bits) - 1
    for table in range(frequencies.shape[0]):
        slot = 0
        for symbol in range(frequencies.shape[1]):
            frequency = frequencies[table, symbol]
            for i in range(frequency):
                out[table, slot & mask] = symbol | frequency << 8 | i << 20
                slot += 1


@kernel
def write(operations, count, frequencies, starts, bits, words):
    """Code operations[:count] backwards into the end of `words`; return where the stream begins.

    The two final states are the first four words. `words` must have room for one word an operation
    and four more. Returns -1 for an operation whose symbol has no frequency.
    """
    at = len(words)
    a = b = LOW
    for i in range(count - 1, -1, -1):
        op = operations[i]
        x = b if op & STATE_B else a
        if op & RAW:
            n = (op >> 16) & 31
            if x >= LOW << (16 - n):
                at -= 1
                words[at] = x & 0xFFFF
                x >>= 16
            x = x << n | (op & 0xFFFF)
        else:
            table = (op >> 8) & 0xFFFF
            symbol = op & 0xFF
            frequency = frequencies[table, symbol]
            if frequency == 0:
                return -1
            if x >= frequency << (32 - bits):
                at -= 1
                words[at] = x & 0xFFFF
                x >>= 16
            x = ((x // frequency) << bits) + x % frequency + starts[table, symbol]
        if op & STATE_B:
            b = x
        else:
            a = x
    at -= 4
    words[at] = a & 0xFFFF
    words[at + 1] = a >> 16
    words[at + 2] = b & 0xFFFF
    words[at + 3] = b >> 16
    return at


@inlined
def symbol(slots, table, x, bits, words, at):
    """Read a symbol with state x: (symbol, x, at). The last word, 0, is read again past the end."""
    entry = slots[table, x & ((1 << bits) - 1)]
    x = ((entry >> 8) & 0xFFF) * (x >> bits) + (entry >> 20)
    # Not a branch: whether a word is due cannot be foreseen.
    word = np.int64(words[min(at, len(words) - 1)])
    is_due = x < LOW
    x = x << 16 | word if is_due else x
    at += is_due
    return entry & 0xFF, x, at


@inlined
def raw(n, x, words, at):
    """Read n raw bits, 0 to 16, with state x: (value, x, at)."""
    value = x & ((1 << n) - 1)
    x >>= n
    # Not a branch: whether a word is due cannot be foreseen.
    word = np.int64(words[min(at, len(words) - 1)])
    is_due = x < LOW
    x = x << 16 | word if is_due else x
    at += is_due
    return value, x, at


@kernel
def number(x, words, at):
    """Read a number in [0, 2^32) that was put down by `put_number`: (value, x, at)."""
    n, x, at = raw(6, x, words, at)
    n = min(n, 32)
    value, x, at = raw(min(n, 16), x, words, at)
    if n > 16:
        high, x, at = raw(n - 16, x, words, at)
        value |= high << 16
    return (((1 << n) | value) - 1) & 0xFFFFFFFF, x, at


@kernel
def put_number(value, state, operations, count):
    """Operations for a number in [0, 2^32): six bits for the length of value + 1, then its lower bits."""
    value += 1
    n = 0
    while value >> (n + 1):
        n += 1
    value -= 1 << n
    operations[count] = state | RAW | 6 << 16 | n
    low = min(n, 16)
    operations[count + 1] = state | RAW | low << 16 | (value & ((1 << low) - 1))
    count += 2
    if n > 16:
        operations[count] = state | RAW | (n - 16) << 16 | value >> 16
        count += 1
    return count
