"""What is done to files that are to be refused."""

import json
import struct
import zlib

import pytest

from foveal.base.errors import FovealError
from foveal.container import open_container


def assert_flips_refused(read, data):
    """No bit of a container can be another without a sentence."""
    for at in range(len(data)):
        for bit in (1, 128):
            damaged = bytearray(data)
            damaged[at] ^= bit
            if at not in (6, 7):  # the reserved word is not looked at
                with pytest.raises(FovealError):
                    read(bytes(damaged))


def rewritten(data, header=None, first=None):
    """The same file with other words in its header, or another chunk 0, under checksums that are right."""
    with open_container(data) as file:
        words, chunk = {**file.header, **(header or {})}, file.chunk(0) if first is None else first
        chunks = [chunk, *(file.chunk(i) for i in range(1, len(file)))]
    text = json.dumps({key: value for key, value in words.items() if value is not ...}).encode()
    text += b" " * (-len(text) % 4)
    index = b"".join(struct.pack("<II", len(chunk), zlib.crc32(chunk)) for chunk in chunks)
    check = zlib.crc32(index, zlib.crc32(text))
    prefix = struct.pack("<4sHHIII", b"FOV\x1a", 1, 0, len(text), len(chunks), check)
    return prefix + text + index + b"".join(chunk + bytes(-len(chunk) % 4) for chunk in chunks)
