"""What is chosen of polygons when a control mesh is made of them: which of a file's, triangles in pairs."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress

from .depth_rules import is_chosen
from .source import Checked, name_of

if TYPE_CHECKING:
    from foveal.mesh.polymesh import PolyMesh

__all__ = ["polygons_with", "read_polygons", "with_pairs"]


def polygons_with(
    source: Checked, options: Mapping[str, Any], /, *, progress: Progress = SILENT
) -> "PolyMesh":
    """The polygons of a source, as the options `prim` and `pair_triangles` have them.

    Raises
    ------
    FovealError
        As `read_polygons` and `with_pairs` do.
    """
    name = name_of(source)
    return with_pairs(read_polygons(source, prim=options.get("prim"), progress=progress), options, name)


def with_pairs(mesh: "PolyMesh", options: Mapping[str, Any], name: str, /) -> "PolyMesh":
    """The same polygons, or, where `pair_triangles` is chosen, with triangles joined in pairs.

    Raises
    ------
    FovealError
        If no two can be joined.
    """
    if not is_chosen(options, "pair_triangles"):
        return mesh
    from foveal.refine.slates_pairs import paired

    found = paired(mesh)
    if found.faces == mesh.faces:
        raise FovealError(
            f"{name}: it has no two triangles side by side, but for creases, so there is nothing to pair. "
            "Leave pair_triangles out."
        )
    return found


def read_polygons(source: Checked, /, *, prim: str | None = None, progress: Progress = SILENT) -> "PolyMesh":
    """The polygons of a mesh file with their tags; the triangles of a `.fov` of patches or of a mesh, welded.

    Raises
    ------
    FovealError
        If the file cannot be read, or is no surface, or a prim is named of what has none.
    """
    from foveal.mesh.polymesh import PolyMesh
    from foveal.mesh.topology import weld

    from .read import read

    if isinstance(source, Path) and source.suffix.lower() != ".fov":
        return _of_file(source, prim, progress)
    _refuse_prim(source, prim)
    if isinstance(source, PolyMesh):
        return source
    mesh = read(source) if isinstance(source, Path) else source
    return PolyMesh.of_triangles(weld(mesh)[0]).checked(name_of(source))


def _of_file(path: Path, prim: str | None, progress: Progress) -> "PolyMesh":
    from foveal.mesh.io import read_polygons
    from foveal.mesh.io.usd import SUFFIXES, meshes_of

    if path.suffix.lower() not in SUFFIXES:
        _refuse_prim(path, prim)
        return read_polygons(path)
    mesh = read_polygons(path, prim=prim)
    if prim is None and len(names := meshes_of(path)) > 1:
        progress.note(
            f"{path}: it has {len(names)} meshes, of which {names[0]} is taken. --prim names another."
        )
    return mesh


def _refuse_prim(source: Checked, prim: str | None) -> None:
    if prim is not None:
        raise FovealError(f"{name_of(source)}: only a USD file has prims to choose from. Leave prim out.")
