"""A `.fov` for any file: itself if it is one, else built into the user's cache, where it stays for next time.

The cache is named by what went in: the file's content, the options that change the bytes, and the code that
builds, so that a foveal that changed never meets its older self's files. It is kept below a number of bytes
by deleting what was not used for longest.
"""

import hashlib
import os
import time
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import platformdirs

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.mesh.trimesh import TriMesh

from .scene import Scene, read_scene, scene_of

if TYPE_CHECKING:
    from foveal.multires import BuildReport

__all__ = [
    "CACHE_BYTES",
    "BuildOptions",
    "build_file",
    "cache_folder",
    "load",
    "prepare",
    "prepare_mesh",
    "refuse_missing",
]

CACHE_BYTES = 10_000_000_000
"""How much the cache of built files may hold before the oldest go."""

_WHOLE = 64 << 20  # files up to this size are hashed whole (0.1 s), larger ones at both ends
_END = 1 << 20
_DIGITS = 20
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
        "auto" or "none"; see `foveal.multires.build`.
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
    source: str | os.PathLike[str] | TriMesh,
    output: str | os.PathLike[str],
    /,
    *,
    options: BuildOptions = BuildOptions(),
    progress: Progress = SILENT,
    **work: Any,
) -> "BuildReport":
    """Build a mesh file, or a mesh, into a `.fov`.

    Parameters
    ----------
    source, output
        What to read and where to write.
    options : BuildOptions
        What changes the bytes.
    progress, **work
        `memory_bytes`, `executor` and `workers` of `multires.build`, which also says what is raised.
    """
    from foveal import multires
    from foveal.base.jit import is_cold
    from foveal.mesh.io import open_source, source_from_mesh

    if is_cold():  # asked before the file is opened: to survey an OBJ compiles its reader
        progress.note("First run: the kernels are compiled, which takes about half a minute, once.")
    if isinstance(source, TriMesh):
        mesh = source_from_mesh(source, up=options.up or "y")
    else:
        refuse_missing(Path(source))
        is_built = Path(source).suffix.lower() == ".fov"
        mesh = (multires.source_of if is_built else open_source)(source, up=options.up)
    return multires.build(mesh, Path(output), progress=progress, **options.arguments(), **work)


def refuse_missing(path: Path) -> None:
    """A sentence where no file is."""
    if path.is_dir():
        raise FovealError(f"{path}: this is a folder; name a mesh file, a .fov or a scene.json.")
    if not path.exists():
        raise FovealError(f"{path}: there is no such file.")


def prepare(
    source: str | os.PathLike[str],
    /,
    *,
    options: BuildOptions = BuildOptions(),
    folder: str | os.PathLike[str] | None = None,
    limit_bytes: int = CACHE_BYTES,
    **work: Any,
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
    **work
        `progress`, `memory_bytes`, `executor` and `workers`, as in `multires.build`.

    Raises
    ------
    FovealError
        If the file is missing or cannot be read as what it seems to be.
    """
    path = Path(source)
    refuse_missing(path)
    if path.suffix.lower() == ".fov":
        return path
    root = Path(folder) if folder is not None else cache_folder()
    built = root / f"{_stem(path)}-{_fingerprint(path, options)}.fov"
    return _built_once(path, built, limit_bytes, options=options, **work)


def prepare_mesh(
    mesh: TriMesh,
    /,
    *,
    options: BuildOptions = BuildOptions(),
    folder: str | os.PathLike[str] | None = None,
    limit_bytes: int = CACHE_BYTES,
    **work: Any,
) -> Path:
    """The same for a mesh in memory."""
    state = hashlib.blake2b(f"{_builder()} {asdict(options)}".encode())
    for array in (mesh.positions, mesh.faces, mesh.normals, mesh.colours):
        state.update(b"none" if array is None else array.tobytes())
    root = Path(folder) if folder is not None else cache_folder()
    built = root / f"mesh-{state.hexdigest()[:_DIGITS]}.fov"
    return _built_once(mesh, built, limit_bytes, options=options, **work)


def _built_once(source: Path | TriMesh, built: Path, limit_bytes: int, **work: Any) -> Path:
    """`built`, after building it if it is not there."""
    if built.exists():
        # Only the time of use changes: that of writing is in the ETag, and browsers keep what they have.
        os.utime(built, ns=(time.time_ns(), built.stat().st_mtime_ns))
        return built
    _sweep_litter(built.parent)
    build_file(source, built, **work)
    _forget_oldest(built.parent, limit_bytes, keep=built)
    return built


def load(source: str | os.PathLike[str], /, **options: Any) -> Scene:
    """A scene of any file: a scene.json, a `.fov`, or a mesh file, which is built into the cache.

    Options and errors are those of `prepare` and `read_scene`.
    """
    path = Path(source)
    if path.suffix.lower() == ".json":
        return read_scene(path)
    built = prepare(path, **options)
    return scene_of(built, title=path.name.removesuffix(".gz").rpartition(".")[0] or path.name)


@cache
def _builder() -> str:
    """A name for the code that makes the bytes: 3 ms, and no room has to be imported for it."""
    package = Path(__file__).parents[1]
    state = hashlib.blake2b()
    for room in ("base", "coding", "container", "mesh", "multires"):
        for file in sorted((package / room).rglob("*.py")):
            state.update(file.read_bytes())
    return state.hexdigest()


def _stem(path: Path) -> str:
    name = path.name.removesuffix(".gz").rpartition(".")[0] or path.name
    return "".join(c if c.isalnum() or c in "-_" else "-" for c in name)[:60]


def _fingerprint(path: Path, options: BuildOptions) -> str:
    """A name for the content and the options."""
    status = path.stat()
    state = hashlib.blake2b(f"{_builder()} {asdict(options)} {path.suffixes[-2:]}".encode())
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
    return state.hexdigest()[:_DIGITS]


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
