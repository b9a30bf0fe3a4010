"""STL, ascii and binary, block by block. Every triangle has three vertices of its own."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from . import _kernels
from .blocks import Blocks, FaceBlock, MeshSource, VertexBlock
from .checks import check_blocks
from .lines import line_chunks
from .numbers import settle
from .stream import ByteStream

__all__ = ["StlSource"]

_HEADER_BYTES = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_TRIANGLES_A_BLOCK = 1 << 15


class StlSource(MeshSource):
    """An STL file; see `MeshSource`. Its normals, which are the triangles' own, and colours are not kept."""

    def __init__(self, path: Path, *, up: str = "y") -> None:
        with ByteStream(path) as stream:
            head = stream.read(1 << 14)
            super().__init__(path.name, up, size_hint=stream.size)
            self._is_ascii = _is_ascii(head, None if stream.is_gzipped else stream.size)
        if not self._is_ascii and len(head) < _HEADER_BYTES:
            raise FovealError(f"{self.name}: it ends within the header of an STL file. Copy it again.")
        self._path = path

    def blocks(self) -> Blocks:
        return check_blocks(self._ascii_blocks() if self._is_ascii else self._binary_blocks(), self.name)

    def _binary_blocks(self) -> Blocks:
        with ByteStream(self._path) as stream:
            head = stream.read(_HEADER_BYTES)
            count = int.from_bytes(head[80:84], "little")
            done = 0
            while done < count:
                data = stream.read(_TRIANGLE.itemsize * min(_TRIANGLES_A_BLOCK, count - done))
                whole = len(data) // _TRIANGLE.itemsize
                if whole == 0:
                    raise FovealError(
                        f"{self.name}: the file ends after {done} of the {count} triangles of its header."
                        " Copy it again, or check that it is an STL file."
                    )
                table = np.frombuffer(data, dtype=_TRIANGLE, count=whole)
                self.bytes_read = stream.bytes_read
                with np.errstate(invalid="ignore"):  # NaN of any kind is refused later, in a sentence
                    corners = table["corners"].astype(np.float64)
                yield from _triangles(corners.reshape(-1, 3), 3 * done)
                done += whole
            self.bytes_read = self.size_hint

    def _ascii_blocks(self) -> Blocks:
        done, is_ended = 0, False
        left = np.empty((0, 3))  # corners of a triangle whose last are in the next chunk
        with ByteStream(self._path) as stream:
            for lines in line_chunks(stream, self.name):
                buffer = np.frombuffer(lines.data, dtype=np.uint8)
                values = np.empty(3 * (len(buffer) // 12 + 1))  # "vertex 0 0 0" is the shortest line
                slow = np.empty((len(values), _kernels.SLOW_COLUMNS), dtype=np.int64)
                count, doubts, fault, ended = _kernels.parse_vertex_lines(buffer, len(buffer), values, slow)
                if fault >= 0:
                    raise FovealError(
                        f"{self.name}: line {lines.number(fault)} is not a vertex with three numbers."
                        " The file is damaged; copy it again."
                    )
                settle(buffer, slow[:doubts], values, self.name)
                is_ended = ended or (is_ended and count == 0)
                points = np.concatenate([left, values[: 3 * count].reshape(-1, 3)])
                whole = len(points) // 3 * 3
                left = points[whole:]
                self.bytes_read = stream.bytes_read
                if whole:
                    yield from _triangles(points[:whole], done)
                done += whole
        if len(left) or not is_ended:
            raise FovealError(
                f"{self.name}: the file ends after {done // 3} triangles without endsolid. Copy it again."
            )
        self.bytes_read = self.size_hint


def _is_ascii(head: bytes, size: int | None) -> bool:
    """Binary files may begin with "solid", too: their size, or bytes that are no text, tell."""
    if size is not None and size == _HEADER_BYTES + 50 * int.from_bytes(head[80:84], "little"):
        return False
    return b"\0" not in head and bool(re.match(rb"(?i)\s*solid\b", head))


def _triangles(points: NDArray[np.float64], first: int) -> Blocks:
    yield VertexBlock(points)
    yield FaceBlock(np.arange(first, first + len(points)).reshape(-1, 3))
