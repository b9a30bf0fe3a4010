"""Outputs that appear whole or not at all, scratch space that leaves no litter, and a sentence, before any
work, for what cannot be read or written.

Outputs and scratch have the writer's machine and process number in the name, so that the next run can tell
what a killed one left behind from what a running one still needs, also on a disk that machines share.
"""

import errno
import json
import os
import platform
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import blake2b
from pathlib import Path
from typing import Any, BinaryIO

import psutil

from .errors import FovealError

__all__ = [
    "PathLike",
    "is_filled",
    "read_json",
    "refuse_missing",
    "refuse_same",
    "refuse_unwritable",
    "scratch",
    "whole_file",
    "whole_folder",
]

PathLike = str | os.PathLike[str]

_MACHINE = blake2b(platform.node().encode(), digest_size=4).hexdigest()
_INSIDE = "foveal-new"  # in the hidden name of what will replace the content of a folder
_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_JSON_BYTES = 16 << 20  # a scene or a camera is small; more than this is something else


def refuse_missing(path: PathLike, /) -> None:
    """Say before any work that there is no file to read.

    Raises
    ------
    FovealError
        If there is nothing at `path`, or a folder, or a pipe or device, which cannot be read twice.
    """
    path = Path(path)
    if path.is_dir():
        raise FovealError(f"{path}: this is a folder; name a file.")
    if not path.exists():
        raise FovealError(f"{path}: there is no such file.")
    if not path.is_file():
        raise FovealError(f"{path}: this is a pipe or a device; name a file.")


def refuse_same(output: PathLike, source: PathLike, /) -> None:
    """Say before any work that an output would replace what it is made from.

    Raises
    ------
    FovealError
        If both are one file, by whatever names.
    """
    output, source = Path(output), Path(source)
    if output.exists() and source.exists() and output.samefile(source):
        raise FovealError(f"{output}: this is the input itself. Name another output.")


def read_json(path: PathLike, /) -> Any:
    """What a small JSON file holds.

    Raises
    ------
    FovealError
        If it is missing, cannot be read, is large, or is not JSON.
    """
    refuse_missing(path)
    try:
        with Path(path).open("rb") as stream:
            text = stream.read(_JSON_BYTES + 1)
    except OSError as error:
        raise FovealError(f"{path}: cannot be read ({error.strerror}). Check its permissions.") from error
    if len(text) > _JSON_BYTES:
        raise FovealError(f"{path}: it is too large for such a file. Check which one it is.")
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FovealError(f"{path}: this is not JSON ({error}). Correct it, or name another.") from error


def refuse_unwritable(path: PathLike, /, *, is_folder: bool = False) -> None:
    """Say before any work that `whole_file`, or `whole_folder`, could not write `path`.

    Nothing is made, nor are folders on the way.

    Raises
    ------
    FovealError
        If the folder that would hold it, or the nearest one above, does not let files be made in it; or
        `path` is a folder and should be a file.
    """
    path = Path(path)
    if path.is_dir() and not is_folder:
        raise FovealError(f"{path}: this is a folder; name a file to write.")
    inside = path.absolute() / "any" if is_folder else path.absolute()
    folder = next(parent for parent in inside.parents if parent.exists())
    try:
        # Tried, not asked: os.access knows nothing of what is mounted to be read only.
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise _unwritable(path, error) from error


def _unwritable(path: Path, error: OSError) -> FovealError:
    return FovealError(f"{path}: cannot be written here ({error.strerror}). Choose another place.")


@contextmanager
def _telling_full(what: str) -> Iterator[None]:
    """A sentence for a disk that is full, for a share or a file that may not grow."""
    try:
        yield
    except OSError as error:
        if error.errno not in _FULL:
            raise
        raise FovealError(f"{what} ({error.strerror}). Free some space, or choose another place.") from error


def _sweep(folder: Path, pattern: str) -> None:
    """Delete what dead processes of this machine left in `folder`; group 1 of `pattern` is their number."""
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


def _part(folder: Path, name: str) -> Path:
    """The hidden name in `folder` under which `name` is written, after sweeping earlier ones."""
    folder.mkdir(parents=True, exist_ok=True)
    _sweep(folder, rf"\.{re.escape(name)}\.{_MACHINE}-(\d+)\.part")
    return folder / f".{name}.{_MACHINE}-{os.getpid()}.part"


@contextmanager
def whole_file(path: PathLike, /) -> Iterator[BinaryIO]:
    """Open `path` for writing such that it appears by rename when the block ends without an error.

    Folders on the way are made. A block that raises, or a process that is killed, leaves what was at
    `path` before; the next call for the same path removes what a killed one left.
    """
    path = Path(path)
    if path.is_dir():
        raise FovealError(f"{path}: this is a folder; name a file to write.")
    try:
        part = _part(path.parent, path.name)
        stream = part.open("w+b")
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        with _telling_full(f"{path}: cannot be written to its end"), stream:
            yield stream
            stream.flush()
            os.fsync(stream.fileno())
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def is_filled(folder: PathLike, /) -> bool:
    """Whether there is anything in a folder but what a killed writer left, which is removed."""
    folder = Path(folder)
    _sweep(folder, rf"\.{_INSIDE}\.{_MACHINE}-(\d+)\.part")
    return any(folder.iterdir())


@contextmanager
def whole_folder(path: PathLike, /, *, force: bool = False) -> Iterator[Path]:
    """Give a folder to fill whose content appears at `path` when the block ends without an error.

    A folder that is there already and not empty is refused unless `force`, which replaces its content; the
    folder itself stays, so that a link, a mounted volume or somebody's working directory may be named.
    """
    path = Path(path)
    if path.exists() and not path.is_dir():
        raise FovealError(f"{path}: this is a file; name a folder to write.")
    is_there = path.is_dir()
    if is_there and not force and is_filled(path):
        raise FovealError(f"{path}: the folder is not empty. Use --force to replace it.")
    try:
        part = _part(path, _INSIDE) if is_there else _part(path.parent, path.name)
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir()
    except OSError as error:
        raise _unwritable(path, error) from error
    try:
        with _telling_full(f"{path}: cannot be written to its end"):
            yield part
        if is_there:
            _exchange(part, path)
        else:
            part.replace(path)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _exchange(part: Path, folder: Path) -> None:
    """Put what is in `part`, itself in `folder`, in the place of all else there: renames only, so at once."""
    new, old = list(part.iterdir()), [entry for entry in folder.iterdir() if entry != part]
    away = part / ".old"
    away.mkdir()
    try:
        for entry in old:
            entry.replace(away / entry.name)
        for entry in new:
            entry.replace(folder / entry.name)
    except BaseException:
        for entry in new:
            if not entry.exists():
                (folder / entry.name).replace(entry)
        for entry in away.iterdir():
            entry.replace(folder / entry.name)
        raise


@contextmanager
def scratch(folder: PathLike | None = None, /) -> Iterator[Path]:
    """Give an empty folder for temporary files, in `folder` or the system's place, deleted at the end."""
    root = Path(folder) if folder is not None else Path(tempfile.gettempdir())
    root.mkdir(parents=True, exist_ok=True)
    _sweep(root, rf"\.foveal-scratch-{_MACHINE}-(\d+)-.*")
    path = Path(tempfile.mkdtemp(prefix=f".foveal-scratch-{_MACHINE}-{os.getpid()}-", dir=root))
    try:
        with _telling_full(f"{root}: there is no room for temporary files"):
            yield path
    finally:
        shutil.rmtree(path, ignore_errors=True)
