"""Streams of bits: values worked by hand, every number of 16 bits, a plain twin, refusals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.coding import bits

int32s = st.integers(-(2**31), 2**31 - 1)


def plain_bits(values, widths):
    """All bits in a row, lowest first, eight to a byte."""
    row = [value >> k & 1 for value, width in zip(values, widths, strict=True) for k in range(width)]
    row += [0] * (-len(row) % 8)
    return bytes(sum(bit << k for k, bit in enumerate(row[i : i + 8])) for i in range(0, len(row), 8))


def plain_class(value):
    """The class and raw bits of a number, as the module's text has them."""
    k = abs(value).bit_length()
    return k, value if value >= 0 else value + 2**k - 1


def plain_vector_class(row):
    k = 0
    while any(row) and not all(-(2**k) <= 2 * v < 2**k for v in row):
        k += 1
    return k


def test_the_first_bit_is_the_lowest():
    # 1, then 010 from the low end, then eight ones: 1 0 1 0 1111 | 1111
    assert bits.pack_bits([1, 2, 255], [1, 3, 8]) == bytes([0b11110101, 0b00001111])
    assert bits.pack_bits([0x12345678], [32]) == bytes([0x78, 0x56, 0x34, 0x12])
    assert bits.pack_bits([], []) == b""


@given(st.lists(st.tuples(st.integers(0, 2**32 - 1), st.integers(0, 32)), max_size=40))
def test_packing_agrees_with_its_plain_twin_and_comes_back(pairs):
    values, widths = [v for v, _ in pairs], [w for _, w in pairs]
    data = bits.pack_bits(values, widths)
    assert data == plain_bits(values, widths)
    assert bits.unpack_bits(data, widths).tolist() == [v % 2**w for v, w in pairs]


def test_every_number_of_sixteen_bits_comes_back():
    values = np.arange(-(2**15), 2**15 + 1)
    classes, raw = bits.encode_signed(values)
    assert [plain_class(v)[0] for v in values.tolist()] == classes.tolist()
    assert raw == plain_bits([plain_class(v)[1] for v in values.tolist()], classes.tolist())
    np.testing.assert_array_equal(bits.decode_signed(classes, raw), values)

    classes, raw = bits.encode_vectors(values[:, None])
    assert [plain_vector_class([v]) for v in values.tolist()] == classes.tolist()
    np.testing.assert_array_equal(bits.decode_vectors(classes, raw, 1)[:, 0], values)


@pytest.mark.parametrize("k", range(1, 31))
def test_powers_of_two_belong_to_the_next_class_on_both_sides(k):
    classes, _ = bits.encode_signed([2**k - 1, 2**k, -(2**k) + 1, -(2**k)])
    assert classes.tolist() == [k, k + 1, k, k + 1]
    # One class for a vector is that of two's complement, where -2^(k - 1) still fits k bits.
    classes, _ = bits.encode_vectors([[2 ** (k - 1) - 1, 0], [0, -(2 ** (k - 1))], [2 ** (k - 1), 0]])
    assert classes.tolist() == [k if k > 1 else 0, k, k + 1]


@given(st.lists(int32s, max_size=30))
def test_any_int32_comes_back(values):
    classes, raw = bits.encode_signed(values)
    assert len(raw) == (sum(abs(v).bit_length() for v in values) + 7) // 8
    assert bits.decode_signed(classes, raw).tolist() == values


@given(st.lists(st.tuples(int32s, int32s, int32s), min_size=1, max_size=20))
def test_any_vectors_come_back(rows):
    classes, raw = bits.encode_vectors(rows)
    assert classes.tolist() == [plain_vector_class(row) for row in rows]
    assert bits.decode_vectors(classes, raw, 3).tolist() == [list(row) for row in rows]


@given(st.binary(max_size=40), st.lists(st.integers(0, 255), max_size=20), st.integers(1, 4))
def test_any_bytes_give_numbers_or_a_sentence(data, widths, across):
    readers = [
        (1, lambda: bits.unpack_bits(data, widths)),
        (1, lambda: bits.decode_signed(widths, data)),
        (across, lambda: bits.decode_vectors(widths, data, across)),
    ]
    for times, read in readers:
        if max(widths, default=0) > 32 or times * sum(widths) > 8 * len(data):
            with pytest.raises(FovealError):
                read()
        else:
            assert len(read()) == len(widths)


def test_wrong_widths_and_shapes_are_refused():
    with pytest.raises(ValueError, match="at most 32"):
        bits.pack_bits([1], [33])
    with pytest.raises(ValueError, match="alike"):
        bits.pack_bits([1, 2], [3])
