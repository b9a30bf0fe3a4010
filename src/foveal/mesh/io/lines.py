"""Text files in chunks of whole lines, with a way back from a place in a chunk to its line's number."""

from collections.abc import Generator

from foveal.base.errors import FovealError

from .stream import ByteStream

__all__ = ["Lines", "line_chunks"]

_CHUNK_BYTES = 1 << 19
_LONGEST_LINE = 1 << 24


class Lines:
    """Some whole lines of a file, the first of them being number `first` (from 1)."""

    def __init__(self, data: bytes, first: int) -> None:
        self.data, self.first = data, first

    def number(self, at: int) -> int:
        """The number of the line that holds byte `at` of the chunk."""
        return self.first + self.data[:at].count(b"\n")


def line_chunks(stream: ByteStream, name: str) -> Generator[Lines, None, None]:
    """Yield the file as chunks that end with a line's end; a `\\` there joins it to the next line."""
    rest, first = b"", 1
    while True:
        read = stream.read(_CHUNK_BYTES)
        data = rest + read
        cut = len(data) if not read else data.rfind(b"\n") + 1
        while read and cut and data[:cut].rstrip(b"\r\n").endswith(b"\\"):
            cut = data.rfind(b"\n", 0, cut - 1) + 1
        if cut:
            lines = Lines(data[:cut], first)
            first += lines.data.count(b"\n")
            yield lines
        rest = data[cut:]
        if len(rest) > _LONGEST_LINE:
            raise FovealError(f"{name}: line {first} is longer than 16 MB. Check that this is a mesh.")
        if not read:
            return
