"""What live sessions need, before any page asks."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, cast

from foveal.base.progress import SILENT, Progress
from foveal.scene import Scene
from foveal.scene.apart import apart
from foveal.scene.depth_rules import CATMULL_CLARK

if TYPE_CHECKING:
    from foveal.refine.dialogue import Dialogue
    from foveal.scene.control_mesh import ControlMesh

__all__ = ["begun", "warm"]


def warm(scene: Scene, /, *, progress: Progress = SILENT) -> None:
    """Have the kernels of live sessions ready, which takes 40 s the first time, and broken meshes refused.

    Raises
    ------
    FovealError
        If a control mesh of the scene is no oriented surface.
    """
    layers = {layer.path: layer.refinement for layer in scene.layers if layer.refinement is not None}
    if not layers:
        return
    from foveal.scene.cage_file import read_cage

    schemes = {refinement.scheme for refinement in layers.values()}
    with progress.stage("Preparing refinement", len(layers) + len(schemes)) as stage:
        for path, refinement in layers.items():
            _apart(partial(begun, read_cage(path), refinement.scheme, str(path)))
            stage.advance()
        for scheme in schemes:
            _apart(partial(_warm, scheme))
            stage.advance()


def _warm(scheme: str) -> None:
    if scheme == CATMULL_CLARK:
        from foveal.refine.patch_session import warm_patches

        warm_patches()
        return
    from foveal.refine import session

    session.warm(cast(Any, scheme))


def begun(cage: "ControlMesh", scheme: str, name: str, /) -> "Dialogue":
    """A live session of a control mesh.

    Raises
    ------
    FovealError
        If it is no oriented surface, or has what the scheme does not know.
    """
    cage.refuse_misfit(scheme, name)
    if scheme == CATMULL_CLARK:
        from foveal.refine.patch_session import PatchSession

        return PatchSession(cage.in_place(), name=name)
    from foveal.refine.session import Session

    return Session(cage.mesh, scheme=cast(Any, scheme), sharp=cage.sharp, name=name)


def _apart(work: Callable[[], object]) -> None:
    """Out of the way of Ctrl-C."""
    apart(lambda _: work())
