"""A mesh file of a chosen fineness from a `.fov` or from another mesh."""

from pathlib import Path
from typing import Unpack

import numpy as np

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing, refuse_same, refuse_unwritable
from foveal.base.progress import SILENT, Progress
from foveal.lod.graph import Graph
from foveal.mesh.trimesh import TriMesh

from .build import BuildOptions, up_of
from .cage_file import is_cage, read_cage
from .prepare import prepare, refuse_shaping
from .source import Checked, Source, checked, name_of, triangles_of

__all__ = ["error_for_triangles", "export", "refuse_mesh_output", "write_mesh"]

_SUFFIXES = (".ply", ".glb")


def export(
    source: Source,
    output: PathLike | None = None,
    /,
    *,
    error: float | None = None,
    triangles: int | None = None,
    progress: Progress = SILENT,
    **options: Unpack[BuildOptions],
) -> TriMesh:
    """A mesh that is as coarse as an error or a number of triangles allows, and a PLY or GLB of it.

    Parameters
    ----------
    source : path, TriMesh or PolyMesh
        A `.fov`, or a mesh, which is built into the user's cache first if it has to become coarser.
    output : path, optional
        Where to write it too; the suffix, `.ply` or `.glb`, says the format.
    error : float, optional
        Largest distance to the original, in the unit of the file; by default the original's triangles.
    triangles : int, optional
        As fine as this many triangles allow; not together with `error`.
    progress, **options
        As for `build`.

    Returns
    -------
    TriMesh
        With vertices of its own, those of the source or fewer.

    Raises
    ------
    FovealError
        If the format is not known, or even the coarsest level has more triangles than wanted.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "sphere.fov"
    >>> report = foveal.build(icosphere(2), path)
    >>> len(foveal.export(path, path.with_suffix(".ply")).faces)
    320
    """
    from foveal import multires

    source = checked(source)
    name = name_of(source)
    _refuse_limits(name, error, triangles)
    if isinstance(source, Path):
        _refuse_source(source)
    if output is not None:
        refuse_mesh_output(Path(output), source)
    up = up_of(options)
    shaped = error, triangles, *(options.get(option) for option in ("bits", "step", "normals"))
    if isinstance(source, Path) and is_cage(source):
        refuse_shaping(source, options, is_refined=True)
        mesh, up = _whole(source, error, triangles)
    elif _is_fov(source) or any(value is not None for value in shaped):
        with multires.open(prepare(source, progress=progress, **options)) as asset:
            if triangles is not None:
                error = error_for_triangles(asset.graph, triangles, name=name)
            mesh, up = multires.extract(asset, error=error), asset.header.get("up", "y")
    else:
        mesh = triangles_of(source)
    if output is not None:
        write_mesh(mesh, Path(output), up)
    return mesh


def _whole(path: Path, error: float | None, triangles: int | None) -> tuple[TriMesh, str]:
    """A control mesh and its axis; it is as coarse as it gets."""
    cage = read_cage(path)
    if error or (triangles is not None and triangles < len(cage.mesh.faces)):
        raise FovealError(
            f"{path}: a control mesh has no coarser levels. Export it whole, or finer by 'foveal refine'."
        )
    return cage.mesh, cage.up


def _is_fov(source: Checked) -> bool:
    return isinstance(source, Path) and source.suffix.lower() == ".fov"


def _refuse_limits(name: str, error: float | None, triangles: int | None) -> None:
    if error is not None and triangles is not None:
        raise ValueError("give error or triangles, not both")
    if error is not None and not 0 <= error < float("inf"):
        raise FovealError(f"{name}: the error must be a length, 0 or more, got {error}.")
    if triangles is not None and triangles < 1:
        raise FovealError(f"{name}: at least one triangle must be wanted, got {triangles}.")


def _refuse_source(path: Path) -> None:
    if path.suffix.lower() == ".json":
        raise FovealError(f"{path}: a scene.json is not exported whole; export its files one by one.")
    refuse_missing(path)


def refuse_mesh_output(output: Path, source: Checked, /) -> None:
    """Say before any work that a mesh cannot be written so."""
    if output.suffix.lower() not in _SUFFIXES:
        raise FovealError(f"{output}: the name must end in {' or '.join(_SUFFIXES)}, which says the format.")
    if isinstance(source, Path):
        refuse_same(output, source)
    refuse_unwritable(output)


def write_mesh(mesh: TriMesh, output: Path, up: str, /) -> None:
    """In the format that the suffix says."""
    from foveal.mesh.io import write_glb, write_ply

    if output.suffix.lower() == ".ply":
        write_ply(mesh, output, comment="made by foveal")
    else:
        with np.errstate(over="ignore"):
            extent = float(np.ptp(mesh.positions, axis=0).max())
        if extent > float(np.finfo(np.float32).max):
            raise FovealError(f"{output}: GLB cannot hold a model {extent:.3g} large. Export it as .ply.")
        write_glb(mesh, output, up=up)


def error_for_triangles(graph: Graph, triangles: int, /, *, name: str = "mesh") -> float:
    """The smallest error whose cut has at most `triangles` triangles.

    Raises
    ------
    FovealError
        If even the coarsest cut has more.
    """
    from foveal.lod.select import cut_by_error

    # The cut changes only at the errors of nodes, and gets coarser as the error rises.
    errors = np.unique(np.append(graph.errors[np.isfinite(graph.errors)], 0.0))
    coarsest = cut_by_error(graph, error=float(errors[-1])).triangles
    if coarsest > triangles:
        raise FovealError(
            f"{name}: its coarsest level has {coarsest:,} triangles, more than {triangles:,}. Allow more."
        )
    low, high = 0, len(errors) - 1
    while low < high:
        middle = (low + high) // 2
        if cut_by_error(graph, error=float(errors[middle])).triangles <= triangles:
            high = middle
        else:
            low = middle + 1
    return float(errors[low])
