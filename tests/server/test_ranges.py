"""The Range header: values by hand from RFC 9110, laws for any header, refusals."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.server.ranges import MAX_RANGES, Unsatisfiable, parse_range


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        (b"bytes=0-499", [(0, 500)]),
        (b"bytes=500-999", [(500, 1000)]),
        (b"bytes=-500", [(9500, 10000)]),
        (b"bytes=9500-", [(9500, 10000)]),
        (b"bytes=0-0,-1", [(0, 1), (9999, 10000)]),
        (b"bytes= 0-0 ,\t-1", [(0, 1), (9999, 10000)]),
        (b"BYTES=0-0", [(0, 1)]),
        (b"bytes=,0-0,,", [(0, 1)]),
        (b"bytes=0-99999999", [(0, 10000)]),
        (b"bytes=-99999999", [(0, 10000)]),
        (b"bytes=500-600,601-999", [(500, 601), (601, 1000)]),
        (b"bytes=500-700,601-999", [(500, 1000)]),
        (b"bytes=0-0,20000-", [(0, 1)]),
        (b"bytes=20-29,0-9", [(20, 30), (0, 10)]),
    ],
)
def test_what_the_rfc_says(header, expected):
    assert parse_range(header, 10000) == expected


@pytest.mark.parametrize(
    "header",
    [
        b"bytes",
        b"bytes=",
        b"bytes=,",
        b"bytes=a-b",
        b"bytes=1",
        b"bytes=-",
        b"bytes=5-4",
        b"bytes=0-9,5-4",
        b"bytes=+1-2",
        b"bytes=1 -2",
        b"bytes=1-2-3",
        b"bytes=0x1-2",
        b"bytes=1-\xb2",
        b"lines=0-9",
        b"bytes=" + b"1" * 30 + b"-",
        b"bytes=" + b",".join(b"%d-%d" % (2 * i, 2 * i) for i in range(MAX_RANGES + 1)),
        b"bytes=" + b"0-0," * 3000,
    ],
)
def test_what_is_not_understood_is_ignored(header):
    assert parse_range(header, 10000) is None


@pytest.mark.parametrize("header", [b"bytes=10000-", b"bytes=10000-10001", b"bytes=-0", b"bytes=-0,10000-"])
def test_ranges_behind_the_end_cannot_be_satisfied(header):
    with pytest.raises(Unsatisfiable):
        parse_range(header, 10000)


@given(
    st.lists(
        st.one_of(
            st.tuples(st.integers(0, 120), st.integers(0, 120)).map(lambda t: f"{min(t)}-{max(t)}"),
            st.integers(0, 120).map(lambda n: f"{n}-"),
            st.integers(0, 120).map(lambda n: f"-{n}"),
        ),
        min_size=1,
        max_size=8,
    ),
    st.integers(0, 100),
)
def test_exactly_the_bytes_asked_for_and_each_once(specs, size):
    wanted = set()
    for spec in specs:
        first, _, last = spec.partition("-")
        if first:
            wanted |= set(range(int(first), min(size, int(last) + 1 if last else size)))
        else:
            wanted |= set(range(max(0, size - int(last)), size))
    try:
        ranges = parse_range(f"bytes={','.join(specs)}".encode(), size)
    except Unsatisfiable:
        assert not wanted
        return
    served = [byte for start, stop in ranges for byte in range(start, stop)]
    assert sorted(served) == sorted(wanted)
    assert all(start < stop for start, stop in ranges)


@given(st.binary(max_size=60), st.integers(0, 1000))
def test_no_header_breaks_it(header, size):
    for text in (header, b"bytes=" + header):
        try:
            ranges = parse_range(text, size)
        except Unsatisfiable:
            continue
        assert ranges is None or all(0 <= start < stop <= size for start, stop in ranges)
