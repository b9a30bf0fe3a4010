"""OBJ, read twice: once to see what it has, once for its blocks.

Normals and colours belong to vertices here, yet an OBJ file tells only with its last line whether each
vertex has one normal of its own, and the faces say where the texture lies. So a first pass counts, and
looks the texture up where there is one; the second streams.
"""

from collections.abc import Generator
from contextlib import closing
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..normals import unit_normals
from . import _kernels_obj as kernels
from .blocks import Blocks, FaceBlock, MeshSource, VertexBlock
from .checks import bytes_of_colours, check_blocks
from .obj_materials import TexturedColours
from .obj_parser import ObjParser
from .stream import ByteStream

__all__ = ["ObjSource"]


class ObjSource(MeshSource):
    """An OBJ file; see `MeshSource`. Polygons become fans; lines, curves and crease tags are passed by
    (`read_polygons` keeps the tags)."""

    def __init__(self, path: Path, *, up: str = "y") -> None:
        with ByteStream(path) as stream:
            super().__init__(path.name, up, size_hint=stream.size)
        self._path = path
        self._survey()

    def _survey(self) -> None:
        """Count, and find out whether there are normals and colours that can be kept."""
        everything = kernels.POINTS | kernels.UVS | kernels.NORMALS | kernels.FACES | kernels.MATERIALS
        parser = ObjParser(self._path, everything)
        textured = TexturedColours(self._path.parent)
        self._is_coloured, self._is_wide = False, False
        with closing(parser.rows()) as all_rows:
            for rows in all_rows:
                coloured = rows.points[:, 3] >= 0
                self._is_coloured |= bool(coloured.any())
                self._is_wide |= bool((rows.points[coloured, 3:] > 1).any())
                textured.take(rows)
        self._vertices = int(parser.counts[kernels.VERTICES])
        self._take_normals(parser.counts)
        self._textured = textured.finish(self._vertices)
        self.notes += textured.notes
        self.has_colours = self._is_coloured or self._textured is not None
        small = int(parser.counts[kernels.SMALL])
        if small:
            self.notes.append(f"{small} faces of fewer than three corners were left out")

    def _take_normals(self, counts: NDArray[np.int64]) -> None:
        directions = int(counts[kernels.DIRECTIONS])
        self.has_normals = directions == self._vertices > 0 and counts[kernels.STRAY] == 0
        if directions and not self.has_normals:
            self.notes.append(
                "its normals were left out, because they do not belong to one vertex each;"
                " normals are computed from the surface instead"
            )

    def blocks(self) -> Blocks:
        return check_blocks(self._raw_blocks(), self.name, self._vertices)

    def _raw_blocks(self) -> Blocks:
        parser = ObjParser(self._path, kernels.POINTS | kernels.FACES)
        begin = 0
        with closing(parser.rows()) as all_rows, closing(_Normals(self._path)) as normals:
            for rows in all_rows:
                self.bytes_read = parser.bytes_read
                count = len(rows.points)
                if count:
                    yield VertexBlock(
                        rows.points[:, :3].copy(),
                        unit_normals(normals.take(count)) if self.has_normals else None,
                        self._colours(rows.points[:, 3:], begin) if self.has_colours else None,
                    )
                    begin += count
                if len(rows.triangles):
                    yield FaceBlock(rows.triangles.copy(), rows.sizes.copy())
        self.bytes_read = self.size_hint

    def _colours(self, rows: NDArray[np.float64], begin: int) -> NDArray[np.uint8]:
        if self._textured is not None:
            return self._textured[begin : begin + len(rows)]
        colours = bytes_of_colours(rows, 1.0 if self._is_wide else 255.0)
        colours[rows[:, 0] < 0] = 255  # vertices without a colour among some with one
        return colours


class _Normals:
    """The file's `vn` lines, read beside its `v` lines by a second reader."""

    def __init__(self, path: Path) -> None:
        self._name = path.name
        self._rows: Generator[NDArray[np.float64], None, None] = self._read(path)
        self._left = np.empty((0, 3))

    def _read(self, path: Path) -> Generator[NDArray[np.float64], None, None]:
        with closing(ObjParser(path, kernels.NORMALS).rows()) as all_rows:
            for rows in all_rows:
                yield rows.normals.copy()

    def take(self, count: int) -> NDArray[np.float64]:
        parts, have = [self._left], len(self._left)
        while have < count:
            more = next(self._rows, None)
            if more is None:
                raise FovealError(f"{self._name}: it has changed while it was read. Read it again.")
            parts.append(more)
            have += len(more)
        joined = np.concatenate(parts)
        self._left = joined[count:]
        return joined[:count]

    def close(self) -> None:
        self._rows.close()
