"""A page in plain Python: what spec/wire.md says it does with a message, word by word."""

import math
import struct

ARRAYS = 5


class Refused(Exception):
    """The message is not what it should be."""


class Page:
    """The arrays as bytes, and what the last message told."""

    def __init__(self):
        self.arrays = [bytearray() for _ in range(ARRAYS)]
        self.sequence = 0
        self.head = {}

    def apply(self, message):
        """Take in a message, or raise and keep what was there."""
        head, ranges = parse(message)
        if head["base"] not in (0, self.sequence):
            raise Refused("gap")
        faces, vertices = head["faces"], head["vertices"]
        colours = 4 * vertices if head["flags"] & 8 else 0
        lengths = [12 * faces, 12 * vertices, 12 * vertices, -(-faces // 4) * 4, colours]
        arrays = (
            [bytearray() for _ in range(ARRAYS)] if head["base"] == 0 else [bytearray(a) for a in self.arrays]
        )
        for array, length in zip(arrays, lengths, strict=True):
            if len(array) > length:
                raise Refused("shrunk")
            array.extend(bytes(length - len(array)))
        last = (0, 0)
        for number, offset, content in ranges:
            if number >= ARRAYS or (number, offset) < last or offset + len(content) > lengths[number]:
                raise Refused("range")
            arrays[number][offset : offset + len(content)] = content
            last = (number, offset + len(content))
        self.arrays, self.sequence, self.head = arrays, head["sequence"], head

    @property
    def faces(self):
        words = struct.unpack(f"<{len(self.arrays[0]) // 4}I", self.arrays[0])
        return [words[i : i + 3] for i in range(0, len(words), 3)]

    @property
    def positions(self):
        return self._points(1)

    @property
    def starts(self):
        return self._points(2)

    @property
    def levels(self):
        return [tag & 31 for tag in self.arrays[3][: len(self.faces)]]

    @property
    def colours(self):
        return [tag >> 5 & 3 for tag in self.arrays[3][: len(self.faces)]]

    @property
    def vertex_colours(self):
        """Red, green, blue and 255, or nothing."""
        return [tuple(self.arrays[4][i : i + 4]) for i in range(0, len(self.arrays[4]), 4)]

    def _points(self, number):
        words = struct.unpack(f"<{len(self.arrays[number]) // 4}f", self.arrays[number])
        return [words[i : i + 3] for i in range(0, len(words), 3)]


def parse(message):
    """The header by name, and the ranges as (array, offset, bytes)."""
    names = "sequence base flags faces vertices triangles ranges milliseconds threshold"
    magic, *values = struct.unpack_from("<4s7I2f", message)
    head = dict(zip(names.split(), values, strict=True))
    if magic != b"FVL\x01" or head["flags"] > 15:
        raise Refused("magic")
    begin = 40 + 12 * head["ranges"]
    ranges = []
    for i in range(head["ranges"]):
        number, offset, length = struct.unpack_from("<3I", message, 40 + 12 * i)
        if length == 0 or offset % 4 or length % 4 or begin + length > len(message):
            raise Refused("range")
        ranges.append((number, offset, message[begin : begin + length]))
        begin += length
    if begin != len(message):
        raise Refused("length")
    head["is_settled"], head["is_limit"] = bool(head["flags"] & 1), bool(head["flags"] & 2)
    return head, ranges


def wish(*, seen=0, angle=0.0, away=4.0, edge_px=4.0, iterations=4, **rest):
    """A request for a view of something of size 2 about 0."""
    region = {"iterations": iterations, "edge_px": edge_px, "bend": 0}
    return {
        "camera": {
            "position": [away * math.sin(angle), 0.3 * away, away * math.cos(angle)],
            "target": [0, 0, 0],
            "up": [0, 1, 0],
            "fov": 0.7,
            "width": 800,
            "height": 600,
            "near": 0.01,
            "far": 100,
        },
        "criteria": {"front": region, "silhouette": region, "back": {**region, "iterations": 0}},
        "budget": 0,
        "positions": "control",
        "rate": 0,
        "seen": seen,
        **rest,
    }
