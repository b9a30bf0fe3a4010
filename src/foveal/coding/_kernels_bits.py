# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of bit streams: words of 32 bits, the first bit written is the lowest of word 0.

All arithmetic is on `uint64`: Numba turns a mix of signed and unsigned 64-bit integers into floats.
"""

import numpy as np

from foveal.base.jit import kernel


@kernel
def pack(values, widths, words):
    """Write the low `widths[i]` bits of `values[i]`, one after the other, into zeroed `words`.

    `words` has one more word than the bits need, so that the last store stays inside.
    """
    held = np.uint64(0)
    filled = np.int64(0)
    at = 0
    for i in range(len(values)):
        width = np.int64(widths[i])
        low = np.uint64(values[i]) & ((np.uint64(1) << np.uint64(width)) - np.uint64(1))
        held |= low << np.uint64(filled)
        filled += width
        if filled >= 32:
            words[at] = np.uint32(held & np.uint64(0xFFFFFFFF))
            at += 1
            held >>= np.uint64(32)
            filled -= 32
    words[at] = np.uint32(held & np.uint64(0xFFFFFFFF))


@kernel
def unpack(words, widths, out):
    """Read `widths[i]` bits into `out[i]`; `words` has one word more than the bits need."""
    bit = np.int64(0)
    for i in range(len(widths)):
        word = bit >> 5
        window = np.uint64(words[word]) | (np.uint64(words[word + 1]) << np.uint64(32))
        mask = (np.uint64(1) << np.uint64(widths[i])) - np.uint64(1)
        out[i] = np.uint32((window >> np.uint64(bit & 31)) & mask)
        bit += np.int64(widths[i])


@kernel
def signed_classes(values, classes, raw):
    """Class and raw bits of each value: see `foveal.coding.bits.encode_signed`."""
    for i in range(len(values)):
        value = np.int64(values[i])
        size = value if value >= 0 else -value
        k = 0
        while size:
            size >>= 1
            k += 1
        classes[i] = k
        raw[i] = np.uint32(value if value >= 0 else value + (1 << k) - 1)


@kernel
def signed_values(classes, words, out):
    """Inverse of `signed_classes` and `pack` together."""
    bit = np.int64(0)
    for i in range(len(classes)):
        k = np.int64(classes[i])
        if k == 0:
            out[i] = 0
            continue
        word = bit >> 5
        window = np.uint64(words[word]) | (np.uint64(words[word + 1]) << np.uint64(32))
        low = np.int64((window >> np.uint64(bit & 31)) & ((np.uint64(1) << np.uint64(k)) - np.uint64(1)))
        out[i] = low if low >> (k - 1) else low - (1 << k) + 1
        bit += k


@kernel
def vector_classes(values, classes, raw, widths):
    """One class a row and raw bits a component: see `foveal.coding.bits.encode_vectors`."""
    across = values.shape[1]
    for i in range(len(values)):
        most = np.int64(0)
        for j in range(across):
            value = np.int64(values[i, j])
            most |= 2 * value if value > 0 else 2 * (-value) - 1 if value < 0 else 0
        k = 0
        while most:
            most >>= 1
            k += 1
        classes[i] = k
        for j in range(across):
            at = i * across + j
            widths[at] = k
            raw[at] = np.uint32(np.int64(values[i, j]) + (1 << (k - 1))) if k else np.uint32(0)


@kernel
def vector_values(classes, words, out):
    """Inverse of `vector_classes` and `pack` together."""
    across = out.shape[1]
    bit = np.int64(0)
    for i in range(len(classes)):
        k = np.int64(classes[i])
        half = (1 << k) >> 1
        mask = (np.uint64(1) << np.uint64(k)) - np.uint64(1)
        for j in range(across):
            word = bit >> 5
            window = np.uint64(words[word]) | (np.uint64(words[word + 1]) << np.uint64(32))
            out[i, j] = np.int64((window >> np.uint64(bit & 31)) & mask) - half
            bit += k
