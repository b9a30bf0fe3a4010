"""A control mesh refined for one view: in slices, within its budget, and before memory is gone."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress, Stage
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .apart import apart
from .cage_file import ControlMesh
from .refine_size import expected, most_triangles

if TYPE_CHECKING:
    from foveal.refine import Update

__all__ = ["refined"]

_SPLITS = 50_000  # between two looks at the count, about 50 ms; and 10 MB past what is allowed


def refined(
    cage: ControlMesh,
    camera: Camera,
    /,
    *,
    has_hidden: bool = True,
    name: str = "mesh",
    progress: Progress = SILENT,
) -> TriMesh:
    """A control mesh refined for one view, with or without front faces that are hidden.

    Raises
    ------
    FovealError
        If there would be more triangles than memory or anybody's patience holds.
    """
    total = expected(cage, camera)
    if cage.refinement.budget:
        total = min(total, max(cage.refinement.budget, len(cage.mesh.faces)))
    with progress.stage("Refining", total) as stage:
        return apart(lambda heed: _Work(cage, camera, name, stage, heed).mesh(has_hidden=has_hidden))


class _Work:
    """One refinement under way: `heed` is called between slices, and may end it."""

    def __init__(
        self, cage: ControlMesh, camera: Camera, name: str, stage: Stage, heed: Callable[[], None]
    ) -> None:
        from foveal.refine.scheme import refiner

        self._cage, self._camera, self._name = cage, camera, name
        self._stage, self._heed = stage, heed
        self._live = refiner(cage.mesh, scheme=cage.refinement.scheme, sharp=cage.sharp, name=name)
        self._most = max(most_triangles(cage.refinement.scheme), len(cage.mesh.faces))
        self._told = 0

    def mesh(self, *, has_hidden: bool) -> TriMesh:
        """The mesh, for the view and its budget."""
        from foveal.refine import Sqrt3
        from foveal.refine.hidden import Hidden

        live, camera, refinement = self._live, self._camera, self._cage.refinement
        if not has_hidden and not isinstance(live, Sqrt3):
            raise FovealError(f"{self._name}: what is hidden can be left out by sqrt3 only. Choose that.")
        self._bring(live.update)
        if not has_hidden and isinstance(live, Sqrt3):
            self._bring(partial(live.update, hidden=Hidden.behind(live.mesh(), camera)))
        return live.mesh(positions=refinement.positions)

    def _bring(self, update: Callable[..., "Update"]) -> None:
        """Bring the refinement to the least threshold that keeps within the budget."""
        from foveal.refine.pace import update_within

        refinement = self._cage.refinement
        budget = max(refinement.budget, len(self._cage.mesh.faces)) if refinement.budget else self._most
        update_within(
            lambda criteria: self._slices(partial(update, self._camera, criteria=criteria), budget),
            refinement.criteria,
            least=len(self._cage.mesh.faces),
            budget=refinement.budget,
        )

    def _slices(self, update: Callable[..., Any], budget: int) -> int:
        """Refine until all is done, or there is more than is allowed; returns how much there is."""
        while True:
            self._heed()
            done = update(most_splits=_SPLITS)
            if done.faces > self._told:
                self._stage.advance(done.faces - self._told)
                self._told = done.faces
            if done.is_done or min(budget, self._most) < done.faces:
                break
        if done.faces > self._most and budget >= self._most:
            raise FovealError(
                f"{self._name}: this would be more than {self._most:,} triangles. Give a --budget, fewer "
                "--iterations, or a larger --edge-px."
            )
        return int(done.faces)
