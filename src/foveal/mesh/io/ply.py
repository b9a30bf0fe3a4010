"""PLY, ascii and binary, block by block: polygons, tristrips, colours, normals, anything beside them."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..normals import unit_normals
from . import _kernels_ply as kernels
from .blocks import Blocks, FaceBlock, MeshSource, VertexBlock
from .checks import bytes_of_colours, check_blocks
from .numbers import NumberReader
from .ply_header import Element, PlyHeader, read_header
from .stream import ByteStream

__all__ = ["PlySource"]

_CHUNK_BYTES = 1 << 20
_POSITION = ("x", "y", "z")
_NORMAL = ("nx", "ny", "nz")
_COLOURS = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))

Rows = tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]
"""Scalars, triangles, and the corners of the polygons they come from: see `FaceBlock.sizes`."""


class PlySource(MeshSource):
    """A PLY file; see `MeshSource`. Its header is read at once."""

    def __init__(self, path: Path, *, up: str = "y") -> None:
        with ByteStream(path) as stream:
            header = read_header(stream, path.name)
            super().__init__(path.name, up, size_hint=stream.size)
        self._path = path
        self._vertices = header.count("vertex")
        vertex = next((e for e in header.elements if e.name == "vertex"), None)
        names = [p.name for p in vertex.properties if p.count_type < 0] if vertex else []
        if vertex is None or not set(_POSITION) <= set(names):
            raise FovealError(
                f"{self.name}: it has no vertices with x, y and z. Export a mesh with vertices."
            )
        self.has_normals = set(_NORMAL) <= set(names)
        self._colour_names = next((c for c in _COLOURS if set(c) <= set(names)), None)
        self.has_colours = self._colour_names is not None
        self._is_wide = False  # whether float colours go to 255 rather than 1

    def blocks(self) -> Blocks:
        return check_blocks(self._raw_blocks(), self.name, self._vertices)

    def _raw_blocks(self) -> Blocks:
        self._is_wide = False
        with ByteStream(self._path) as stream:
            header = read_header(stream, self.name)
            body = _AsciiBody(stream, self.name, header) if header.encoding == "ascii" else None
            for element in header.elements:
                if not element.properties:
                    continue
                rows = body.rows(element) if body else _binary_rows(stream, self.name, header, element)
                for scalars, faces, sizes in rows:
                    self.bytes_read = stream.bytes_read
                    if element.name == "vertex" and len(scalars):
                        yield self._vertex_block(element, scalars)
                    if len(faces) or len(sizes):
                        yield FaceBlock(faces, sizes)
            self.bytes_read = self.size_hint
            note = f"{header.small} faces of fewer than three corners were left out"
            if header.small and note not in self.notes:
                self.notes.append(note)

    def _vertex_block(self, element: Element, rows: NDArray[np.float64]) -> VertexBlock:
        place = {p.name: i for i, p in enumerate(element.properties)}
        positions = np.ascontiguousarray(rows[:, [place[n] for n in _POSITION]])
        normals = unit_normals(rows[:, [place[n] for n in _NORMAL]]) if self.has_normals else None
        colours = None
        if self._colour_names is not None:
            columns = [place[n] for n in self._colour_names]
            colours = self._colour_bytes(rows[:, columns], element.properties[columns[0]].type)
        return VertexBlock(positions, normals, colours)

    def _colour_bytes(self, values: NDArray[np.float64], kind: int) -> NDArray[np.uint8]:
        if kind in (6, 7):  # floats: 0 to 1, but some writers put bytes into floats
            self._is_wide = self._is_wide or bool((values > 1).any())
            return bytes_of_colours(values, 1.0 if self._is_wide else 255.0)
        return bytes_of_colours(values, 1 / 257 if kind == 3 else 1.0)


def _kinds(element: Element) -> NDArray[np.int64]:
    """What the walk does with each property."""
    kinds = np.full(len(element.properties), kernels.SKIPPED, dtype=np.int64)
    for i, p in enumerate(element.properties):
        if p.count_type < 0:
            kinds[i] = kernels.SCALAR
        elif p.name in ("vertex_indices", "vertex_index"):
            if element.name == "face":
                kinds[i] = kernels.POLYGON
            elif element.name == "tristrips":
                kinds[i] = kernels.STRIPS
    return kinds


class _Walk:
    """An element with lists, followed through whatever values come."""

    def __init__(self, element: Element, name: str) -> None:
        self.element, self.name = element, name
        self.kinds = _kinds(element)
        self.state = np.zeros(kernels.STATE_SIZE, dtype=np.int64)
        self.state[kernels.LEFT] = -1
        self.begun = np.zeros(len(self.kinds))  # scalars of a row whose end is still to come

    @property
    def is_done(self) -> bool:
        return bool(self.state[kernels.ROW] >= self.element.count)

    def take(self, values: NDArray[np.float64]) -> tuple[Rows, int]:
        """Whole rows' scalars and all triangles of `values`, and how many values were used."""
        fields, begin = len(self.kinds), int(self.state[kernels.ROW])
        scalars = np.zeros((len(values) // fields + 2, fields))
        faces = np.empty((len(values), 3), dtype=np.int64)
        sizes = np.empty(len(values), dtype=np.int64)
        scalars[0] = self.begun
        count = kernels.walk_rows(values, self.kinds, self.element.count, self.state, scalars, faces, sizes)
        row, fault = int(self.state[kernels.ROW]), int(self.state[kernels.FAULT])
        if fault:
            what = "a list whose length" if fault == kernels.BAD_COUNT else "an index that"
            raise FovealError(
                f"{self.name}: {self.element.name} {row} has {what} is no such number. The file is damaged;"
                " copy it again."
            )
        self.begun = scalars[row - begin].copy()
        sizes = sizes[: self.state[kernels.POLYGONS]].copy()
        return (scalars[: row - begin], faces[:count].copy(), sizes), int(self.state[kernels.USED])


def _truncated(name: str, element: Element, rows: int) -> FovealError:
    return FovealError(
        f"{name}: the file ends after {rows} of {element.count} rows of {element.name}. Copy it again."
    )


_NO_FACES = np.empty((0, 3), dtype=np.int64)
_NO_SIZES = np.empty(0, dtype=np.int64)


class _AsciiBody:
    """The numbers after an ascii header, dealt out to its elements."""

    def __init__(self, stream: ByteStream, name: str, header: PlyHeader) -> None:
        self._numbers = NumberReader(stream, name, header.rest)
        self._name, self._header = name, header
        self._rest = np.empty(0)

    def _more(self, element: Element, rows: int) -> NDArray[np.float64]:
        read = self._numbers.read()
        if len(read) == 0:
            raise _truncated(self._name, element, rows)
        return np.concatenate([self._rest, read]) if len(self._rest) else read

    def rows(self, element: Element) -> Iterator[Rows]:
        if element.has_lists:
            yield from self._rows_with_lists(element)
            return
        fields, done = len(element.properties), 0
        while done < element.count:
            values = self._rest
            while len(values) < fields:
                values = self._more(element, done)
                self._rest = values.copy() if len(values) < fields else values
            count = min(element.count - done, len(values) // fields)
            self._rest = values[count * fields :].copy()
            done += count
            yield values[: count * fields].reshape(-1, fields), _NO_FACES, _NO_SIZES

    def _rows_with_lists(self, element: Element) -> Iterator[Rows]:
        walk = _Walk(element, self._name)
        while not walk.is_done:
            values = self._rest if len(self._rest) else self._more(element, int(walk.state[kernels.ROW]))
            self._rest = self._rest[:0]
            rows, used = walk.take(values)
            self._rest = values[used:].copy()
            yield rows
        self._header.small += int(walk.state[kernels.SMALL])


def _binary_rows(stream: ByteStream, name: str, header: PlyHeader, element: Element) -> Iterator[Rows]:
    if element.has_lists:
        yield from _binary_lists(stream, name, header, element)
        return
    layout = element.dtype(header.encoding)
    done = 0
    while done < element.count:
        count = min(element.count - done, max(1, _CHUNK_BYTES // layout.itemsize))
        data = _read_on(stream, header, count * layout.itemsize)
        whole = len(data) // layout.itemsize
        if whole:
            table = np.frombuffer(data, dtype=layout, count=whole)
            assert layout.names is not None
            with np.errstate(invalid="ignore"):  # NaN of any kind is refused later, in a sentence
                columns = [table[n].astype(np.float64) for n in layout.names]
            yield np.stack(columns, axis=1), _NO_FACES, _NO_SIZES
        done += whole
        if whole < count:
            raise _truncated(name, element, done)


def _read_on(stream: ByteStream, header: PlyHeader, count: int) -> bytes:
    """The next bytes of the body, of which the header's reader may hold the first."""
    data, header.rest = header.rest[:count], header.rest[count:]
    return data + stream.read(count - len(data)) if len(data) < count else data


def _binary_lists(stream: ByteStream, name: str, header: PlyHeader, element: Element) -> Iterator[Rows]:
    walk = _Walk(element, name)
    types = np.array([p.type for p in element.properties], dtype=np.int64)
    count_types = np.array([p.count_type for p in element.properties], dtype=np.int64)
    state = np.array([0, 0, -1], dtype=np.int64)
    values = np.empty(_CHUNK_BYTES + 16)
    rest = b""
    while not walk.is_done:
        data = rest + _read_on(stream, header, _CHUNK_BYTES)
        buffer = np.frombuffer(data, dtype=np.uint8)
        used, count = kernels.decode_rows(
            buffer,
            len(buffer),
            walk.kinds,
            types,
            count_types,
            header.encoding == ">",
            element.count,
            state,
            values,
        )
        rows, _ = walk.take(values[:count])
        if used == 0:
            raise _truncated(name, element, int(walk.state[kernels.ROW]))
        rest = data[used:]
        yield rows
    header.rest = rest + header.rest
    header.small += int(walk.state[kernels.SMALL])
