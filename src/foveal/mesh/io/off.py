"""OFF, ascii, as one mesh in memory. trimesh fails where polygons of many sizes are mixed."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..normals import unit_normals
from ..trimesh import TriMesh
from .checks import bytes_of_colours
from .stream import ByteStream

__all__ = ["read_off"]

_WORD = re.compile(rb"(?:ST)?(C?)(N?)(4?)(n?)OFF")


def read_off(path: Path, /) -> tuple[TriMesh, NDArray[np.int64], list[str]]:
    """Read OFF, COFF, NOFF and CNOFF: the mesh, its polygons as fans, `FaceBlock.sizes` of them, and notes.

    Raises
    ------
    FovealError
        If it is damaged, ends too early, is binary or has no triangle.
    """
    with ByteStream(path) as stream:
        rows = [line.split(b"#", 1)[0].split() for line in stream.read(-1).splitlines()]
    rows = [row for row in rows if row]
    word = _WORD.fullmatch(rows[0][0]) if rows else None
    if word is None or word[3] or word[4]:
        raise FovealError(f"{path.name}: this kind of OFF is not read. Convert it to PLY.")
    start = 1 if rows[0][1:] else 2  # the counts may follow on the line of the word
    try:
        first = rows[0][1:] or rows[1]
        vertices, faces = int(first[0]), int(first[1])
        if min(vertices, faces) < 0:
            raise ValueError
    except (ValueError, IndexError):
        raise FovealError(
            f"{path.name}: its counts cannot be read (binary OFF is not). Convert it to PLY."
        ) from None
    if len(rows) < start + vertices + faces:
        raise FovealError(
            f"{path.name}: the file ends after {len(rows) - start} of {vertices + faces} rows. Copy it again."
        )
    return _mesh(path.name, rows[start : start + vertices], rows[start + vertices :][:faces], word)


def _mesh(
    name: str, points: list[list[bytes]], polygons: list[list[bytes]], word: "re.Match[bytes]"
) -> tuple[TriMesh, NDArray[np.int64], list[str]]:
    if not points:
        raise FovealError(f"{name}: there is no vertex in it. Choose a file with a triangle mesh.")
    width = min(map(len, points))
    table = _table(name, points, width)
    normals = colours = None
    after = 3
    if word[2] and width >= 6:
        normals, after = unit_normals(table[:, 3:6]), 6
    if width >= after + 3:  # files of plain "OFF" carry colours, too
        given = table[:, after : after + 3]
        is_wide = bool((given > 1).any()) or all(b"." not in v for v in points[0][after : after + 3])
        colours = bytes_of_colours(given, 1.0 if is_wide else 255.0)
    triangles, sizes = _fans(name, polygons)
    small = len(polygons) - len(sizes)
    notes = [f"{small} faces of fewer than three corners were left out"] if small else []
    if not len(triangles):
        raise FovealError(
            f"{name}: it holds {len(points)} points and no triangle. Make a surface of the points first."
        )
    return TriMesh.of(table[:, :3], triangles, normals=normals, colours=colours, name=name), sizes, notes


def _table(name: str, points: list[list[bytes]], width: int) -> NDArray[np.float64]:
    try:
        if width < 3:
            raise ValueError
        return np.array([[float(v) for v in row[:width]] for row in points])
    except ValueError:
        raise FovealError(
            f"{name}: a vertex is not three numbers. The file is damaged; copy it again."
        ) from None


def _fans(name: str, polygons: list[list[bytes]]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    fans, sizes = [], []
    for number, row in enumerate(polygons):
        try:
            count = int(row[0])
            corners = [int(v) for v in row[1 : 1 + count]]
            if not 0 <= count == len(corners) or max(map(abs, corners), default=0) >= 1 << 62:
                raise ValueError
        except ValueError:
            raise FovealError(
                f"{name}: face {number} cannot be read. The file is damaged; copy it again."
            ) from None
        sizes += [count] if count >= 3 else []
        fans += [(corners[0], corners[i], corners[i + 1]) for i in range(1, count - 1)]
    return np.array(fans, dtype=np.int64).reshape(-1, 3), np.array(sizes, dtype=np.int64)
