"""What is chosen of polygons when a control mesh is made of them: which of a file's, pairs, placements."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, read_json
from foveal.base.progress import SILENT, Progress

from .control_mesh import MOST_CORNERS
from .depth_rules import is_chosen
from .source import Checked, name_of

if TYPE_CHECKING:
    from foveal.mesh.polymesh import PolyMesh

__all__ = [
    "placements_of",
    "placements_with",
    "polygons_with",
    "read_placements",
    "read_polygons",
    "with_pairs",
]


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


def placements_with(mesh: "PolyMesh", options: Mapping[str, Any], name: str, /) -> NDArray[np.float64] | None:
    """The `placements` that are chosen of a mesh, checked, or None.

    Raises
    ------
    FovealError
        As `placements_of` does.
    """
    given = options.get("placements")
    return None if given is None else placements_of(given, mesh, name)


def placements_of(given: ArrayLike, mesh: "PolyMesh", name: str, /) -> NDArray[np.float64]:
    """(k, 4, 4): matrices that are sure to place a mesh.

    Raises
    ------
    FovealError
        If one is none, which is named by its number, or there are too many, or they lead beyond float64.
    """
    from foveal.refine.slates_placements import Placements, placed

    matrices = Placements.of(given, name=name).matrices
    if len(matrices) * len(mesh.corners) > MOST_CORNERS:
        raise FovealError(
            f"{name}: {len(matrices):,} placements of {len(mesh.corners):,} corners are more than the "
            f"{MOST_CORNERS:,} of a control mesh. Give fewer."
        )
    with np.errstate(over="ignore", invalid="ignore"):
        is_there = np.isfinite(placed(mesh, matrices).positions).all(axis=1)
    if not is_there.all():
        number = int(is_there.argmin()) // len(mesh.positions)
        raise FovealError(f"{name}: placement {number}, counted from 0, leads beyond what numbers can say.")
    return matrices


def read_placements(path: PathLike, /) -> NDArray[np.float64]:
    """(k, 4, 4): the matrices of a JSON file, an array of them, each four rows of four numbers.

    Raises
    ------
    FovealError
        If it cannot be read, or one is no such matrix, which is named by its number.
    """
    from foveal.refine.slates_placements import Placements

    data = read_json(path)
    if not isinstance(data, list) or not data:
        raise FovealError(f"{path}: placements must be an array of matrices, each four rows of four numbers.")
    for number, matrix in enumerate(data):
        rows = matrix if isinstance(matrix, list) else []
        is_right = len(rows) == 4 and all(isinstance(row, list) and len(row) == 4 for row in rows)
        if not is_right or not all(type(x) in (int, float) for row in rows for x in row):
            raise FovealError(
                f"{path}: placement {number}, counted from 0, is not four rows of four numbers, such as "
                "[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], which moves by 5 along x."
            )
    return Placements.of(data, name=str(path)).matrices


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
        return read_polygons(path, progress=progress)
    mesh = read_polygons(path, prim=prim)
    if prim is None and len(names := meshes_of(path)) > 1:
        progress.note(
            f"{path}: it has {len(names)} meshes, of which {names[0]} is taken. --prim names another."
        )
    return mesh


def _refuse_prim(source: Checked, prim: str | None) -> None:
    if prim is not None:
        raise FovealError(f"{name_of(source)}: only a USD file has prims to choose from. Leave prim out.")
