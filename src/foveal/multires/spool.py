"""Arrays kept in memory while there is room, in scratch files after that: one code path for all sizes.

Files are read by plain reads, not mapped: mapped pages would count as resident memory.
"""

import os
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

__all__ = ["Column", "Room", "Store"]

Arrays = tuple[NDArray[Any], ...]


class Room:
    """How many bytes all stores together may keep in memory, and where the rest goes."""

    def __init__(self, limit_bytes: int, folder: Path) -> None:
        self.left = limit_bytes
        self.folder = folder
        self._files = 0
        self._lock = threading.Lock()

    def take(self, nbytes: int) -> bool:
        """Reserve memory; False if it must go to a file."""
        with self._lock:
            if nbytes > self.left:
                return False
            self.left -= nbytes
            return True

    def give(self, nbytes: int) -> None:
        """Return what was reserved."""
        with self._lock:
            self.left += nbytes

    def file(self) -> "_File":
        """A new empty scratch file."""
        with self._lock:
            self._files += 1
            return _File(self.folder / f"{self._files}.spool")


class _File:
    """Bytes appended, and read back at any place."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.size = 0
        self._descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_TRUNC, 0o600)

    def append(self, data: NDArray[Any]) -> int:
        """Write at the end; returns where."""
        at = self.size
        self.write(at, data)
        self.size += data.nbytes
        return at

    def write(self, at: int, data: NDArray[Any]) -> None:
        view = memoryview(np.ascontiguousarray(data).reshape(-1).view(np.uint8).data)
        while len(view):
            done = os.pwrite(self._descriptor, view[: 1 << 30], at)
            view, at = view[done:], at + done

    def read(self, at: int, dtype: DTypeLike, shape: tuple[int, ...]) -> NDArray[Any]:
        out = np.empty(shape, dtype)
        view = memoryview(out.reshape(-1).view(np.uint8).data)
        while len(view):
            done = os.preadv(self._descriptor, [view[: 1 << 30]], at)
            if done == 0:
                raise OSError(f"{self.path}: a scratch file ends too early")
            view, at = view[done:], at + done
        return out

    def close(self) -> None:
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1
            self.path.unlink(missing_ok=True)


class Store:
    """Tuples of arrays, put once and got any number of times.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     store = Store(Room(limit_bytes=10, folder=pathlib.Path(folder)))
    ...     refs = [store.put((np.arange(n),)) for n in (1, 5)]  # 8 bytes fit, 40 go to a file
    ...     print([store.get(ref)[0].tolist() for ref in refs])
    ...     store.close()
    [[0], [0, 1, 2, 3, 4]]
    """

    def __init__(self, room: Room) -> None:
        self._room = room
        self._held: list[Arrays | None] = []
        self._places: list[list[tuple[int, str, tuple[int, ...]]]] = []
        self._file: _File | None = None
        self._reserved = 0

    def put(self, arrays: Sequence[NDArray[Any]], /) -> int:
        """Keep arrays and return their number. Not to be changed by the caller afterwards."""
        nbytes = sum(a.nbytes for a in arrays)
        if self._room.take(nbytes):
            self._reserved += nbytes
            self._held.append(tuple(arrays))
            self._places.append([])
        else:
            if self._file is None:
                self._file = self._room.file()
            self._held.append(None)
            self._places.append([(self._file.append(a), a.dtype.str, a.shape) for a in arrays])
        return len(self._held) - 1

    def get(self, number: int, /) -> Arrays:
        """The arrays put under `number`."""
        held = self._held[number]
        if held is not None:
            return held
        assert self._file is not None
        return tuple(self._file.read(*place) for place in self._places[number])

    def close(self) -> None:
        """Forget all."""
        self._held, self._places = [], []
        self._room.give(self._reserved)
        self._reserved = 0
        if self._file is not None:
            self._file.close()
            self._file = None


class Column:
    """A long table of rows that is filled block by block, then read by ranges or by row numbers."""

    def __init__(self, room: Room, dtype: DTypeLike, width: int) -> None:
        self._room = room
        self._dtype = np.dtype(dtype)
        self._width = width
        self._row_bytes = self._dtype.itemsize * width
        self._blocks: list[NDArray[Any]] = []
        self._whole: NDArray[Any] | None = None
        self._file: _File | None = None
        self._reserved = 0
        self.rows = 0

    def append(self, block: NDArray[Any], /) -> None:
        """Add rows at the end. The block is copied unless it is already of the column's type."""
        block = np.ascontiguousarray(block, self._dtype).reshape(-1, self._width)
        self.rows += len(block)
        # Twice: `seal` makes one array of the blocks.
        if self._file is None and self._room.take(2 * block.nbytes):
            self._reserved += 2 * block.nbytes
            self._blocks.append(block)
            return
        if self._file is None:
            self._file = self._room.file()
            for old in self._blocks:
                self._file.append(old)
            self._blocks = []
            self._release()
        self._file.append(block)

    def seal(self) -> None:
        """Call after the last `append`, before reading."""
        if self._file is not None:
            return
        if len(self._blocks) == 1:
            self._whole = self._blocks[0]
        else:
            self._whole = (
                np.concatenate(self._blocks) if self._blocks else np.empty((0, self._width), self._dtype)
            )
        self._blocks = []
        self._room.give(self._reserved - self._whole.nbytes)
        self._reserved = self._whole.nbytes

    def part(self, begin: int, end: int, /) -> NDArray[Any]:
        """Rows begin to end - 1, (k, width)."""
        end = min(end, self.rows)
        if self._whole is not None:
            return self._whole[begin:end]
        assert self._file is not None
        return self._file.read(begin * self._row_bytes, self._dtype, (end - begin, self._width))

    def take(self, numbers: NDArray[np.int64], /) -> NDArray[Any]:
        """The rows of these numbers, in any order and with repetitions, (k, width)."""
        if self._whole is not None:
            return self._whole[numbers]
        order = np.unique(numbers)
        if len(order) == 0:
            return np.empty((0, self._width), self._dtype)
        out = np.empty((len(order), self._width), self._dtype)
        # One read a run of near rows: a gap below 64 KB costs less to read than another call.
        gap = max(1, 65536 // self._row_bytes)
        ends = np.append(np.flatnonzero(np.diff(order) > gap) + 1, len(order))
        begin = 0
        for end in ends.tolist():
            first, last = int(order[begin]), int(order[end - 1])
            # A run may be long however few its rows are.
            while begin < end:
                stop = begin + int(np.searchsorted(order[begin:end], order[begin] + (1 << 20)))
                first, last = int(order[begin]), int(order[stop - 1])
                out[begin:stop] = self.part(first, last + 1)[order[begin:stop] - first]
                begin = stop
        return out[np.searchsorted(order, numbers)]

    def set(self, begin: int, rows: NDArray[Any], /) -> None:
        """Overwrite rows from `begin` on."""
        if self._whole is not None:
            if not self._whole.flags.writeable:
                self._whole = self._whole.copy()
            self._whole[begin : begin + len(rows)] = rows
            return
        assert self._file is not None
        self._file.write(begin * self._row_bytes, np.ascontiguousarray(rows, self._dtype))

    def _release(self) -> None:
        self._room.give(self._reserved)
        self._reserved = 0

    def close(self) -> None:
        """Forget all."""
        self._release()
        self._blocks, self._whole = [], None
        if self._file is not None:
            self._file.close()
            self._file = None
