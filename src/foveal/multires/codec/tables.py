"""What all patches of a file share: the statistics that their bytes are coded with."""

from dataclasses import dataclass

from foveal.base.errors import FovealError

__all__ = ["Tables"]


@dataclass(frozen=True, slots=True)
class Tables:
    """The shared tables of a file.

    Attributes
    ----------
    normal_bits : int
        Bits of each octahedral coordinate of the normals.
    """

    normal_bits: int = 10

    def to_bytes(self) -> bytes:
        """The tables as they stand at the end of chunk 0."""
        return bytes([self.normal_bits])

    @classmethod
    def from_bytes(cls, data: bytes) -> "Tables":
        """Read what `to_bytes` wrote; anything else raises `FovealError`."""
        if len(data) != 1 or not 4 <= data[0] <= 14:
            raise FovealError("the codec's tables are damaged. Copy or build the file again.")
        return cls(data[0])
