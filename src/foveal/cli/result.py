"""What a command says on stdout: lines for people, JSON for programs."""

import json
import math
import re
from collections.abc import Iterable
from typing import Any

__all__ = ["counted", "plain", "print_json", "print_lines", "table"]

_CONTROL = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f]")


def plain(text: str) -> str:
    """A line without control characters: names in files that came from elsewhere could hold any.

    Examples
    --------
    >>> plain("statue\\x1b[2J.fov")
    'statue\\\\x1b[2J.fov'
    """
    return _CONTROL.sub(lambda found: rf"\x{ord(found[0]):02x}", text)


def print_lines(lines: Iterable[str]) -> None:
    """A result in words, on stdout."""
    print("\n".join(plain(line) for line in lines), flush=True)


def print_json(data: Any) -> None:
    """A result for programs, on stdout."""
    print(json.dumps(_plain(data), indent=1, ensure_ascii=False, allow_nan=False), flush=True)


def _plain(value: Any) -> Any:
    """As JSON knows it: NumPy's numbers and arrays as Python's, what is not finite as null."""
    if isinstance(value, dict):
        return {str(key): _plain(member) for key, member in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(member) for member in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if value is None or isinstance(value, (str, int, float, bool)) else str(value)


def counted(number: int, what: str, plural: str = "") -> str:
    """A number of things, in words.

    Examples
    --------
    >>> counted(1, "triangle"), counted(1234, "vertex", "vertices")
    ('1 triangle', '1,234 vertices')
    """
    return f"{number:,} {what if number == 1 else plural or what + 's'}"


def table(heads: list[str], rows: list[list[str]]) -> list[str]:
    """Columns of text, set right; plain, so that it can be piped and costs no import.

    Examples
    --------
    >>> print(*table(["level", "triangles"], [["0", "1,000"], ["1", "2,000"]]), sep="\\n")
    level  triangles
        0      1,000
        1      2,000
    """
    widths = [max(len(row[i]) for row in [heads, *rows]) for i in range(len(heads))]
    return ["  ".join(cell.rjust(w) for cell, w in zip(row, widths, strict=True)) for row in [heads, *rows]]
