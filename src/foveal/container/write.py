"""Write a `.fov`: chunks are spooled as they come, the file appears whole at the end."""

import json
import os
import shutil
import tempfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, BinaryIO

from foveal.base.files import whole_file

from . import layout

__all__ = ["Writer", "create"]


class Writer:
    """Takes chunks 1, 2, ... as they come, then header and chunk 0. Made by `create`.

    The header tells sizes that are known only at the end and yet comes first in the file, so chunks
    wait in a spool beside the output: one sequential copy, little against the work of making them.
    """

    def __init__(self, spool: IO[bytes]) -> None:
        self._spool = spool
        self._entries: list[tuple[int, int]] = []
        self._header: Mapping[str, Any] | None = None
        self._first_chunk = b""

    def add_chunk(self, data: bytes, /) -> int:
        """Append a chunk and return its number, counted from 1."""
        self._entries.append((len(data), zlib.crc32(data)))
        self._spool.write(data)
        self._spool.write(bytes(layout.padding(len(data))))
        return len(self._entries)

    def finish(self, header: Mapping[str, Any], first_chunk: bytes, /) -> None:
        """Give the header and chunk 0, what a reader needs before any other chunk."""
        self._header = header
        self._first_chunk = first_chunk

    def _write_to(self, out: BinaryIO) -> None:
        if self._header is None:
            raise RuntimeError("finish() was not called: the file would have no header")
        entries = [(len(self._first_chunk), zlib.crc32(self._first_chunk)), *self._entries]
        if len(entries) > layout.MAX_CHUNKS:
            raise ValueError(f"a .fov holds at most {layout.MAX_CHUNKS} chunks, got {len(entries)}")
        index = b"".join(layout.CHUNK_ENTRY.pack(*entry) for entry in entries)
        header = _header_bytes(dict(self._header), len(index) + len(self._first_chunk))
        out.write(
            layout.PREFIX.pack(
                layout.MAGIC,
                layout.CONTAINER_VERSION,
                0,
                len(header),
                len(entries),
                zlib.crc32(index, zlib.crc32(header)),
            )
        )
        out.write(header)
        out.write(index)
        out.write(self._first_chunk)
        out.write(bytes(layout.padding(len(self._first_chunk))))
        self._spool.seek(0)
        shutil.copyfileobj(self._spool, out, 1 << 20)


def _header_bytes(header: dict[str, Any], beyond: int) -> bytes:
    """The header as padded JSON that states `first_bytes`, which depends on its own length."""
    length = 0
    while True:
        header["first_bytes"] = layout.PREFIX.size + length + beyond
        text = json.dumps(header, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
        text += b" " * layout.padding(layout.PREFIX.size + len(text))
        if len(text) == length:
            return text
        length = len(text)


@contextmanager
def create(path: str | os.PathLike[str], /, *, kind: str, version: int) -> Iterator[Writer]:
    """Write the `.fov` at `path`; it appears when the block ends without an error.

    Parameters
    ----------
    path
        The file to write; folders on the way are made, an older file is replaced at the end.
    kind, version
        What the file holds and the version of that kind; both go into the header.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "small.fov"
    >>> with create(path, kind="multires", version=1) as writer:
    ...     number = writer.add_chunk(b"the first patch")
    ...     writer.finish({"generator": "an example"}, b"the graph")
    >>> from foveal.container import open_container
    >>> with open_container(path) as file:
    ...     file.kind, file.chunk(0), file.chunk(number)
    ('multires', b'the graph', b'the first patch')
    """
    path = Path(path)
    with whole_file(path) as out, tempfile.TemporaryFile(dir=path.parent) as spool:
        writer = Writer(spool)
        yield writer
        if writer._header is not None:
            writer._header = {"kind": kind, "version": version, **writer._header}
        writer._write_to(out)
