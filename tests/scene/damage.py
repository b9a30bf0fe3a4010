"""What is done to files that are to be refused."""

import pytest

from foveal.base.errors import FovealError


def assert_flips_refused(read, data):
    """No bit of a container can be another without a sentence."""
    for at in range(len(data)):
        for bit in (1, 128):
            damaged = bytearray(data)
            damaged[at] ^= bit
            if at not in (6, 7):  # the reserved word is not looked at
                with pytest.raises(FovealError):
                    read(bytes(damaged))
