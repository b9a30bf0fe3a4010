"""Range coding: frequencies that add up, and any operations come back in order."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.coding import _kernels_rans as kernels
from foveal.coding import rans

BITS = 11


@given(st.lists(st.integers(0, 10**6), min_size=1, max_size=64).filter(any), st.integers(6, 11))
def test_frequencies_sum_to_the_whole_and_keep_what_was_seen(counts, bits):
    frequencies = rans.normalise(counts, bits=bits)
    assert frequencies.sum() == 1 << bits
    assert [f > 0 for f in frequencies] == [c > 0 for c in counts]


@pytest.mark.parametrize("counts", [[0, 0], [], [-1, 5], [[1, 2]], [1] * 65])
def test_counts_that_make_no_table_are_refused(counts):
    with pytest.raises(ValueError, match="counts must be"):
        rans.normalise(counts, bits=6)


def test_slots_of_a_table_worked_by_hand():
    slots = rans.slot_table(np.array([[3, 0, 1]], np.int32), bits=2)
    assert [(s & 255, s >> 8 & 4095, s >> 20) for s in slots[0].tolist()] == [
        (0, 3, 0),
        (0, 3, 1),
        (0, 3, 2),
        (2, 1, 0),
    ]


symbols = st.tuples(st.just("symbol"), st.booleans(), st.integers(0, 1), st.integers(0, 3))
raws = st.tuples(st.just("raw"), st.booleans(), st.integers(0, 16), st.integers(0, 65535))
numbers = st.tuples(st.just("number"), st.booleans(), st.just(0), st.integers(0, 2**32 - 1))


@given(st.lists(symbols | raws | numbers, max_size=80))
def test_what_is_written_is_read(steps):
    frequencies = np.stack([rans.normalise(c, bits=BITS) for c in ([900, 1, 30, 1], [1, 1, 1, 1])])
    operations = np.empty(3 * len(steps) + 1, np.int32)
    count = 0
    for what, is_b, a, b in steps:
        state = kernels.STATE_B if is_b else 0
        if what == "number":
            count = kernels.put_number(b, state, operations, count)
            continue
        code = a << 8 | b if what == "symbol" else kernels.RAW | a << 16 | b & ((1 << a) - 1)
        operations[count] = state | code
        count += 1
    words = np.empty(count + 5, np.uint16)
    words[-1] = 0  # the decoder reads it where it reads past the end
    at = kernels.write(operations, count, frequencies, rans.starts(frequencies), BITS, words[:-1])
    words = words[at:]
    states = [int(words[0]) | int(words[1]) << 16, int(words[2]) | int(words[3]) << 16]
    slots = rans.slot_table(frequencies, bits=BITS)
    at = 4
    for what, is_b, a, b in steps:
        if what == "symbol":
            value, states[is_b], at = kernels.symbol(slots, a, states[is_b], BITS, words, at)
        elif what == "raw":
            value, states[is_b], at = kernels.raw(a, states[is_b], words, at)
            b &= (1 << a) - 1
        else:
            value, states[is_b], at = kernels.number(states[is_b], words, at)
        assert value == b
    assert states == [kernels.LOW, kernels.LOW]
    assert at == len(words) - 1
