"""What live sessions need, before any page asks."""

from collections.abc import Callable
from functools import partial

from foveal.base.progress import SILENT, Progress
from foveal.scene import Scene
from foveal.scene.apart import apart

__all__ = ["warm"]


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
    from foveal.refine import session
    from foveal.scene.cage_file import read_cage

    schemes = {refinement.scheme for refinement in layers.values()}
    with progress.stage("Preparing refinement", len(layers) + len(schemes)) as stage:
        for path, refinement in layers.items():
            cage = read_cage(path)
            begin = partial(session.Session, scheme=refinement.scheme, sharp=cage.sharp, name=str(path))
            _apart(partial(begin, cage.mesh))
            stage.advance()
        for scheme in schemes:
            _apart(partial(session.warm, scheme))
            stage.advance()


def _apart(work: Callable[[], object]) -> None:
    """Out of the way of Ctrl-C."""
    apart(lambda _: work())
