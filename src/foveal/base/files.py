"""Outputs that appear whole or not at all, and scratch space that leaves no litter.

Both put the writer's process number into the name, so that the next run can tell what a killed one
left behind from what a running one still needs.
"""

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import psutil

from .errors import FovealError

__all__ = ["refuse_unwritable", "scratch", "whole_file", "whole_folder"]


def _sweep(folder: Path, pattern: str) -> None:
    """Delete what dead processes left in `folder`; `pattern` has the process number as group 1."""
    try:
        found = [(entry, re.fullmatch(pattern, entry.name)) for entry in folder.iterdir()]
    except OSError:
        return
    for entry, match in found:
        if match is None or psutil.pid_exists(int(match[1])):
            continue
        if entry.is_dir() and not entry.is_symlink():
            shutil.rmtree(entry, ignore_errors=True)
        else:
            entry.unlink(missing_ok=True)


def _part(path: Path) -> Path:
    """The hidden name beside `path` under which it is written, after sweeping earlier ones."""
    path.parent.mkdir(parents=True, exist_ok=True)
    _sweep(path.parent, rf"\.{re.escape(path.name)}\.(\d+)\.part")
    return path.with_name(f".{path.name}.{os.getpid()}.part")


def refuse_unwritable(path: str | os.PathLike[str], *, is_folder: bool = False) -> None:
    """Say before any work that `whole_file`, or `whole_folder`, could not write `path`.

    Nothing is made, nor are folders on the way.

    Raises
    ------
    FovealError
        If the nearest folder above `path` does not let files be made in it, or `path` is a folder and
        should be a file.
    """
    path = Path(path)
    if path.is_dir() and not is_folder:
        raise FovealError(f"{path}: this is a folder; name a file to write.")
    folder = next(parent for parent in path.absolute().parents if parent.exists())
    try:
        # Tried, not asked: os.access knows nothing of what is mounted to be read only.
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: OSError) -> FovealError:
    return FovealError(f"{path}: cannot be written here ({error.strerror}). Choose another place.")


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """Open `path` for writing such that it appears by rename when the block ends without an error.

    Folders on the way are made. A block that raises, or a process that is killed, leaves what was at
    `path` before; the next call for the same path removes what a killed one left.
    """
    path = Path(path)
    if path.is_dir():
        raise FovealError(f"{path}: this is a folder; name a file to write.")
    try:
        part = _part(path)
        stream = part.open("w+b")
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        with stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


@contextmanager
def whole_folder(path: str | os.PathLike[str], *, force: bool = False) -> Iterator[Path]:
    """Give a folder to fill that appears as `path` when the block ends without an error.

    A folder that is there already and not empty is refused unless `force`, which replaces it.
    """
    path = Path(path)
    if path.exists() and not path.is_dir():
        raise FovealError(f"{path}: this is a file; name a folder to write.")
    if path.exists() and any(path.iterdir()) and not force:
        raise FovealError(f"{path}: the folder is not empty. Use --force to replace it.")
    try:
        part = _part(path)
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir()
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        yield part
        if path.exists():
            shutil.rmtree(path)
        part.replace(path)
    finally:
        shutil.rmtree(part, ignore_errors=True)


@contextmanager
def scratch(folder: str | os.PathLike[str] | None = None) -> Iterator[Path]:
    """Give an empty folder for temporary files, in `folder` or the system's place, deleted at the end."""
    root = Path(folder) if folder is not None else Path(tempfile.gettempdir())
    root.mkdir(parents=True, exist_ok=True)
    _sweep(root, r"\.foveal-scratch-(\d+)-.*")
    path = Path(tempfile.mkdtemp(prefix=f".foveal-scratch-{os.getpid()}-", dir=root))
    try:
        yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)
