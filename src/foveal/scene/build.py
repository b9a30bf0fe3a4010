"""A mesh, in a file or in memory, into a `.fov`."""

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack, cast, overload

from numpy.typing import ArrayLike

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing, refuse_same, refuse_unwritable
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh

from .cage_file import CageReport, is_cage, read_cage, write_cage
from .cage_options import polygons_with
from .cage_polygons import PolygonCounts, told
from .control_mesh import ControlMesh
from .depth_rules import CATMULL_CLARK
from .refinement import Refinement, RefineOptions, chosen
from .source import Checked, Source, checked, name_of, triangles_of

if TYPE_CHECKING:
    from foveal.multires import BuildReport

__all__ = ["BuildOptions", "build", "title_of", "up_of"]


class BuildOptions(RefineOptions, total=False):
    """What `build` takes, which explains each, and every verb that may have to build. None is the default."""

    bits: int | None
    step: float | None
    normals: str | None
    up: str | None
    memory_bytes: int | None
    executor: Executor | None
    workers: int | None


@overload
def build(
    source: Source, output: PathLike, /, *, progress: Progress = ..., **options: Unpack[BuildOptions]
) -> "BuildReport | CageReport": ...


@overload
def build(
    positions: ArrayLike,
    faces: ArrayLike,
    output: PathLike,
    /,
    *,
    progress: Progress = ...,
    **options: Unpack[BuildOptions],
) -> "BuildReport | CageReport": ...


def build(
    source: Any, /, *rest: Any, progress: Progress = SILENT, **options: Unpack[BuildOptions]
) -> "BuildReport | CageReport":
    """Build a `.fov`: `build(path, output)`, `build(mesh, output)` or `build(positions, faces, output)`.

    Parameters
    ----------
    source : path, TriMesh, PolyMesh, or (n, 3) float
        A mesh file, a `.fov` to build anew, a mesh, or positions; the latter are followed by `faces`,
        (m, 3) int with indices in [0, n).
    output : path
        Ends in `.fov`; replaced if it is there, and only when the new one is whole.
    progress : Progress
        Told of each stage.
    bits : int, optional
        Bits a coordinate over the largest extent; by default from the errors of simplification.
    step : float, optional
        Grid step in the unit of the mesh, instead of `bits`.
    normals : "auto" or "none", optional
        "auto", the default, keeps the mesh's, or makes them where it has none.
    up : "x", "y" or "z", optional
        The axis that points up, where it is not the format's own.
    memory_bytes : int, optional
        Memory to keep within; the rest waits on disk. By default half of what is free.
    executor : Executor, optional
        By default local threads; anything like `concurrent.futures.Executor` serves, such as Dask's.
    workers : int, optional
        Number of local threads; by default one a processor.
    scheme : "sqrt3", "loop", "butterfly" or "catmull-clark", optional
        Keep the mesh as a control mesh, to be refined by this scheme where it is looked at; for
        catmull-clark its polygons, creases and corners.
    criteria, depths, positions, budget, rate, sharp_edges, pair_triangles, prim, placements
        With `scheme`: how it is meant to be refined; see `RefineOptions`.

    Returns
    -------
    BuildReport, or of a control mesh CageReport
        What was read, repaired and written.

    Raises
    ------
    FovealError
        If the input cannot be used or the output not be written, in one sentence.

    Examples
    --------
    >>> import pathlib, tempfile, foveal
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "tetrahedron.fov"
    >>> positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> report = foveal.build(positions, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], path)
    >>> foveal.info(path)["triangles"]
    4
    """
    from foveal import multires
    from foveal.base.jit import is_cold
    from foveal.mesh.io import open_source, source_from_mesh

    mesh, output = _arguments(source, rest)
    if output.suffix.lower() != ".fov":
        raise FovealError(f"{output}: the name must end in .fov.")
    if isinstance(mesh, Path):
        _refuse_source(mesh, output)
    refuse_unwritable(output)
    refinement = chosen(options)
    given = {k: v for k, v in options.items() if v is not None and k not in RefineOptions.__annotations__}
    if refinement is not None:
        return _build_cage(mesh, output, refinement, options, progress)
    up: Any = given.pop("up", None)
    if is_cold():  # asked before the file is opened: to survey an OBJ compiles its reader
        progress.note("First run: the kernels are compiled, which takes about half a minute, once.")
    if not isinstance(mesh, Path):
        blocks = source_from_mesh(triangles_of(mesh), up=up or "y")
    elif is_cage(mesh):
        cage = read_cage(mesh)
        blocks = source_from_mesh(cage.mesh, name=str(mesh), up=up or cage.up)
    elif mesh.suffix.lower() == ".fov":
        blocks = multires.source_of(mesh, up=up)
    else:
        blocks = open_source(mesh, up=up)
    return multires.build(blocks, output, progress=progress, **cast(Any, given))


def _build_cage(
    mesh: Checked, output: Path, refinement: Refinement, options: BuildOptions, progress: Progress
) -> CageReport:
    """Keep a mesh as a control mesh; of one of the same scheme, what was not chosen stays as it is."""
    from foveal.base.jit import is_cold
    from foveal.mesh.topology import weld

    from .facing import tell_inside_out

    name = name_of(mesh)
    _refuse_shape(name, options)
    if is_cold():
        progress.note("First run: the kernels are compiled, which takes about a minute, once.")
    if isinstance(mesh, Path) and is_cage(mesh):
        cage = read_cage(mesh)
        # What another scheme was told says little: its iterations are of other triangles.
        is_same = cage.refinement.scheme == refinement.scheme
        cage = replace(cage, refinement=cage.refinement.chosen(options) if is_same else refinement)
        if refinement.scheme == CATMULL_CLARK:
            cage = cage.with_options(options, name)
    elif refinement.scheme == CATMULL_CLARK:
        polygons = polygons_with(mesh, options, progress=progress)
        cage = ControlMesh.of_polygons(polygons, refinement, "y").with_placements(options, name)
    else:
        if isinstance(mesh, PolyMesh):
            _tell_polygons(mesh, refinement.scheme, progress)
        cage = ControlMesh(triangles_of(mesh), refinement, "y")
    if cage.polygons is not None and refinement.scheme != CATMULL_CLARK:
        _tell_polygons(cage.polygons, refinement.scheme, progress)
    sharp, angle = cage.sharp, options.get("sharp_edges")
    if sharp is not None and refinement.scheme != "sqrt3":
        progress.note(f"Sharp edges that are left out, since {refinement.scheme} knows none: {len(sharp):,}.")
        sharp = None
    report = write_cage(
        cage.surface() if refinement.scheme == CATMULL_CLARK else cage.mesh,
        output,
        refinement=cage.refinement,
        up=options.get("up") or cage.up,
        sharp_edges=sharp if angle is None else angle,
        placements=cage.placements if refinement.scheme == CATMULL_CLARK else None,
        name=name,
    )
    if report.welded:
        progress.note(f"Vertices at the same place as another, made one with it: {report.welded:,}.")
    tell_inside_out(weld(cage.mesh)[0], name, progress)
    return report


def _tell_polygons(mesh: PolyMesh, scheme: str, progress: Progress) -> None:
    counts = told(PolygonCounts.of(mesh))
    progress.note(f"Kept as plain triangles, since {scheme} knows nothing else: {counts}.")


def _refuse_shape(name: str, options: BuildOptions) -> None:
    given = {option for option, value in options.items() if value is not None}
    shaping = [option for option in ("bits", "step", "normals") if option in given]
    if shaping:
        raise FovealError(
            f"{name}: a control mesh is kept as it is, so {' and '.join(shaping)} would change nothing. "
            "Leave that out."
        )


def _arguments(source: Any, rest: tuple[Any, ...]) -> tuple[Checked, Path]:
    """The mesh and the output of a call in any of the three forms."""
    is_whole = isinstance(source, (str, os.PathLike, TriMesh, PolyMesh))
    if len(rest) != (1 if is_whole else 2):
        raise TypeError("call build(path, output), build(mesh, output) or build(positions, faces, output)")
    return (checked(source) if is_whole else TriMesh.of(source, rest[0])), Path(rest[-1])


def up_of(options: BuildOptions, /) -> str:
    """The axis that points up: what was chosen, or y."""
    up = options.get("up") or "y"
    if up not in ("x", "y", "z"):
        raise ValueError(f'up must be "x", "y" or "z", got {up!r}')
    return up


def _refuse_source(path: Path, output: Path) -> None:
    refuse_missing(path)
    if path.suffix.lower() == ".json":
        raise FovealError(f"{path}: a scene.json is not built; build its meshes one by one.")
    refuse_same(output, path)


def title_of(path: PathLike, /) -> str:
    """A file's name without its format.

    Examples
    --------
    >>> title_of("scans/statue.v2.ply.gz")
    'statue.v2'
    """
    name = Path(path).name
    return Path(name[:-3] if name.lower().endswith(".gz") else name).stem
