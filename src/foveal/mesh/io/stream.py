"""A file read forwards, unpacked if it is gzipped, with its faults told as sentences."""

import gzip
import io
import os
import zlib
from pathlib import Path
from types import TracebackType
from typing import Self

from foveal.base.errors import FovealError

__all__ = ["ByteStream"]

_GZIP = b"\x1f\x8b"


class ByteStream:
    """Reads a file from its start to its end; `bytes_read` counts the bytes on disk.

    Raises
    ------
    FovealError
        If there is no such file, it is a folder or empty, or its gzip data are damaged.
    """

    def __init__(self, path: str | os.PathLike[str], /) -> None:
        self.path = Path(path)
        if self.path.is_dir():
            raise FovealError(f"{self.path}: this is a folder; name a mesh file in it.")
        try:
            self._file = self.path.open("rb")
        except (OSError, ValueError) as error:
            raise FovealError(f"{self.path}: {_why(error)}") from error
        try:
            self.size = os.fstat(self._file.fileno()).st_size
            self._unpacked: io.BufferedReader | gzip.GzipFile = self._file
            self.is_gzipped = self._file.peek(2)[:2] == _GZIP
            if self.is_gzipped:
                self._unpacked = gzip.GzipFile(fileobj=self._file)
        except BaseException:
            self._file.close()
            raise

    @property
    def bytes_read(self) -> int:
        """How many bytes of the file on disk have been used."""
        return self._file.tell()

    def read(self, count: int) -> bytes:
        """The next `count` bytes, fewer only at the end of the file."""
        try:
            data = self._unpacked.read(count)
        except EOFError as error:
            raise FovealError(
                f"{self.path}: the gzip data end in the middle. Copy or download the file again."
            ) from error
        except (OSError, zlib.error) as error:
            raise FovealError(
                f"{self.path}: it cannot be read to its end ({error}). Copy or download it again."
            ) from error
        return data

    def close(self) -> None:
        """Close the file; the stream cannot be read any more."""
        if self._unpacked is not self._file:
            self._unpacked.close()
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _why(error: Exception) -> str:
    if isinstance(error, FileNotFoundError):
        return "there is no such file. Check the path."
    if isinstance(error, PermissionError):
        return "this user may not read it. Change its permissions."
    return f"it cannot be opened ({error})."
