"""A `.fov` for any file: itself if it is one, else built into the user's cache, where it stays for next time.

The cache is named by what went in: the file's content, the options that change the bytes, and the version
of foveal. It is kept below a number of bytes by deleting what was not used for longest.
"""

import hashlib
import os
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import platformdirs

import foveal
from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor

__all__ = ["CACHE_BYTES", "BuildOptions", "build_file", "cache_folder", "prepare"]

CACHE_BYTES = 10_000_000_000
"""How much the cache of built files may hold before the oldest go."""

_WHOLE = 64 << 20  # files up to this size are hashed whole (0.1 s), larger ones at both ends
_END = 1 << 20
_OLD_LITTER_S = 86_400
# Formats that point to further files, whose change must build anew.
_WITH_COMPANIONS = {".obj", ".gltf", ".dae"}


@dataclass(frozen=True, slots=True)
class BuildOptions:
    """What changes the bytes of a build. None stands for the default of `foveal.multires.build`.

    Attributes
    ----------
    bits : int, optional
        Bits a coordinate over the largest extent.
    step : float, optional
        Grid step in the unit of the file, instead of `bits`.
    normals : str, optional
        Which normals are stored; see `foveal.multires.build`.
    up : str, optional
        The axis that points up, "x", "y" or "z"; by default the format's.
    """

    bits: int | None = None
    step: float | None = None
    normals: str | None = None
    up: str | None = None

    def arguments(self) -> dict[str, Any]:
        """The keyword arguments of `multires.build` that were chosen."""
        chosen = {"bits": self.bits, "step": self.step, "normals": self.normals}
        return {name: value for name, value in chosen.items() if value is not None}


def cache_folder() -> Path:
    """Where built files are kept."""
    return Path(platformdirs.user_cache_dir("foveal")) / "built"


def build_file(
    source: str | os.PathLike[str],
    output: str | os.PathLike[str],
    /,
    *,
    options: BuildOptions = BuildOptions(),
    memory_bytes: int | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    progress: Progress = SILENT,
) -> Any:
    """Build a mesh file into a `.fov` and return the `BuildReport`; errors as `multires.build`."""
    from foveal import multires
    from foveal.mesh.io import open_source

    path = Path(source)
    if path.is_dir():
        raise FovealError(f"{path}: this is a folder; name a mesh file.")
    if not path.exists():
        raise FovealError(f"{path}: there is no such file.")
    return multires.build(
        open_source(path, up=options.up),
        Path(output),
        memory_bytes=memory_bytes,
        executor=executor,
        workers=workers,
        progress=progress,
        **options.arguments(),
    )


def prepare(
    source: str | os.PathLike[str],
    /,
    *,
    options: BuildOptions = BuildOptions(),
    folder: str | os.PathLike[str] | None = None,
    limit_bytes: int = CACHE_BYTES,
    memory_bytes: int | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    progress: Progress = SILENT,
) -> Path:
    """The path of a `.fov` that shows `source`, built if the cache does not have it.

    Parameters
    ----------
    source
        A `.fov`, which is returned as it is, or a mesh file of any format.
    options : BuildOptions
        What changes the bytes of a build; another choice is another file in the cache.
    folder
        The cache; by default the user's.
    limit_bytes : int
        The cache is brought below this after a build; the new file itself always stays.
    memory_bytes, executor, workers, progress
        As in `multires.build`.

    Raises
    ------
    FovealError
        If the file is missing or cannot be read as what it seems to be.
    """
    path = Path(source)
    if path.is_dir():
        raise FovealError(f"{path}: this is a folder; name a mesh file, a .fov or a scene.json.")
    if not path.exists():
        raise FovealError(f"{path}: there is no such file.")
    if path.suffix.lower() == ".fov":
        return path
    root = Path(folder) if folder is not None else cache_folder()
    built = root / f"{_stem(path)}-{_fingerprint(path, options)}.fov"
    if built.exists():
        # Only the time of use changes: that of writing is in the ETag, and browsers keep what they have.
        os.utime(built, ns=(time.time_ns(), built.stat().st_mtime_ns))
        return built
    _sweep_litter(root)
    build_file(
        path,
        built,
        options=options,
        memory_bytes=memory_bytes,
        executor=executor,
        workers=workers,
        progress=progress,
    )
    _forget_oldest(root, limit_bytes, keep=built)
    return built


def _stem(path: Path) -> str:
    name = path.name.removesuffix(".gz").rpartition(".")[0] or path.name
    return "".join(c if c.isalnum() or c in "-_" else "-" for c in name)[:60]


def _fingerprint(path: Path, options: BuildOptions) -> str:
    """A name for the content and the options: 20 hexadecimal digits."""
    status = path.stat()
    state = hashlib.blake2b(f"{foveal.__version__} {asdict(options)} {path.suffixes[-2:]}".encode())
    state.update(f"{status.st_size}".encode())
    try:
        with path.open("rb") as stream:
            if status.st_size <= _WHOLE:
                state.update(stream.read())
            else:
                state.update(f"{status.st_mtime_ns}".encode())
                state.update(stream.read(_END))
                stream.seek(-_END, os.SEEK_END)
                state.update(stream.read())
    except OSError as error:
        raise FovealError(f"{path}: cannot be read ({error.strerror}).") from error
    if path.suffix.lower() in _WITH_COMPANIONS:
        for other in sorted((*path.parent.glob("*"), *path.parent.glob("*/*")))[:10_000]:
            if other.suffix.lower() in {
                ".mtl",
                ".bin",
                ".png",
                ".jpg",
                ".jpeg",
                ".webp",
                ".tga",
                ".bmp",
                ".tif",
            }:
                status = other.stat()
                state.update(f"{other.name} {status.st_size} {status.st_mtime_ns}".encode())
    return state.hexdigest()[:20]


def _sweep_litter(root: Path) -> None:
    """Delete unfinished files of killed builds that nobody tried again; the build sweeps its own name."""
    if not root.is_dir():
        return
    for part in root.glob(".*.part"):
        try:
            if time.time() - part.stat().st_mtime > _OLD_LITTER_S:
                part.unlink()
        except OSError:
            continue  # another process was quicker


def _forget_oldest(root: Path, limit_bytes: int, *, keep: Path) -> None:
    """Delete the built files that were not used for longest until the rest is within the limit."""
    files = []
    for path in root.glob("*.fov"):
        try:
            status = path.stat()
        except OSError:
            continue
        files.append((status.st_atime_ns, status.st_size, path))
    total = sum(size for _, size, _ in files)
    for _, size, path in sorted(files):
        if total <= limit_bytes:
            return
        if path == keep:
            continue
        try:
            path.unlink()
        except OSError:
            continue  # shown by another process on Windows
        total -= size
