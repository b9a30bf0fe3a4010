"""What verbs take as one surface: a path, or a mesh in memory."""

import os
from pathlib import Path
from typing import Any

from foveal.base.files import PathLike
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh

__all__ = ["Checked", "Source", "checked", "name_of", "triangles_of"]

Source = PathLike | TriMesh | PolyMesh
Checked = Path | TriMesh | PolyMesh


def checked(source: Any, /) -> Checked:
    """A path, or a mesh whose arrays are what they should be, which its constructor does not ask.

    An index that is no vertex would have kernels read what is not theirs.

    Raises
    ------
    FovealError
        As `TriMesh.of` and `PolyMesh.checked` do.
    TypeError
        If it is none of these.
    """
    if isinstance(source, TriMesh):
        return TriMesh.of(source.positions, source.faces, normals=source.normals, colours=source.colours)
    if isinstance(source, PolyMesh):
        return source.checked()
    if isinstance(source, (str, os.PathLike)):
        return Path(source)
    raise TypeError(
        "a path is needed, or a mesh as TriMesh.of(positions, faces) makes it, or PolyMesh.of; "
        f"got {type(source).__name__}"
    )


def name_of(source: Checked, /) -> str:
    """What errors call it.

    Examples
    --------
    >>> name_of(Path("statue.ply"))
    'statue.ply'
    """
    return str(source) if isinstance(source, Path) else "mesh"


def triangles_of(source: Checked, /) -> TriMesh:
    """All of it as triangles, of polygons the fans.

    Raises
    ------
    FovealError
        As `read` does.
    """
    from .read import read

    if isinstance(source, PolyMesh):
        return source.triangulated()
    return read(source) if isinstance(source, Path) else source
