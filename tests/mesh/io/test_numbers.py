"""Decimal numbers: the nearest double, always, wherever chunks are cut."""

import math
import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.mesh.io import _kernels, numbers
from foveal.mesh.io.stream import ByteStream


def parse(text):
    """The value, and whether the kernel itself was sure of it."""
    buffer = np.frombuffer(text.encode() + b" ", dtype=np.uint8)
    value, end, is_exact = _kernels.parse_number(buffer, 0, len(buffer))
    return value, is_exact and end == len(text)


def assert_same(text):
    value, is_exact = parse(text)
    if is_exact:
        assert value == float(text)
        assert math.copysign(1, value) == math.copysign(1, float(text))
    return is_exact


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_shortest_spelling_is_read_exactly_or_left(value):
    assert_same(repr(value))
    assert_same(f"{value:.17g}")
    assert_same(f"{value:.6e}")


@given(st.decimals(allow_nan=False, allow_infinity=False, places=11, min_value=-(10**6), max_value=10**6))
def test_seventeen_digits_need_no_help(value):
    assert assert_same(str(value)) or "E" in str(value)


@given(st.integers(2**52, 2**53 - 1), st.integers(-3, 0), st.integers(-2, 2))
def test_numbers_beside_a_midpoint_are_rounded_right_or_left(mantissa, power, nudge):
    # Halfway between two doubles, written out, and a last digit more or less.
    middle = (2 * mantissa + 1) * 10**6 // (2 << -power) + nudge
    assert_same(f"{middle}e-6")
    assert_same(f"{middle}")


def test_scanners_numbers_are_read_by_the_kernel_alone():
    rng = random.Random(3)
    for _ in range(3000):
        assert assert_same(f"{rng.uniform(-1000, 1000):.7f}")
        assert assert_same(f"{rng.uniform(4e6, 5e6)!r}")
        assert assert_same(f"{rng.uniform(-1, 1):.6e}")


@pytest.mark.parametrize("text", ["0", "-0", "+1", ".5", "5.", "1e5", "1E+05", "1e-22", "-0.0e9", "007.250"])
def test_spellings(text):
    assert assert_same(text)


@pytest.mark.parametrize(
    "text", ["", "-", ".", "e5", "1e", "1e+", "nan", "inf", "1x", "--1", "1.2.3", "0x10"]
)
def test_what_is_no_plain_number_is_left(text):
    assert not parse(text)[1]


def write_and_read(tmp_path, text, name="numbers.txt"):
    path = Path(tmp_path, name)
    path.write_text(text)
    with ByteStream(path) as stream:
        reader = numbers.NumberReader(stream, name)
        parts = []
        while len(part := reader.read()):
            parts.append(part.copy())
    return np.concatenate(parts) if parts else np.empty(0)


def test_chunks_may_be_cut_anywhere(tmp_path, monkeypatch):
    monkeypatch.setattr(numbers, "_LONGEST_TOKEN", 40)
    rng = np.random.default_rng(8)
    values = np.concatenate([rng.normal(size=50) * 10.0 ** rng.integers(-300, 300, 50), rng.uniform(size=50)])
    text = " \n".join(map(repr, values.tolist()))
    for size in (*range(41, 110), 1000):
        monkeypatch.setattr(numbers, "_CHUNK_BYTES", size)
        assert write_and_read(tmp_path, text).tolist() == values.tolist()


@pytest.mark.parametrize("word", ["abc", "1_0", "1,5", "\u0661", "0x1p3"])
def test_a_word_is_refused_by_name(word, tmp_path):
    with pytest.raises(FovealError, match="stands where a number is due"):
        write_and_read(tmp_path, f"1 2 {word} 3")


def test_a_token_without_end_is_refused(tmp_path):
    with pytest.raises(FovealError, match=r"no number|stands where"):
        write_and_read(tmp_path, "1 " + "7" * 3_000_000 + "x")
