"""What all patches of a file share: the statistics that their bytes are coded with."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.coding import rans

from . import _kernels_layout as layout

__all__ = ["Tables"]

_DAMAGED = "the codec's tables are damaged ({}). Copy or build the file again."


@dataclass(frozen=True, eq=False)
class Tables:
    """The shared tables of a file. `spec/patch.md` has their bytes.

    Attributes
    ----------
    normal_bits : int
        Bits of each octahedral coordinate of the normals.
    weights : (kinds, rows, 4) int8
        Of predictions: per kind of vertex a base, and corrections by degrees, in 64ths.
    table_of, shift_of : (contexts,) uint8
        The table in which a context's symbols are coded, and how many bits below them are raw.
    frequencies : (tables, 64) int32
        Of each symbol; each row sums to 2^PROBABILITY_BITS.
    """

    normal_bits: int
    weights: NDArray[np.int8]
    table_of: NDArray[np.uint8]
    shift_of: NDArray[np.uint8]
    frequencies: NDArray[np.int32]

    @cached_property
    def starts(self) -> NDArray[np.int32]:
        """(tables, 64): the first slot of each symbol."""
        return rans.starts(self.frequencies)

    @cached_property
    def slots(self) -> NDArray[np.uint32]:
        """(tables, 2^PROBABILITY_BITS): what the decoder looks up."""
        return rans.slot_table(self.frequencies, bits=layout.PROBABILITY_BITS)

    @cached_property
    def all_weights(self) -> NDArray[np.int64]:
        """(kinds * degrees^3, 4): base and corrections added up for each kind and three degrees."""
        d = layout.DEGREES
        w = self.weights.astype(np.int64)
        base, a, b, v = w[:, :1], w[:, 1 : 1 + d], w[:, 1 + d : 1 + 2 * d], w[:, 1 + 2 * d :]
        total = (
            base[:, :, None, None] + a[:, :, None, None, :] + b[:, None, :, None, :] + v[:, None, None, :, :]
        )
        return np.ascontiguousarray(total.reshape(-1, 4))

    def to_bytes(self) -> bytes:
        """The tables as they stand at the end of chunk 0."""
        out = bytearray([self.normal_bits, len(self.frequencies)])
        out += self.weights.tobytes()
        key = self.table_of.astype(np.int64) << 4 | self.shift_of
        ends = np.flatnonzero(np.diff(key, append=-1))
        for end, run in zip(ends, np.diff(ends, prepend=-1), strict=True):
            out += bytes([self.table_of[end], self.shift_of[end]]) + _varint(int(run))
        for row in self.frequencies:
            used = np.flatnonzero(row)
            first, last = int(used[0]), int(used[-1])
            out += bytes([first, last])
            for frequency in row[first : last + 1]:
                out += _varint(int(frequency))
        return bytes(out)

    @classmethod
    def from_bytes(cls, data: bytes) -> "Tables":
        """Read what `to_bytes` wrote; anything else raises `FovealError`."""
        source = _Source(bytes(data))
        normal_bits, tables = source.byte(), source.byte()
        if not 4 <= normal_bits <= 14 or not tables:
            raise FovealError(_DAMAGED.format("their head"))
        shape = (layout.KINDS, layout.WEIGHT_ROWS, 4)
        weights = np.frombuffer(source.take(int(np.prod(shape))), np.int8).reshape(shape)
        table_of = np.empty(layout.CONTEXTS, np.uint8)
        shift_of = np.empty(layout.CONTEXTS, np.uint8)
        at = 0
        while at < layout.CONTEXTS:
            table, shift, run = source.byte(), source.byte(), source.varint()
            if table >= tables or shift > 15 or not 1 <= run <= layout.CONTEXTS - at:
                raise FovealError(_DAMAGED.format("their contexts"))
            table_of[at : at + run] = table
            shift_of[at : at + run] = shift
            at += run
        frequencies = np.zeros((tables, layout.SYMBOLS), np.int32)
        for row in frequencies:
            first, last = source.byte(), source.byte()
            for symbol in range(first, last + 1):
                row[min(symbol, layout.SYMBOLS - 1)] = min(source.varint(), 1 << layout.PROBABILITY_BITS)
            if last >= layout.SYMBOLS or row.sum() != 1 << layout.PROBABILITY_BITS:
                raise FovealError(_DAMAGED.format("their frequencies"))
        codes = frequencies[table_of[layout.CODE_AT : layout.WALK_AT], layout.CODES :]
        walks = frequencies[table_of[layout.WALK_AT], layout.WALK_FAR + 1 :]
        if codes.any() or walks.any() or not source.is_empty():
            raise FovealError(_DAMAGED.format("codes that do not exist"))
        return cls(normal_bits, weights, table_of, shift_of, frequencies)


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)


class _Source:
    """Bytes read from their start, refusing to go past their end."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def take(self, count: int) -> bytes:
        if self._at + count > len(self._data):
            raise FovealError(_DAMAGED.format("they end too early"))
        self._at += count
        return self._data[self._at - count : self._at]

    def byte(self) -> int:
        return self.take(1)[0]

    def varint(self) -> int:
        value = 0
        for shift in range(0, 28, 7):
            byte = self.byte()
            value |= (byte & 127) << shift
            if byte < 128:
                return value
        raise FovealError(_DAMAGED.format("a number that is too long"))

    def is_empty(self) -> bool:
        return self._at == len(self._data)
