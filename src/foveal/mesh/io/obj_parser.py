"""The lines of an OBJ file as arrays, chunk by chunk."""

from collections.abc import Generator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from . import _kernels_obj as kernels
from .lines import Lines, line_chunks
from .numbers import settle
from .stream import ByteStream

__all__ = ["ObjParser", "ObjRows"]

_FAULTS = {
    kernels.BAD_NUMBERS: "has too few numbers",
    kernels.BAD_CORNER: "has a corner that cannot be read",
    kernels.BAD_INDEX: "names a vertex that does not exist (0, or too far back)",
}


@dataclass(frozen=True)
class ObjRows:
    """What some lines held.

    Attributes
    ----------
    points : (a, 6) float64
        x, y, z, red, green, blue; red is -1 where the line gives no colour.
    uvs, normals : (b, 2) float64, (c, 3) float64
    triangles, triangle_uvs : (d, 3) int64
        From 0; -1 for a corner without texture coordinates.
    sizes : (e,) int64
        Corners of the polygons that the triangles are fans of.
    statement : list of str
        The first word and the rest of a `usemtl`, `mtllib` or `t` line that comes after these, or none.
    """

    points: NDArray[np.float64]
    uvs: NDArray[np.float64]
    normals: NDArray[np.float64]
    triangles: NDArray[np.int64]
    triangle_uvs: NDArray[np.int64]
    sizes: NDArray[np.int64]
    statement: list[str]


class ObjParser:
    """Reads the lines whose bits are in `wanted`; `counts` are those of `_kernels_obj`."""

    def __init__(self, path: Path, wanted: int) -> None:
        self.counts = np.zeros(kernels.COUNTS_SIZE, dtype=np.int64)
        self.bytes_read = 0
        self._path, self._wanted = path, wanted

    def rows(self) -> Generator[ObjRows, None, None]:
        """All of the file, in order. Arrays are overwritten by the next ones."""
        with ByteStream(self._path) as stream:
            for lines in line_chunks(stream, self._path.name):
                self.bytes_read = stream.bytes_read
                yield from self._chunk(lines)

    def _chunk(self, lines: Lines) -> Generator[ObjRows, None, None]:
        buffer = np.frombuffer(lines.data, dtype=np.uint8)
        most = len(buffer) // 2 + 1  # a number, or a corner, and a blank
        rows = [np.empty((most // k + 1, w)) for k, w in ((4, 6), (2, 2), (4, 3))]
        triangles, uvs = (np.empty((most, 3), dtype=np.int64) for _ in range(2))
        sizes = np.empty(most, dtype=np.int64)
        slow = np.empty((most, kernels.SLOW_COLUMNS), dtype=np.int64)
        result = np.zeros(kernels.RESULT_SIZE, dtype=np.int64)
        at = 0
        while at < len(buffer):
            arrays = (*rows, triangles, uvs, sizes, slow, result)
            at = kernels.parse_lines(buffer, at, self._wanted, self.counts, *arrays)
            fault = int(result[kernels.FAULT])
            if fault in _FAULTS:
                raise FovealError(
                    f"{self._path.name}: line {lines.number(int(result[kernels.FAULT_AT]))}"
                    f" {_FAULTS[fault]}. The file is damaged; export or copy it again."
                )
            doubts = slow[: result[kernels.DOUBTS]]
            for table, values in enumerate(rows):
                settle(buffer, doubts[doubts[:, 3] == table, :3], values.reshape(-1), self._path.name)
            words: list[str] = []
            if fault == kernels.STATEMENT:
                stop = lines.data.find(b"\n", at)
                stop = len(buffer) if stop < 0 else stop
                words = lines.data[at:stop].decode("utf-8", "replace").strip().split(maxsplit=1)
                at = stop
            filled = [int(result[k]) for k in (kernels.POINT_ROWS, kernels.UV_ROWS, kernels.NORMAL_ROWS)]
            points, coordinates, normals = (r[:n] for r, n in zip(rows, filled, strict=True))
            count = int(result[kernels.TRIANGLES])
            polygons = sizes[: result[kernels.POLYGONS]]
            yield ObjRows(points, coordinates, normals, triangles[:count], uvs[:count], polygons, words)
