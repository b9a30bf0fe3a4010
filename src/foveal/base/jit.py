"""The one place that decides how kernels are compiled and where the machine code is kept.

Numba's own cache looks only at the file of the function it stores: a kernel that calls one from
another file stays as it was when that other file changes (measured with numba 0.68: 20 where 30 was
right). So the cache folder is named by a digest of all kernel files: a changed kernel is a new folder.
"""

import hashlib
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import platformdirs
from numba import prange

__all__ = ["cache_folder", "inlined", "is_cold", "kernel", "lean", "prange"]

F = TypeVar("F", bound=Callable[..., object])

_PACKAGE = Path(__file__).parents[1]
_KEPT_VERSIONS = 3  # older folders of machine code are deleted


def _digest() -> str:
    """A name that changes with any kernel file, Numba or Python."""
    state = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for file in sorted(_PACKAGE.rglob("_kernels*.py")):
        state.update(file.relative_to(_PACKAGE).as_posix().encode())
        state.update(file.read_bytes())
    return state.hexdigest()[:16]


def _choose_folder() -> Path:
    # The user's own word goes first; then the usual place.
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else Path(platformdirs.user_cache_dir("foveal")) / "kernels"
    return root / _digest()


cache_folder = _choose_folder()
"""Where the machine code of this version of the kernels is kept."""


def is_cold() -> bool:
    """Whether nothing is compiled yet, so that a first command will be slow and should say so."""
    return not any(cache_folder.rglob("*.nbi"))


def _forget_old_versions() -> None:
    try:
        folders = sorted(cache_folder.parent.iterdir(), key=lambda f: f.stat().st_mtime, reverse=True)
    except OSError:
        return
    for old in folders[_KEPT_VERSIONS:]:
        if old != cache_folder and len(old.name) == len(cache_folder.name):
            shutil.rmtree(old, ignore_errors=True)


try:
    if not cache_folder.exists():
        cache_folder.mkdir(parents=True, exist_ok=True)
        _forget_old_versions()
    numba.config.CACHE_DIR = str(cache_folder)  # type: ignore[attr-defined]
    _CACHE = True
except OSError:  # a home that cannot be written to: compile anew each time rather than fail
    _CACHE = False


def kernel(function: F) -> F:
    """Compile `function` on its first call: strict arithmetic, no GIL, cached between runs.

    Division by zero gives infinity or NaN, as in NumPy. Fast-math is not offered: results must be the
    same on every machine.
    """
    return cast(F, numba.njit(cache=_CACHE, nogil=True, error_model="numpy")(function))


def lean(function: F) -> F:
    """A `kernel` that allocates nothing, for operators that are called a million times.

    It counts no references. Else each call that LLVM does not inline counts every array it was given up
    and down again, atomically: √3 refinement of 44,000 triangles took 38 ms so, and takes 11 ms.
    """
    uncounted: Any = {"_nrt": False}  # Numba's own option, which its types do not name
    return cast(F, numba.njit(cache=_CACHE, nogil=True, error_model="numpy", **uncounted)(function))


def inlined(function: F) -> F:
    """Compile a small helper into every kernel that calls it, under the same rules as `kernel`.

    A call that LLVM does not inline passes each array as seven to nine words: the patch decoder's inner
    loop took 108 ns a vertex with `kernel` helpers and takes 55 with these.
    """
    return cast(F, numba.njit(inline="always", nogil=True, error_model="numpy")(function))
