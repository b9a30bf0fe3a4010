"""Media types by file name: our own table, as the system's is wrong for .js on some Windows set-ups."""

from pathlib import PurePath

__all__ = ["accepts_gzip", "is_text", "media_type"]

_TYPES = {
    ".css": "text/css; charset=utf-8",
    ".fov": "application/octet-stream",
    ".html": "text/html; charset=utf-8",
    ".ico": "image/x-icon",
    ".jpg": "image/jpeg",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".map": "application/json",
    ".mjs": "text/javascript; charset=utf-8",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
    ".woff2": "font/woff2",
}
_COMPRESSIBLE = {
    ".css",
    ".html",
    ".ico",
    ".js",
    ".json",
    ".map",
    ".mjs",
    ".svg",
    ".txt",
    ".wasm",
    ".webmanifest",
}


def media_type(path: str | PurePath, /) -> str:
    """The media type of a file name; unknown ones are bytes and nothing more.

    Examples
    --------
    >>> media_type("viewer/index.js")
    'text/javascript; charset=utf-8'
    """
    return _TYPES.get(PurePath(path).suffix.lower(), "application/octet-stream")


def is_text(path: str | PurePath, /) -> bool:
    """Whether gzip makes such a file smaller."""
    return PurePath(path).suffix.lower() in _COMPRESSIBLE


def accepts_gzip(header: bytes | None, /) -> bool:
    """Read an Accept-Encoding header (RFC 9110, section 12.5.3).

    Examples
    --------
    >>> accepts_gzip(b"br, gzip;q=0.5"), accepts_gzip(b"gzip;q=0, *"), accepts_gzip(b"*"), accepts_gzip(None)
    (True, False, True, False)
    """
    by_star = False
    for part in (header or b"").split(b","):
        name, _, parameters = part.partition(b";")
        quality = parameters.replace(b" ", b"").lower().removeprefix(b"q=")
        is_wanted = quality.strip(b"0.") != b"" or not quality
        name = name.strip().lower()
        if name in (b"gzip", b"x-gzip"):
            return is_wanted
        by_star = by_star or (name == b"*" and is_wanted)
    return by_star
