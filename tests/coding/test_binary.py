"""Adaptive binary coding: any bits in any contexts come back, and its bounds hold."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.coding import _kernels_binary as kernels
from foveal.coding.binary import (
    BYTES_A_BIT,
    MOST_BITS_A_BYTE,
    Chances,
    drain,
    finish,
    is_at_end,
    reader,
    writer,
)


def coded(bits, contexts, cuts=()):
    """Bytes of some bits, drained after those of `cuts`."""
    coder = writer(Chances.even(8), int(BYTES_A_BIT * len(bits)))
    data, begin = b"", 0
    for end in (*cuts, len(bits)):
        kernels.code_all(coder, contexts[begin:end], bits[begin:end])
        written, coder = drain(coder, int(BYTES_A_BIT * len(bits)))
        data, begin = data + written, end
    return data + finish(coder)


def read(data, contexts):
    bits = np.full(len(contexts), 7)
    coder = reader(Chances.even(8), data)
    kernels.code_all(coder, contexts, bits)
    return bits, coder


@given(st.lists(st.tuples(st.integers(0, 1), st.integers(0, 7)), max_size=300), st.integers(0, 300))
def test_what_is_written_is_read_to_the_last_byte(steps, cut):
    bits = np.array([bit for bit, _ in steps], np.int64)
    contexts = np.array([context for _, context in steps], np.int64)
    data = coded(bits, contexts, [min(cut, len(bits))])
    found, coder = read(data, contexts)
    assert found.tolist() == bits.tolist()
    assert is_at_end(coder)
    assert data == coded(bits, contexts)


@pytest.mark.parametrize("bit", [0, 1])
@pytest.mark.parametrize("count", [1, 20_000])
def test_sure_bits_cost_little_and_no_less_than_is_said(bit, count):
    bits, contexts = np.full(count, bit), np.zeros(count, np.int64)
    data = coded(bits, contexts)
    assert count < MOST_BITS_A_BYTE * len(data)
    assert len(data) < 20 + count / 4000
    assert (read(data, contexts)[0] == bit).all()


@pytest.mark.parametrize("bit", [0, 1])
def test_the_least_likely_bit_fits_the_room_that_is_said(bit):
    """As unlikely as can be: each in a context that has learnt the opposite."""
    chances = Chances.even(1000)
    contexts = np.repeat(np.arange(1000), 1000)
    coder = writer(chances, 4_000_000)
    kernels.code_all(coder, contexts, np.full(len(contexts), 1 - bit))
    known = Chances(chances.quick.copy(), chances.slow.copy())
    coder = writer(chances, int(BYTES_A_BIT * 1000))
    kernels.code_all(coder, np.arange(1000), np.full(1000, bit))
    data = finish(coder)
    assert 1000 < len(data) <= BYTES_A_BIT * 1000
    found = np.zeros(1000, np.int64)
    kernels.code_all(reader(known, data), np.arange(1000), found)
    assert (found == bit).all()


def test_a_long_stream_of_any_chances_comes_back():
    """Long enough for carries into bytes that wait."""
    random = np.random.default_rng(5)
    contexts = random.integers(0, 8, 200_000)
    bits = (random.random(200_000) < np.array([0.5, 0.5, 0.1, 0.9, 0.01, 0.99, 0.001, 0.3])[contexts]) * 1
    data = coded(bits, contexts, [70_000, 70_000, 140_000])
    found, coder = read(data, contexts)
    assert (found == bits).all()
    assert is_at_end(coder)
    chances = np.bincount(contexts, bits) / np.bincount(contexts)
    entropy = -(chances * np.log2(chances) + (1 - chances) * np.log2(1 - chances))
    assert len(data) < 1.04 * (np.bincount(contexts) * entropy).sum() / 8


def test_a_run_of_255_may_be_long():
    """Chances that stay even spell the bits themselves: 0.0111... could still become 0.1000..."""
    for last in (0, 1):
        bits = np.array([0] + [1] * 200 + [last] * 9)
        coder = writer(Chances.even(len(bits)), 1000)
        kernels.code_all(coder, np.arange(len(bits)), bits)
        assert coder.state[kernels.WAITING] > 20 or last == 0
        data = finish(coder)
        found = np.zeros(len(bits), np.int64)
        kernels.code_all(reader(Chances.even(len(bits)), data), np.arange(len(bits)), found)
        assert found.tolist() == bits.tolist()


def test_past_the_end_zeros_are_read_and_it_shows():
    contexts = np.zeros(5000, np.int64)
    _, coder = read(b"\x12\x34\x56\x78\x9a", contexts)
    assert set(read(b"", contexts)[0].tolist()) <= {0, 1}
    assert coder.state[kernels.AT] > 5
    assert not is_at_end(coder)
