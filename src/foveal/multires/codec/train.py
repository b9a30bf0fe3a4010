"""Statistics of patches, made into tables."""

from collections.abc import Iterable

from .patch import Patch
from .tables import Tables

__all__ = ["train"]


def train(patches: Iterable[Patch], /, *, normal_bits: int = 10) -> Tables:
    """Tables for a file that holds `patches`, or patches like them."""
    for _ in patches:
        pass
    return Tables(normal_bits)
