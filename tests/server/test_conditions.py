"""Preconditions: the order and the comparisons of RFC 9110, section 13."""

import time

import pytest

from foveal.server.conditions import Version, is_range_valid, precondition

VERSION = Version(b'"abc"', 784111777)  # Sun, 06 Nov 1994 08:49:37 GMT, the RFC's own example
SAME = b"Sun, 06 Nov 1994 08:49:37 GMT"
LATER = b"Sun, 06 Nov 1994 08:49:38 GMT"
EARLIER = b"Sun, 06 Nov 1994 08:49:36 GMT"


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, None),
        ({b"if-none-match": b'"abc"'}, 304),
        ({b"if-none-match": b'W/"abc"'}, 304),
        ({b"if-none-match": b'"x", "abc"'}, 304),
        ({b"if-none-match": b"*"}, 304),
        ({b"if-none-match": b'"x"'}, None),
        ({b"if-none-match": b'"x"', b"if-modified-since": LATER}, None),  # the tag has the last word
        ({b"if-modified-since": SAME}, 304),
        ({b"if-modified-since": LATER}, 304),
        ({b"if-modified-since": EARLIER}, None),
        ({b"if-modified-since": b"yesterday"}, None),
        ({b"if-match": b'"abc"'}, None),
        ({b"if-match": b"*"}, None),
        ({b"if-match": b'W/"abc"'}, 412),  # a weak tag never matches strongly
        ({b"if-match": b'"x"', b"if-none-match": b'"abc"'}, 412),
        ({b"if-unmodified-since": EARLIER}, 412),
        ({b"if-unmodified-since": SAME}, None),
        ({b"if-unmodified-since": b"yesterday"}, None),
        ({b"if-match": b'"abc"', b"if-unmodified-since": EARLIER}, None),
    ],
)
def test_the_status_that_ends_a_request(headers, status):
    assert precondition(headers, VERSION) == status


@pytest.mark.parametrize(
    ("header", "is_valid"),
    [
        (None, True),
        (b'"abc"', True),
        (b'"abd"', False),
        (b'W/"abc"', False),
        (SAME, True),
        (LATER, False),
        (EARLIER, False),
        (b"nonsense", False),
    ],
)
def test_when_a_range_may_be_honoured(header, is_valid):
    assert is_range_valid(header, VERSION) is is_valid


def test_a_date_of_this_second_proves_nothing():
    now = Version(b'"abc"', int(time.time()))
    assert not is_range_valid(dict(now.headers())[b"last-modified"], now)


def test_what_has_no_date_ignores_dates():
    undated = Version(b'"abc"', None)
    assert precondition({b"if-modified-since": LATER}, undated) is None
    assert precondition({b"if-unmodified-since": EARLIER}, undated) is None
    assert not is_range_valid(SAME, undated)
    assert dict(undated.headers()) == {b"etag": b'"abc"'}
