"""The built viewer: where it lies, and which of its files may be given out or published."""

from pathlib import Path

from foveal.base.errors import FovealError
from foveal.base.files import PathLike

__all__ = ["viewer_files"]

_BUILT = Path(__file__).parents[1] / "viewer"
_NOTE = Path("bundle.json")  # by which hatch_build.py knows whether to build anew


def viewer_files(folder: PathLike | None = None, /) -> dict[str, Path]:
    """The viewer's files by address, such as ``"assets/index-3f2a.js"``.

    Hidden files, links that lead out of the folder, and the note of what it was built from are left out.

    Parameters
    ----------
    folder
        A built viewer; by default the one that comes with foveal.

    Raises
    ------
    FovealError
        If the viewer was not built.
    """
    root = Path(folder) if folder is not None else _BUILT
    if not (root / "index.html").is_file():
        raise FovealError(
            f"{root}: the viewer is not built. Run './do view' in a copy of the repository, "
            "or install a release."
        )
    inside = root.resolve()
    found = {}
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root)
        if any(part.startswith(".") for part in name.parts) or not path.is_file() or name == _NOTE:
            continue
        if path.resolve().is_relative_to(inside):
            found[name.as_posix()] = path.resolve()
    return found
