"""The header of a PLY file: which elements follow, with which properties, how encoded."""

import re
from dataclasses import dataclass, field

import numpy as np

from foveal.base.errors import FovealError

from .stream import ByteStream

__all__ = ["TYPES", "Element", "PlyHeader", "Property", "read_header"]

_LONGEST_HEADER = 1 << 18

TYPES = ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8", "i8", "u8")
"""NumPy's names of the types; a type's place in it is its number in the kernels."""

_NAMES = {
    **{"char": 0, "uchar": 1, "short": 2, "ushort": 3, "int": 4, "uint": 5, "float": 6, "double": 7},
    **{"int8": 0, "uint8": 1, "int16": 2, "uint16": 3, "int32": 4, "uint32": 5, "float32": 6},
    **{"float64": 7, "int64": 8, "uint64": 9},
}


@dataclass(frozen=True)
class Property:
    """A scalar, or a list where `count_type` is a type and not -1."""

    name: str
    type: int
    count_type: int = -1


@dataclass
class Element:
    """`count` rows of the same properties."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    @property
    def has_lists(self) -> bool:
        return any(p.count_type >= 0 for p in self.properties)

    def dtype(self, order: str) -> np.dtype[np.void]:
        """A row's layout in a binary file, for elements without lists."""
        return np.dtype([(f"f{i}", order + TYPES[p.type]) for i, p in enumerate(self.properties)])


@dataclass
class PlyHeader:
    """`encoding` is "ascii", "<" or ">"; `rest` are bytes of the body that were read along.

    `small` counts the polygons of fewer than three corners while the body is read.
    """

    encoding: str
    elements: list[Element]
    rest: bytes
    small: int = 0

    def count(self, name: str) -> int:
        """Rows of all elements called `name`."""
        return sum(e.count for e in self.elements if e.name == name)


def read_header(stream: ByteStream, name: str) -> PlyHeader:
    """Read up to `end_header` and its line's end.

    Raises
    ------
    FovealError
        If there is no such line, or a line that cannot be understood.
    """
    data = b""
    found = None
    while found is None:
        more = stream.read(4096)
        data += more
        found = re.search(rb"[\r\n][ \t]*end_header[ \t]*(\r\n|\n|\r(?!$))", data)
        if found is None and not more:  # the very end: a lone \r is a line's end, too
            found = re.search(rb"[\r\n][ \t]*end_header[ \t]*(\r\n|\n|\r|$)", data)
            if found is None:
                raise FovealError(f"{name}: the PLY header has no end_header. Copy the file again.")
        if found is None and len(data) > _LONGEST_HEADER:
            raise FovealError(f"{name}: the PLY header does not end. Export the file again.")
    lines = re.split(r"\r\n|\n|\r", data[: found.start()].decode("utf-8", "replace"))
    header = PlyHeader("", [], data[found.end() :])
    for number, line in enumerate(lines[1:], start=2):
        try:
            _take_line(header, line.split())
        except (IndexError, KeyError, ValueError):
            raise FovealError(
                f'{name}: line {number} of the PLY header, "{line[:60]}", cannot be understood.'
                " Export the file again."
            ) from None
    names = [e.name for e in header.elements]
    if len(set(names)) < len(names):
        raise FovealError(f"{name}: the PLY header names an element twice. Export the file again.")
    if not header.encoding:
        raise FovealError(f"{name}: the PLY header has no format line. Export the file again.")
    return header


def _take_line(header: PlyHeader, words: list[str]) -> None:
    if not words or words[0] in ("comment", "obj_info"):
        return
    if words[0] == "format":
        known = {"ascii": "ascii", "binary_little_endian": "<", "binary_big_endian": ">"}
        header.encoding = known[words[1]]
    elif words[0] == "element":
        if not re.fullmatch(r"[0-9]{1,18}", words[2]):
            raise ValueError
        header.elements.append(Element(words[1], int(words[2])))
    elif words[0] == "property" and words[1] == "list":
        count_type = _NAMES[words[2]]
        if count_type in (6, 7):
            raise ValueError
        header.elements[-1].properties.append(Property(words[4], _NAMES[words[3]], count_type))
    elif words[0] == "property":
        header.elements[-1].properties.append(Property(words[2], _NAMES[words[1]]))
    else:
        raise ValueError
