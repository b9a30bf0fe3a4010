"""A mesh file of a chosen fineness from a `.fov` or from another mesh file."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.lod.graph import Graph
from foveal.mesh.trimesh import TriMesh

from .prepare import BuildOptions, prepare

__all__ = ["error_for_triangles", "export"]

_SUFFIXES = (".ply", ".glb")


def export(
    source: str | os.PathLike[str],
    output: str | os.PathLike[str] | None = None,
    /,
    *,
    error: float | None = None,
    triangles: int | None = None,
    progress: Progress = SILENT,
    **options: Any,
) -> TriMesh:
    """A mesh that is as coarse as an error or a number of triangles allows, and a PLY or GLB of it.

    Parameters
    ----------
    source
        A `.fov`, or a mesh file, which is built first if it has to become coarser.
    output
        Where to write, if anywhere; the suffix says the format.
    error : float, optional
        Largest distance to the original, in the unit of the file. By default, as of the original.
    triangles : int, optional
        As fine as this many triangles allow; not together with `error`.
    progress, **options
        As for `prepare`.

    Returns
    -------
    TriMesh
        With vertices of its own, those of the source or fewer.

    Raises
    ------
    FovealError
        If the format is not known, or even the coarsest level has more triangles than wanted.
    """
    from foveal import multires
    from foveal.lod.select import cut_by_error
    from foveal.mesh.io import read_mesh

    source, output = Path(source), None if output is None else Path(output)
    if output is not None and output.suffix.lower() not in _SUFFIXES:
        raise FovealError(f"{output}: the name must end in {' or '.join(_SUFFIXES)}, which says the format.")
    if source.suffix.lower() == ".json":
        raise FovealError(f"{source}: a scene.json is not exported whole; export its files one by one.")
    if error is not None and triangles is not None:
        raise ValueError("give error or triangles, not both")
    if error is not None and not 0 <= error < float("inf"):
        raise FovealError(f"{source}: the error must be a length, 0 or more, got {error}.")
    if triangles is not None and triangles < 1:
        raise FovealError(f"{source}: at least one triangle must be wanted, got {triangles}.")
    chosen = options.get("options", BuildOptions())
    if source.suffix.lower() != ".fov" and error is None and triangles is None:
        mesh, up = read_mesh(source, up=chosen.up), chosen.up or "y"
    else:
        with multires.open(prepare(source, progress=progress, **options)) as asset:
            if triangles is not None:
                error = error_for_triangles(asset.graph, triangles, name=str(source))
            mesh = asset.mesh_of(cut_by_error(asset.graph, error=error).expanded)
            up = asset.header.get("up", "y")
    if output is not None:
        _write(mesh, output, up)
    return mesh


def _write(mesh: TriMesh, output: Path, up: str) -> None:
    """In the format that the suffix says."""
    from foveal.mesh.io import write_glb, write_ply

    if output.suffix.lower() == ".ply":
        write_ply(mesh, output, comment="made by foveal")
    else:
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
