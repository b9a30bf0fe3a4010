"""Conditional requests: has the client's copy gone stale (RFC 9110, section 13)."""

from collections.abc import Mapping
from dataclasses import dataclass
from email.utils import formatdate, parsedate_to_datetime
from functools import lru_cache
from time import time

__all__ = ["Version", "is_range_valid", "precondition"]


@dataclass(frozen=True, slots=True)
class Version:
    """What tells one state of a file from another.

    Attributes
    ----------
    etag : bytes
        Strong: with its quotation marks, without `W/`.
    modified : int or None
        Whole seconds since 1970; None for what was made in memory, where dates then play no part.
    """

    etag: bytes
    modified: int | None

    def headers(self) -> list[tuple[bytes, bytes]]:
        """ETag and Last-Modified as HTTP writes them."""
        if self.modified is None:
            return [(b"etag", self.etag)]
        return [(b"etag", self.etag), (b"last-modified", _http_date(self.modified))]


@lru_cache(maxsize=64)
def _http_date(seconds: int) -> bytes:
    return formatdate(seconds, usegmt=True).encode()


def precondition(headers: Mapping[bytes, bytes], version: Version, /) -> int | None:
    """The status that ends a GET or HEAD early, 304 or 412, or None to go on, in the RFC's order.

    Examples
    --------
    >>> version = Version(b'"5a"', 0)
    >>> precondition({b"if-none-match": b'"41", W/"5a"'}, version)
    304
    >>> precondition({b"if-match": b'"41"'}, version)
    412
    """
    if (match := headers.get(b"if-match")) is not None:
        if not _names(match, version, is_strong=True):
            return 412
    elif _is_newer(version, headers.get(b"if-unmodified-since")) is True:
        return 412
    if (none := headers.get(b"if-none-match")) is not None:
        return 304 if _names(none, version, is_strong=False) else None
    return 304 if _is_newer(version, headers.get(b"if-modified-since")) is False else None


def is_range_valid(if_range: bytes | None, version: Version, /) -> bool:
    """Whether a Range may be honoured: the client's part comes from the same state of the file.

    A weak tag never counts. A date counts only if it is exact and the file had been left alone for a
    second by now, as two writes within one second share it.
    """
    if if_range is None:
        return True
    if if_range.startswith((b'"', b"W/")):
        return if_range == version.etag
    modified = version.modified
    return modified is not None and _seconds(if_range) == modified and time() - modified > 1


def _is_newer(version: Version, date: bytes | None) -> bool | None:
    """Whether the file changed after the date; None where that cannot be said and the header is ignored."""
    seconds = _seconds(date)
    return None if seconds is None or version.modified is None else version.modified > seconds


def _names(header: bytes, version: Version, *, is_strong: bool) -> bool:
    """Whether a list of tags has the file's own. Our tags hold no comma, so a plain split will do."""
    if header.strip() == b"*":
        return True
    tags = [tag.strip() for tag in header.split(b",")]
    if not is_strong:
        tags = [tag.removeprefix(b"W/") for tag in tags]
    return version.etag in tags


def _seconds(date: bytes | None) -> int | None:
    if date is None:
        return None
    try:
        return int(parsedate_to_datetime(date.decode("latin-1")).timestamp())
    except (ValueError, OverflowError, TypeError):
        return None  # a date that is none is ignored
