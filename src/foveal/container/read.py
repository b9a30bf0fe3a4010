"""Read a `.fov`: from a path, from bytes, or from any address fsspec knows."""

import io
import json
import os
import zlib
from types import TracebackType
from typing import IO, Any, Self, cast

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from . import layout

__all__ = ["Container", "open_container"]


class Container:
    """An open `.fov`: header and index are checked and in memory, chunks are read when asked for.

    Attributes
    ----------
    name : str
        For messages.
    kind, version : str, int
        What the file holds.
    header : dict
        The header's JSON object.
    lengths, offsets : (chunks,) int64
        Where each chunk lies in the file, padding not counted.
    """

    def __init__(self, stream: IO[bytes], name: str) -> None:
        self._stream = stream
        self.name = name
        prefix = stream.read(layout.PREFIX.size)
        if len(prefix) < len(layout.MAGIC) or not prefix.startswith(layout.MAGIC):
            raise FovealError(f"{name}: this is not a .fov file. Make one with 'foveal build'.")
        if len(prefix) < layout.PREFIX.size:
            raise self._truncated()
        _, version, _, header_bytes, chunks, checksum = layout.PREFIX.unpack(prefix)
        if version != layout.CONTAINER_VERSION:
            raise FovealError(
                f"{name}: container version {version} is not known to this foveal, which reads version "
                f"{layout.CONTAINER_VERSION}. Use the foveal that wrote it, or build the file again."
            )
        if header_bytes > layout.MAX_HEADER_BYTES or not 1 <= chunks <= layout.MAX_CHUNKS:
            raise FovealError(f"{name}: its header is damaged (impossible sizes). Copy or build it again.")
        # Two reads, so that a damaged count cannot ask for more memory than the file has bytes.
        rest = stream.read(header_bytes + layout.CHUNK_ENTRY.size * chunks)
        if len(rest) < header_bytes + layout.CHUNK_ENTRY.size * chunks:
            raise self._truncated()
        if zlib.crc32(rest) != checksum:
            raise FovealError(f"{name}: header or index does not match its checksum. Copy or build it again.")
        self.header = self._parse_header(rest[:header_bytes])
        self.kind = cast(str, self.header["kind"])
        self.version = cast(int, self.header["version"])
        entries = np.frombuffer(rest, "<u4", offset=header_bytes).reshape(chunks, 2)
        self.lengths: NDArray[np.int64] = entries[:, 0].astype(np.int64)
        self._checksums = entries[:, 1]
        padded = -(-self.lengths // layout.ALIGNMENT) * layout.ALIGNMENT
        start = layout.PREFIX.size + len(rest)
        self.offsets: NDArray[np.int64] = start + np.cumsum(padded) - padded
        size = stream.seek(0, io.SEEK_END)
        if size != start + int(padded.sum()):
            raise FovealError(
                f"{name}: the file has {size} bytes where its index tells {start + int(padded.sum())}. "
                "Copy or build it again."
            )

    def _truncated(self) -> FovealError:
        return FovealError(f"{self.name}: the file ends within its header. Copy or build it again.")

    def _parse_header(self, text: bytes) -> dict[str, Any]:
        try:
            header = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise FovealError(
                f"{self.name}: the header is not JSON ({error}). Build the file again."
            ) from error
        if (
            not isinstance(header, dict)
            or not isinstance(header.get("kind"), str)
            or type(header.get("version")) is not int
        ):
            raise FovealError(
                f"{self.name}: the header does not tell kind and version. Build the file again."
            )
        return header

    def __len__(self) -> int:
        return len(self.lengths)

    def expect(self, kind: str, /, *versions: int) -> None:
        """Refuse, in a sentence, a file that is not of this kind and one of these versions."""
        if self.kind != kind:
            raise FovealError(f"{self.name}: it holds {self.kind!r}, where {kind!r} is wanted.")
        if self.version not in versions:
            known = " and ".join(map(str, versions))
            raise FovealError(
                f"{self.name}: {kind} version {self.version} is not known to this foveal, which reads "
                f"version {known}. Use the foveal that wrote it, or build the file again."
            )

    def chunk(self, number: int, /) -> bytes:
        """The bytes of chunk `number`, in [0, len(self)), after checking its checksum.

        Raises
        ------
        FovealError
            If the bytes are not those that were written.
        """
        self._stream.seek(int(self.offsets[number]))
        data = self._stream.read(int(self.lengths[number]))
        if len(data) != self.lengths[number] or zlib.crc32(data) != self._checksums[number]:
            raise FovealError(
                f"{self.name}: chunk {number} does not match its checksum. Copy or build the file again."
            )
        return data

    def close(self) -> None:
        """Close the file; chunks cannot be read after."""
        self._stream.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def open_container(source: str | os.PathLike[str] | bytes, /, *, name: str | None = None) -> Container:
    """Open a `.fov` for reading.

    Parameters
    ----------
    source
        A path, an address that fsspec knows (`s3://...`, `https://...`, read by ranges), or the bytes
        themselves.
    name
        How messages call the file; by default its path.

    Raises
    ------
    FovealError
        If it cannot be read, is no `.fov`, is damaged, or is of an unknown version.
    """
    if isinstance(source, bytes):
        return Container(io.BytesIO(source), name or "data")
    text = os.fspath(source)
    stream = _open_stream(text)
    try:
        return Container(stream, name or text)
    except OSError as error:
        stream.close()
        raise FovealError(f"{text}: cannot be read ({error.strerror or error}).") from error
    except BaseException:
        stream.close()
        raise


def _open_stream(text: str) -> IO[bytes]:
    try:
        if "://" in text:
            import fsspec  # only here: it costs 50 ms, and most files are local

            return cast(IO[bytes], fsspec.open(text, "rb").open())
        return open(text, "rb")
    except FileNotFoundError as error:
        raise FovealError(f"{text}: there is no such file.") from error
    except IsADirectoryError as error:
        raise FovealError(f"{text}: this is a folder; name a .fov file.") from error
    except (OSError, ImportError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise FovealError(f"{text}: cannot be opened ({reason}).") from error
