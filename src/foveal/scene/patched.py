"""A control mesh of polygons tessellated for one view, or everywhere."""

from dataclasses import replace

import numpy as np

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .apart import apart
from .control_mesh import ControlMesh
from .depth_rules import CATMULL_CLARK, depths_with
from .refine_size import most_triangles
from .refinement import Refinement

__all__ = ["patched", "uniformly"]


def patched(
    cage: ControlMesh, camera: Camera, /, *, name: str = "mesh", progress: Progress = SILENT
) -> TriMesh:
    """A control mesh as Catmull-Clark patches, with limit normals: sharp at creases.

    It has no more triangles than its budget or the memory that is free allows, but for the least there is;
    that memory was the limit is told.

    Raises
    ------
    FovealError
        If it is no surface.
    """
    refinement = cage.refinement
    most = most_triangles(CATMULL_CLARK)

    own = refinement.budget
    budget = min(own or most, most)

    def work() -> tuple[TriMesh, bool]:
        from foveal.refine.slates import Slates

        surface = Slates(cage.surface(), placements=cage.placements, workers=None, name=name)
        done = surface.update(camera, depths=depths_with(refinement.depths, {}), budget=budget)
        return surface.mesh(), done.is_capped

    with progress.stage("Tessellating", None):
        mesh, is_capped = apart(lambda _: work())
    if is_capped and budget != own:
        progress.note(
            f"{name}: it is coarser than the rules have it, within the {budget:,} triangles that would do "
            "here. Give a --budget of your own, or fewer --iterations."
        )
    return mesh


def uniformly(cage: ControlMesh, name: str, /) -> Refinement:
    """The refinement that has all patches at its maximum depth.

    Raises
    ------
    FovealError
        If that is too much, which is known before.
    """
    from foveal.refine.slates_depth import Depths

    depth = depths_with(cage.refinement.depths, {}).most
    surface = cage.surface()
    has_quads_only = bool((np.diff(surface.starts) == 4).all())
    patches = surface.faces if has_quads_only else len(surface.corners)
    count = patches * 2 * 4**depth * (1 if cage.placements is None else len(cage.placements))
    most = most_triangles(CATMULL_CLARK)
    if count > most and not cage.refinement.budget:
        raise FovealError(
            f"{name}: depth {depth} everywhere is {count:,} triangles, more than the {most:,} that would do "
            "here. Give a --budget, fewer --iterations, or a camera in place of --everywhere."
        )
    rules = Depths(depth, cone=None, backs=False, silhouettes=False, size_px=None)
    return replace(cage.refinement, depths=rules)
