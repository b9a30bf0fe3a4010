"""The `.fov` file: header, index, chunks with checksums. Described byte by byte in spec/container.md."""

from .read import Container, open_container
from .write import Writer, create

__all__ = ["Container", "Writer", "create", "open_container"]
