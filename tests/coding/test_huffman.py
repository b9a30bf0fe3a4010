"""Huffman codes: worked by hand, as short as a heap's, within their limit, safe on any bytes."""

import heapq

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.coding.huffman import Huffman

frequencies = st.lists(st.integers(0, 1000), max_size=40)


def plain_cost(counts):
    """Bits of all symbols with a Huffman code of any length, by a heap."""
    heap = [count for count in counts if count]
    if len(heap) == 1:
        return 0
    heapq.heapify(heap)
    total = 0
    while len(heap) > 1:
        pair = heapq.heappop(heap) + heapq.heappop(heap)
        total += pair
        heapq.heappush(heap, pair)
    return total


def test_codes_worked_by_hand():
    code = Huffman.from_frequencies([10, 50, 10, 30])
    assert code.lengths.tolist() == [3, 1, 3, 2]
    # canonical: B 0, D 10, A 110, C 111; in the stream the first bit is the lowest
    assert code.codes.tolist() == [0b011, 0b0, 0b111, 0b01]
    assert code.encode([1, 3, 0, 2]) == bytes([0b11_011_01_0, 0b1])


@given(frequencies)
def test_as_short_as_any_prefix_code(counts):
    code = Huffman.from_frequencies(np.array(counts, dtype=int), 15)
    used = sum(count > 0 for count in counts)
    cost = int((code.lengths.astype(int) * counts).sum()) if counts and used > 1 else 0
    assert cost == plain_cost(counts)


@given(frequencies, st.integers(6, 15))
def test_limited_codes_are_complete(counts, max_bits):
    code = Huffman.from_frequencies(np.array(counts, dtype=int), max_bits)
    present = code.lengths[code.lengths > 0].astype(int)
    assert len(present) == sum(count > 0 for count in counts)
    if len(present) > 1:
        assert present.max() <= max_bits
        assert sum(2.0**-present) == 1


def test_a_limit_that_binds_costs_little():
    counts = [int(1.7**k) + 1 for k in range(30)]  # a free code would reach 23 bits
    code = Huffman.from_frequencies(counts, 12)
    assert code.lengths.max() == 12
    assert (code.lengths.astype(int) * counts).sum() <= 1.01 * plain_cost(counts)


@given(st.data(), frequencies.filter(any), st.integers(6, 15))
def test_streams_come_back(data, counts, max_bits):
    code = Huffman.from_frequencies(counts, max_bits)
    symbols = data.draw(st.lists(st.sampled_from(np.flatnonzero(counts).tolist()), max_size=60))
    coded = code.encode(symbols)
    assert code.decode(coded, len(symbols)).tolist() == symbols
    again = Huffman.from_lengths(code.lengths, max_bits)
    assert again.decode(coded, len(symbols)).tolist() == symbols


@given(st.lists(st.integers(0, 15), max_size=12), st.integers(1, 15), st.binary(max_size=50))
def test_any_lengths_and_bytes_give_symbols_or_a_sentence(lengths, max_bits, data):
    try:
        code = Huffman.from_lengths(lengths, max_bits)
    except FovealError:
        return
    for count in (0, 1, 6, 7, 100, 399, 400, 401):
        try:
            assert len(code.decode(data, count)) == count
        except FovealError:
            assert count > 0


@given(frequencies.filter(lambda counts: sum(c > 0 for c in counts) > 1), st.binary(max_size=50))
def test_a_valid_table_meets_any_bytes(counts, data):
    code = Huffman.from_frequencies(counts)
    for count in (1, 8, 9, 100, 8 * len(data), 8 * len(data) + 1, 1 << 40):
        try:
            assert len(code.decode(data, count)) == count
        except FovealError:
            assert count > 0


def test_what_cannot_be_is_refused():
    with pytest.raises(ValueError, match="do not fit"):
        Huffman.from_frequencies([1] * 5, 2)
    with pytest.raises(ValueError, match="max_bits"):
        Huffman.from_frequencies([1, 1], 16)
    with pytest.raises(ValueError, match="frequency 0"):
        Huffman.from_frequencies([1, 0, 1]).encode([1])
    for lengths in ([1, 1, 1], [2, 2], [13, 1]):
        with pytest.raises(FovealError):
            Huffman.from_lengths(lengths)
