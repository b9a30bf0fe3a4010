"""A `.fov` for any file: itself if it is one, else built into the user's cache, where it stays for next time.

The cache is named by what went in: the file's content, the options that change the bytes, and the code that
builds, so that a foveal that changed never meets its older self's files. It is kept below a number of bytes
by deleting what was not used for longest.
"""

import dataclasses
import hashlib
import os
import time
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, Unpack, cast

import numpy as np
import platformdirs

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing, refuse_unwritable
from foveal.base.progress import SILENT, Progress
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh

from .build import BuildOptions, build, title_of
from .cage_file import is_cage, read_cage
from .depth_rules import is_chosen
from .facing import Once, tell_inside_out
from .refinement import RefineOptions, chosen
from .scene import Layer, Scene, read_scene, scene_of
from .scene_light import light_file, with_light
from .source import Source, checked, name_of

__all__ = ["CACHE_BYTES", "cache_folder", "load", "prepare", "refuse_shaping"]

CACHE_BYTES = 10_000_000_000
"""How much the cache of built files may hold before the oldest go."""

# The options that change the bytes of a build.
_SHAPING = ("bits", "step", "normals", "up", "sharp_edges", "pair_triangles", "prim", "placements")
# and those that a scene can say of a control mesh
_REFINING = ("criteria", "depths", "positions", "budget", "rate")
_WHOLE = 64 << 20  # files up to this size are hashed whole (0.1 s), larger ones at both ends
_END = 1 << 20
_DIGITS = 20
_OLD_LITTER_S = 86_400
# Formats that point to further files, whose change must build anew.
_WITH_COMPANIONS = {".obj", ".gltf", ".dae"}
_COMPANIONS = {".mtl", ".bin", ".png", ".jpg", ".jpeg", ".webp", ".tga", ".bmp", ".tif"}


def cache_folder() -> Path:
    """Where built files are kept."""
    return Path(platformdirs.user_cache_dir("foveal")) / "built"


def load(
    source: Source | Scene,
    /,
    *,
    shadow: PathLike | None = None,
    progress: Progress = SILENT,
    **options: Unpack[BuildOptions],
) -> Scene:
    """A scene of anything that can be shown: how every verb that shows or copies a scene begins.

    Parameters
    ----------
    source : Scene, path, TriMesh or PolyMesh
        A scene is returned as it is. A path is of a scene.json, a `.fov`, or a mesh file; a mesh, in a
        file or in memory, is built into the user's cache unless it is there.
    shadow
        A `.fov` that `foveal.shadow` made, which becomes the scene's light.
    progress, **options
        As for `build`.

    Raises
    ------
    FovealError
        As for `prepare`, `read_scene` and `light_file`.
    """
    if shadow is not None:
        light_file(shadow)  # before minutes of building
    return with_light(_load(source, progress, options), shadow)


def _load(source: Source | Scene, progress: Progress, options: BuildOptions) -> Scene:
    if isinstance(source, Scene):
        refuse_shaping(f"the scene {source.title!r}", options)
        return source
    source = checked(source)
    if isinstance(source, Path) and source.suffix.lower() == ".json":
        refuse_shaping(source, options)
        scene = read_scene(source)
        for layer in scene.layers:
            _look_at(layer, str(layer.path), progress)
        return scene
    progress = Once(progress)
    title = title_of(source) if isinstance(source, Path) else "mesh"
    path = prepare(source, progress=progress, **options)
    scene = scene_of(path, title=title, options=cast(RefineOptions, options))
    _look_at(scene.layers[0], name_of(source), progress)
    return scene


def _look_at(layer: Layer, name: str, progress: Progress) -> None:
    """Of a control mesh, built now or long ago: tell that it is inside out, refuse what does not fit."""
    if layer.refinement is None:
        return
    cage = read_cage(layer.path)
    cage.refuse_misfit(layer.refinement.scheme, name)
    tell_inside_out(cage.mesh, name, progress)


def prepare(
    source: Source,
    /,
    *,
    folder: PathLike | None = None,
    limit_bytes: int = CACHE_BYTES,
    progress: Progress = SILENT,
    **options: Unpack[BuildOptions],
) -> Path:
    """The path of a `.fov` that shows `source`, built if the cache does not have it.

    Parameters
    ----------
    source : path, TriMesh or PolyMesh
        A `.fov`, which is returned as it is, or a mesh, in a file of any format or in memory.
    folder
        The cache; by default the user's.
    limit_bytes : int
        The cache is brought below this after a build; the new file itself always stays.
    progress, **options
        As for `build`. Another choice of what changes the bytes is another file in the cache.

    Raises
    ------
    FovealError
        If the file is missing or cannot be read as what it seems to be, or options are given for what is
        built already.
    """
    _refuse_unknown(options)
    root = Path(folder) if folder is not None else cache_folder()
    source = Path(source) if isinstance(source, (str, os.PathLike)) else source
    if isinstance(source, Path) and source.suffix.lower() == ".fov":
        refuse_missing(source)
        refuse_shaping(source, options, is_refined=is_cage(source))
        return source
    if chosen(options) is not None:  # how else it is refined the scene says, so one file will do
        options = cast(BuildOptions, {k: v for k, v in options.items() if k not in _REFINING})
    shaping = {name: _words(options.get(name)) for name in (*_SHAPING, "scheme")}
    if isinstance(source, Path):
        refuse_missing(source)
        name = f"{_stem(source)}-{_fingerprint(source, shaping)}"
    else:
        name = f"mesh-{_fingerprint_of_mesh(source, shaping)}"
    built = root / f"{name}.fov"
    if built.exists():
        # Only the time of use changes: that of writing is in the ETag, and browsers keep what they have.
        with suppress(OSError):  # somebody else's file can be shown all the same
            os.utime(built, ns=(time.time_ns(), built.stat().st_mtime_ns))
        return built
    _refuse_unwritable(root)
    _sweep_litter(root)
    build(source, built, progress=progress, **options)
    _forget_oldest(root, limit_bytes, keep=built)
    return built


def _words(value: object) -> object:
    """An option, written out in full."""
    return (
        value if value is None or isinstance(value, (str, bool, int, float)) else np.asarray(value).tolist()
    )


def _refuse_unwritable(root: Path) -> None:
    try:
        refuse_unwritable(root / "any.fov")
    except FovealError as error:
        raise FovealError(
            f"{root}: what is built cannot be kept here. Build it to a place of your own: "
            "foveal build FILE -o FILE.fov."
        ) from error


def refuse_shaping(source: PathLike, options: BuildOptions, /, *, is_refined: bool = False) -> None:
    """Say that options came too late, for what is built already; how a control mesh is refined may change.

    Raises
    ------
    FovealError
        If one of those that change the bytes was chosen.
    """
    _refuse_unknown(options)
    names = _SHAPING if is_refined else (*_SHAPING, "scheme", *_REFINING)
    late = [name for name in names if is_chosen(options, name)]
    if late:
        raise FovealError(
            f"{source}: it is built already, so {' and '.join(late)} would change nothing. "
            "Build it anew with 'foveal build'."
        )


def _refuse_unknown(options: BuildOptions) -> None:
    """What no signature says, since options pass through: a misspelt one must not be ignored."""
    unknown = options.keys() - BuildOptions.__annotations__.keys()
    if unknown:
        raise TypeError(f"there is no option {', '.join(sorted(unknown))}")


@cache
def _builder() -> str:
    """A name for the code that makes the bytes: 3 ms, and no room has to be imported for it."""
    package = Path(__file__).parents[1]
    state = hashlib.blake2b()
    rooms = (package / room for room in ("base", "coding", "container", "mesh", "multires"))
    files = (file for room in rooms for file in sorted(room.rglob("*.py")))
    own = ("cage_file.py", "cage_options.py", "cage_polygons.py", "depth_rules.py", "refinement.py")
    beside = (*(package / "scene" / name for name in own), package / "refine" / "slates_pairs.py")
    for file in (*files, *beside):
        state.update(file.read_bytes())
    return state.hexdigest()


def _stem(path: Path) -> str:
    return "".join(c if c.isalnum() or c in "-_" else "-" for c in title_of(path))[:60]


def _fingerprint(path: Path, shaping: dict[str, Any]) -> str:
    """A name for the content of a file and the options."""
    status = path.stat()
    state = hashlib.blake2b(f"{_builder()} {shaping} {path.suffixes[-2:]} {status.st_size}".encode())
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
        raise FovealError(f"{path}: cannot be read ({error.strerror}). Check its permissions.") from error
    if path.suffix.lower() in _WITH_COMPANIONS:
        for other in sorted((*path.parent.glob("*"), *path.parent.glob("*/*")))[:10_000]:
            if other.suffix.lower() in _COMPANIONS:
                status = other.stat()
                state.update(f"{other.name} {status.st_size} {status.st_mtime_ns}".encode())
    return state.hexdigest()[:_DIGITS]


def _fingerprint_of_mesh(mesh: TriMesh | PolyMesh, shaping: dict[str, Any]) -> str:
    """The same for a mesh in memory."""
    state = hashlib.blake2b(f"{_builder()} {shaping} {type(mesh).__name__}".encode())
    for field in dataclasses.fields(mesh):
        value = getattr(mesh, field.name)
        if isinstance(value, np.ndarray):
            state.update(f"{value.shape}".encode())
            state.update(np.ascontiguousarray(value).data)
        else:
            state.update(f"{value}".encode())
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
