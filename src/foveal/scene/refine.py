"""A control mesh refined for a view, or everywhere, as a mesh."""

import dataclasses
import os
from pathlib import Path
from typing import Unpack

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing
from foveal.base.progress import SILENT, Progress
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .build import up_of
from .cage_file import is_cage, read_cage
from .cage_options import polygons_with
from .cage_polygons import PolygonCounts, told
from .control_mesh import ControlMesh
from .depth_rules import CATMULL_CLARK
from .export import refuse_mesh_output, write_mesh
from .facing import tell_inside_out
from .patched import uniformly
from .prepare import refuse_shaping
from .refine_size import everywhere as everywhere_count
from .refine_size import most_triangles
from .refined import filtered, refined
from .refinement import RefineOptions, chosen
from .render import home, read_camera
from .source import Checked, Source, checked, name_of, triangles_of

__all__ = ["refine"]


def refine(
    source: Source,
    output: PathLike | None = None,
    /,
    *,
    camera: Camera | PathLike | None = None,
    everywhere: bool = False,
    visible_only: bool = False,
    mode: str = "exact",
    up: str | None = None,
    progress: Progress = SILENT,
    **options: Unpack[RefineOptions],
) -> TriMesh:
    """Refine a control mesh where a camera sees it, and write a PLY or GLB of it.

    `foveal.refine.sqrt3` is the same for a mesh in memory; `foveal.refine.Sqrt3` follows a camera.

    Parameters
    ----------
    source : path, TriMesh or PolyMesh
        A mesh, vertices at one place made one, or a `.fov` that holds a control mesh.
    output : path, optional
        Where to write it too; the suffix, `.ply` or `.glb`, says the format.
    camera : Camera or path, optional
        By default all is framed, as the viewer does at first. A path is of a camera file.
    everywhere : bool
        Refine uniformly instead, as often as the criteria's front faces.
    visible_only : bool
        Refine front faces that are behind others as those that face away; for √3.
    mode : "exact" or "filter"
        "filter" is √3 as the paper has it, `foveal.refine.Sqrt3Filter`, to compare with: for a camera,
        without sharp edges. A budget ends it where it would be passed, and turns no threshold.
    up : "x", "y" or "z", optional
        Of a mesh, the axis that points up, where it is not the format's own.
    progress : Progress
        Told how far it is.
    **options
        See `RefineOptions`. By default what the file says, of a PolyMesh catmull-clark, and of any other
        mesh √3; with the default rules.

    Returns
    -------
    TriMesh
        Positions in the source's unit and axes, of no more triangles than the budget.

    Raises
    ------
    FovealError
        If the source is no oriented surface, a file cannot be read or written, or there would be more
        triangles than memory holds, or than 50 million.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> from foveal.refine import Criteria, Region
    >>> len(refine(icosphere(0), everywhere=True, criteria=Criteria(Region(2))).faces)
    180
    """
    if mode not in ("exact", "filter"):
        raise ValueError(f"mode must be exact or filter, got {mode!r}")
    source = checked(source)
    if output is not None:
        refuse_mesh_output(Path(output), source)
    name = name_of(source)
    if isinstance(camera, (str, os.PathLike)):
        camera = read_camera(camera)
    cage = _cage(source, name, up, options, progress)
    if cage.polygons is not None:
        places = "" if cage.placements is None else f", in {len(cage.placements):,} places"
        progress.note(f"{name}: {told(PolygonCounts.of(cage.polygons))}{places}.")
    tell_inside_out(cage.mesh, name, progress)
    if mode == "filter" and (everywhere or visible_only):
        what = "everywhere" if everywhere else "visible_only"
        raise FovealError(f"{name}: the mode filter knows no {what}. Choose the mode exact.")
    if everywhere:
        cage = _everywhere(cage, name)
    eye = camera or home([cage.mesh.positions], up=cage.up)
    if mode == "filter":
        mesh = filtered(cage, eye, name=name, progress=progress)
    else:
        mesh = refined(cage, eye, has_hidden=not visible_only, name=name, progress=progress)
    if output is not None:
        write_mesh(mesh, Path(output), cage.up)
    return mesh


def _cage(
    source: Checked, name: str, up: str | None, options: RefineOptions, progress: Progress
) -> ControlMesh:
    """What is to be refined, and how."""
    from foveal.mesh.topology import weld

    if isinstance(source, Path):
        refuse_missing(source)
        if source.suffix.lower() == ".json":
            raise FovealError(f"{source}: a scene.json is not refined whole; refine its files one by one.")
        if is_cage(source):
            refuse_shaping(source, {"up": up}, is_refined=True)
            cage = read_cage(source)
            own = cage.refinement.chosen(options)
            cage.refuse_misfit(own.scheme, name)
            cage = dataclasses.replace(cage, refinement=own, sharp=_sharp(cage.mesh, options, cage.sharp))
            return cage.with_options(options, name) if own.scheme == CATMULL_CLARK else cage
    usual = CATMULL_CLARK if isinstance(source, PolyMesh) else "sqrt3"
    refinement = chosen({**options, "scheme": options.get("scheme") or usual})
    assert refinement is not None
    if refinement.scheme == CATMULL_CLARK:
        polygons = polygons_with(source, options, progress=progress)
        cage = ControlMesh.of_polygons(polygons, refinement, up_of({"up": up}))
        return cage.with_placements(options, name)
    welded = weld(triangles_of(source))[0]
    return ControlMesh(welded, refinement, up_of({"up": up}), _sharp(welded, options, None))


def _sharp(mesh: TriMesh, options: RefineOptions, own: NDArray[np.int32] | None) -> NDArray[np.int32] | None:
    """The edges that stay sharp: by the angle that was chosen, or the file's own."""
    from foveal.refine import sharp_edges

    angle = options.get("sharp_edges")
    return own if angle is None else sharp_edges(mesh, angle)


def _everywhere(cage: ControlMesh, name: str) -> ControlMesh:
    """To be refined uniformly: all, for a camera that sees all.

    Raises
    ------
    FovealError
        If that is too much, which is known before.
    """
    from foveal.refine import Criteria, Region

    refinement = cage.refinement
    if refinement.scheme == CATMULL_CLARK:
        return dataclasses.replace(cage, refinement=uniformly(cage, name))
    iterations = refinement.criteria.front.iterations
    count = everywhere_count(len(cage.mesh.faces), refinement.scheme, iterations)
    most = most_triangles(refinement.scheme)
    if count > most and not refinement.budget:
        raise FovealError(
            f"{name}: {iterations} iterations everywhere are {count:,} triangles, more than the {most:,} "
            "that would do here. Give a --budget, fewer --iterations, or a camera in place of --everywhere."
        )
    region = Region(iterations)
    uniform = refinement.chosen({"criteria": Criteria(region, region, region)})
    return dataclasses.replace(cage, refinement=uniform)
