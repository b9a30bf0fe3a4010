"""A control mesh refined for one view: in slices, within its budget, and before memory is gone."""

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, cast

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress, Stage
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .apart import apart
from .control_mesh import ControlMesh
from .depth_rules import CATMULL_CLARK
from .patched import patched
from .refine_size import expected, most_triangles

if TYPE_CHECKING:
    from foveal.refine import Update

__all__ = ["filtered", "refined"]

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
    if cage.refinement.scheme == CATMULL_CLARK:
        if not has_hidden:
            raise FovealError(_only_sqrt3(name))
        return patched(cage, camera, name=name, progress=progress)
    with progress.stage("Refining", _total(cage, camera)) as stage:
        return apart(lambda heed: _Work(cage, camera, name, stage, heed).mesh(has_hidden=has_hidden))


def filtered(
    cage: ControlMesh, camera: Camera, /, *, name: str = "mesh", progress: Progress = SILENT
) -> TriMesh:
    """The same by the √3 paper's own way: a budget ends it where it would be passed, silhouettes go first.

    Raises
    ------
    FovealError
        If the control mesh is not refined by √3, has sharp edges, or there would be too many triangles.
    """
    if cage.refinement.scheme != "sqrt3":
        raise FovealError(f"{name}: the mode filter is one of sqrt3. Choose that, or the mode exact.")
    if cage.sharp is not None and len(cage.sharp):
        raise FovealError(
            f"{name}: it has sharp edges, which the mode filter does not know. Choose the mode exact."
        )
    with progress.stage("Refining", _total(cage, camera)) as stage:
        return apart(lambda heed: _filtered(cage, camera, name, stage, heed))


def _filtered(
    cage: ControlMesh, camera: Camera, name: str, stage: Stage, heed: Callable[[], None]
) -> TriMesh:
    from foveal.refine import Sqrt3Filter

    refinement, told = cage.refinement, len(cage.mesh.faces)
    live, most = Sqrt3Filter(cage.mesh, name=name), most_triangles("filter")
    budget = min(refinement.budget or most, most)
    while True:
        heed()
        done = live.update(camera, criteria=refinement.criteria, most_splits=1, budget=budget)
        stage.advance(done.faces - told)
        told = done.faces
        if done.is_done:
            break
        if done.split == 0:  # what is left would pass the budget
            if budget != refinement.budget:
                raise _too_many(name, most)
            break
    return live.mesh(positions=refinement.positions)


def _total(cage: ControlMesh, camera: Camera) -> float:
    """What there will be, about."""
    total, budget = expected(cage, camera), cage.refinement.budget
    return min(total, max(budget, len(cage.mesh.faces))) if budget else total


def _too_many(name: str, most: int) -> FovealError:
    return FovealError(
        f"{name}: this would be more than {most:,} triangles. Give a --budget, fewer --iterations, "
        "or a larger --edge-px."
    )


def _only_sqrt3(name: str) -> str:
    return f"{name}: what is hidden can be left out by sqrt3 only. Choose that."


class _Work:
    """One refinement under way: `heed` is called between slices, and may end it."""

    def __init__(
        self, cage: ControlMesh, camera: Camera, name: str, stage: Stage, heed: Callable[[], None]
    ) -> None:
        from foveal.refine.scheme import refiner

        self._cage, self._camera, self._name = cage, camera, name
        self._stage, self._heed = stage, heed
        self._live = refiner(cage.mesh, scheme=cast(Any, cage.refinement.scheme), sharp=cage.sharp, name=name)
        self._most = max(most_triangles(cage.refinement.scheme), len(cage.mesh.faces))
        self._told = 0

    def mesh(self, *, has_hidden: bool) -> TriMesh:
        """The mesh, for the view and its budget."""
        from foveal.refine import Sqrt3
        from foveal.refine.hidden import Hidden

        live, camera, refinement = self._live, self._camera, self._cage.refinement
        if not has_hidden and not isinstance(live, Sqrt3):
            raise FovealError(_only_sqrt3(self._name))
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
            raise _too_many(self._name, self._most)
        return int(done.faces)
