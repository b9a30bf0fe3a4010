"""What all tests share: how they find the data that is not part of the repository."""

from pathlib import Path

import pytest
from hypothesis import settings

# The compilation of a kernel must not be taken for a slow example.
settings.register_profile("kernels", deadline=None)
settings.load_profile("kernels")

_SHARED = Path(__file__).parents[2] / "shared" / "data"


def find_shared_data(name: str) -> Path:
    """The path of a development file, or a skip where it is not there."""
    path = _SHARED / name
    if not path.exists():
        pytest.skip(f"{name} is development data that is not here")
    return path


@pytest.fixture
def shared_data():
    """`shared_data("scans/igea.ply")` gives the path or skips."""
    return find_shared_data
