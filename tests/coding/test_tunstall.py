"""Tunstall's code: the paper's figure, the notes' figures, a heap as slow twin, any bytes."""

import heapq
import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.coding.tunstall import MAX_WORD_BITS, Tunstall

frequencies = st.lists(st.integers(0, 1000), max_size=40)


def plain_chances(weights, word_bits):
    """Chances (in 2^-32) of the words of a Tunstall code by a plain heap of sequences."""
    heap = [-(w << 16) for w in weights]
    heapq.heapify(heap)
    while len(heap) + len(weights) - 1 <= 1 << word_bits:
        chance = -heapq.heappop(heap)
        for weight in weights:
            heapq.heappush(heap, -(chance * weight >> 16))
    return sorted(-chance for chance in heap)


def poisson(count, scale=1 << 24):
    """Frequencies of `count` symbols with a Poisson distribution of mean count / 3."""
    mean = count / 3
    chances = np.array([math.exp(-mean) * mean**k / math.factorial(k) for k in range(count)])
    return np.maximum(1, np.rint(scale * chances / chances.sum())).astype(np.int64)


def sequences(code):
    return [tuple(code.sequence(word).tolist()) for word in range(code.words)]


def chances_of(code):
    chances = np.empty(code.words, dtype=np.int64)
    chances[code.codes[code.codes >= 0]] = code.chances[code.codes >= 0]
    return chances


def test_figure_4_of_the_paper():
    code = Tunstall.from_frequencies([50, 30, 10, 10], 4)
    names = {"".join("ABCD"[s] for s in sequence) for sequence in sequences(code)}
    assert names == {
        *("C", "D", "AB", "AC", "AD", "BB", "BC", "BD"),
        *("AAA", "AAB", "AAC", "AAD", "BAA", "BAB", "BAC", "BAD"),
    }
    by_name = {
        "".join("ABCD"[s] for s in q): c for q, c in zip(sequences(code), chances_of(code), strict=True)
    }
    assert by_name["AAB"] / 2**32 == pytest.approx(0.075, rel=1e-3)
    assert by_name["BAD"] / 2**32 == pytest.approx(0.015, rel=1e-3)


@pytest.mark.parametrize("count", [2, 4, 9, 13, 17, 22])
@pytest.mark.parametrize("word_bits", [5, 8, 10, 12])
def test_queues_give_the_multiset_of_a_heap(count, word_bits):
    rng = np.random.default_rng(count * 100 + word_bits)
    for counts in (poisson(count), rng.integers(1, 1000, count), np.full(count, 7)):
        code = Tunstall.from_frequencies(counts, word_bits)
        weights = np.maximum(counts * 65536 // counts.sum(), 1).tolist()
        assert sorted(chances_of(code).tolist()) == plain_chances(weights, word_bits)
        assert code.words == count + (count - 1) * ((2**word_bits - count) // (count - 1))


@pytest.mark.parametrize(
    ("count", "word_bits", "excess"),
    [(4, 8, 2.6), (4, 12, 1.5), (9, 10, 5.7), (13, 8, 12.7), (13, 14, 6.1), (22, 10, 14.8), (22, 12, 12.3)],
)
def test_excess_over_the_entropy(count, word_bits, excess):
    counts = poisson(count)
    chances = counts / counts.sum()
    entropy = -(chances * np.log2(chances)).sum()
    code = Tunstall.from_frequencies(counts, word_bits)
    lengths = np.array([len(s) for s in sequences(code)])
    mean_length = (chances_of(code) / 2**32 * lengths).sum()
    assert 100 * (word_bits / mean_length / entropy - 1) == pytest.approx(excess, abs=0.15)


@given(frequencies, st.integers(6, 7))
def test_words_are_complete_and_proper(counts, word_bits):
    code = Tunstall.from_frequencies(np.array(counts, dtype=int), word_bits)
    present = {symbol for symbol, count in enumerate(counts) if count}
    if len(present) < 2:
        assert code.words == len(present)
        return
    words = set(sequences(code))
    assert len(words) == code.words <= 1 << word_bits
    # The inner nodes are the proper prefixes; complete and proper means: each inner node has every
    # symbol after it, as an inner node or as a word, and no word is an inner node.
    inner = {word[:k] for word in words for k in range(len(word))}
    assert not inner & words
    assert {(*node, symbol) for node in inner for symbol in present} == (words | inner) - {()}


@given(st.data(), frequencies.filter(any), st.integers(6, 12))
def test_streams_come_back_whatever_their_end(data, counts, word_bits):
    code = Tunstall.from_frequencies(counts, word_bits)
    present = [symbol for symbol, count in enumerate(counts) if count]
    symbols = data.draw(st.lists(st.sampled_from(present), max_size=60))
    coded = code.encode(symbols)
    assert code.decode(coded, len(symbols)).tolist() == symbols
    if len(present) == 1:
        assert coded == b""


def test_encoding_is_greedy_parsing():
    rng = np.random.default_rng(3)
    code = Tunstall.from_frequencies([50, 30, 10, 10], 8)
    words = {sequence: word for word, sequence in enumerate(sequences(code))}
    symbols = rng.choice(4, 500, p=[0.5, 0.3, 0.1, 0.1]).tolist()
    expected, at = [], 0
    while at < len(symbols):
        rest = symbols[at:] + [0] * code.longest  # the likeliest symbol fills the end
        size = next(k for k in itertools.count(1) if tuple(rest[:k]) in words)
        expected.append(words[tuple(rest[:size])])
        at += size
    assert list(code.encode(symbols)) == expected


def test_decoding_may_begin_at_any_word():
    code = Tunstall.from_frequencies(poisson(9), 8)
    symbols = np.random.default_rng(4).choice(9, 3000, p=poisson(9) / poisson(9).sum())
    coded = code.encode(symbols)
    skipped = sum(len(code.sequence(word)) for word in coded[:100])
    np.testing.assert_array_equal(code.decode(coded[100:], 3000 - skipped), symbols[skipped:])


@given(st.lists(st.integers(0, 255), max_size=30), st.integers(1, 12), st.binary(max_size=50))
@settings(max_examples=200)
def test_any_table_and_bytes_give_symbols_or_a_sentence(counts, word_bits, data):
    if sum(c > 0 for c in counts) > 1 << word_bits:
        with pytest.raises(ValueError, match="do not fit"):
            Tunstall.from_frequencies(counts, word_bits)
        return
    code = Tunstall.from_frequencies(np.array(counts, dtype=int), word_bits)
    for count in (0, 1, 7, 100, 1000, 1 << 40):
        if len(code.symbols) == 1 and count > 1000:
            continue  # takes the count at its word, as its text says
        try:
            assert len(code.decode(data, count)) == count
        except FovealError:
            assert count > 0


def test_what_cannot_be_is_refused():
    with pytest.raises(ValueError, match="do not fit"):
        Tunstall.from_frequencies([1, 1, 1, 1, 1], 2)
    with pytest.raises(ValueError, match="word_bits"):
        Tunstall.from_frequencies([1, 1], MAX_WORD_BITS + 1)
    with pytest.raises(ValueError, match="frequency"):
        Tunstall.from_frequencies([1, -1], 8)
    with pytest.raises(ValueError, match="integers"):
        Tunstall.from_frequencies([0.5, 0.5], 8)
    with pytest.raises(ValueError, match="at most 12 bits"):
        Tunstall.from_frequencies([1 << 31, 1], 14)  # sequences of 16,383 symbols
    with pytest.raises(ValueError, match="frequency 0"):
        Tunstall.from_frequencies([3, 0, 1], 8).encode([0, 2, 1])


def test_every_skew_fits_the_table_at_twelve_bits():
    code = Tunstall.from_frequencies([(1 << 32) - 1, 1], 12)
    assert code.longest == 4095
    assert code.decode(code.encode([0] * 9000 + [1]), 9001).sum() == 1
