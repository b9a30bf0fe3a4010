# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the adaptive binary coder: one function both writes and reads, see `binary.py`."""

import numpy as np

from foveal.base.jit import inlined, kernel, lean

IS_READING, WIDTH, LOW, AT, HELD, WAITING = range(6)
STATES = 6
"""What is where in `state`: whether the coder reads; the width of the interval; its low end, of a reader how
far the code is above that; the next byte of `data`; of a writer the last byte that was not 255, and how many
bytes wait with it, since a carry may yet change them."""

CHANCE_BITS = 12  # of a bit's chance as it splits the interval
QUICK, SLOW = 4, 7  # a chance moves by 2^-QUICK of what it was wrong by, the one beside it by 2^-SLOW
EVEN = 1 << 15
WHOLE = 0xFFFFFFFF
CODE_BYTES = 4  # of the interval's ends
TOP = 1 << 24  # the interval is kept wider than this


@inlined
def code(coder, context, bit):
    """Write `bit`, or read one in its place, with the chances of a context; returns the bit."""
    state = coder.state
    quick, slow = np.int64(coder.quick[context]), np.int64(coder.slow[context])
    width = state[WIDTH]
    bound = (width >> CHANCE_BITS) * ((quick + slow) >> (17 - CHANCE_BITS))
    if state[IS_READING]:
        bit = 1 if state[LOW] >= bound else 0
    if bit:
        state[LOW] += -bound if state[IS_READING] else bound
        width -= bound
        coder.quick[context] = quick - (quick >> QUICK)
        coder.slow[context] = slow - (slow >> SLOW)
    else:
        width = bound
        coder.quick[context] = quick + ((65536 - quick) >> QUICK)
        coder.slow[context] = slow + ((65536 - slow) >> SLOW)
    while width < TOP:
        width <<= 8
        shift(coder)
    state[WIDTH] = width
    return bit


@lean
def shift(coder):
    """Move a byte out of `state[LOW]` into the data, or from there into it: zeros past the end."""
    state, data = coder.state, coder.data
    low = state[LOW]
    if state[IS_READING]:
        at = state[AT]
        byte = np.int64(data[at]) if at < len(data) else 0
        state[LOW] = low << 8 | byte
        state[AT] = at + 1
        return
    if low < 0xFF000000 or low > 0xFFFFFFFF:
        carry = low >> 32
        byte = state[HELD] + carry
        while state[WAITING]:
            data[state[AT]] = byte & 0xFF
            state[AT] += 1
            state[WAITING] -= 1
            byte = 0xFF + carry
        state[HELD] = low >> 24 & 0xFF
    state[WAITING] += 1
    state[LOW] = (low & 0xFFFFFF) << 8


@kernel
def code_all(coder, contexts, bits):
    """Write `bits`, each in its context, or read them."""
    for i in range(len(bits)):
        bits[i] = code(coder, np.int64(contexts[i]), np.int64(bits[i]))
