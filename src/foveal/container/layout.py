"""Offsets, limits and magic of the `.fov` file, in one place for reader and writer."""

import struct
from typing import Final

__all__ = [
    "ALIGNMENT",
    "CHUNK_ENTRY",
    "CONTAINER_VERSION",
    "MAGIC",
    "MAX_CHUNKS",
    "MAX_HEADER_BYTES",
    "PREFIX",
    "padding",
]

MAGIC: Final = b"FOV\x1a"
CONTAINER_VERSION: Final = 1
MAX_HEADER_BYTES: Final = 1 << 24
MAX_CHUNKS: Final = 1 << 24
ALIGNMENT: Final = 4

PREFIX: Final = struct.Struct("<4sHHIII")
"""magic, container version, reserved, header bytes, number of chunks, CRC-32 of header and index."""

CHUNK_ENTRY: Final = struct.Struct("<II")
"""length in bytes, CRC-32."""


def padding(length: int) -> int:
    """How many bytes bring `length` to a multiple of the alignment.

    >>> [padding(n) for n in range(5)]
    [0, 3, 2, 1, 0]
    """
    return -length % ALIGNMENT
