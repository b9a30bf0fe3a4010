"""√3 refinement for a view: the mesh is a function of control mesh, camera and criteria alone.

Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes using
√3-subdivision (the criteria, the structure without edges or hierarchy); L. Kobbelt. √3-subdivision. SIGGRAPH
2000 (the surface, adaptive refinement by forced mates, the rule of borders); H. Hoppe et al. Piecewise smooth
surface reconstruction. SIGGRAPH 1994, section 3 (creases and corners).
"""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels_sqrt3_base as base_kernels
from . import _kernels_sqrt3_show as show
from . import _kernels_sqrt3_update as kernels
from ._kernels_sqrt3_layout import DOUBTFUL, FACES, FREE_FACES, FREE_VERTICES, QUEUED, VERTICES
from .cage import Cage
from .criteria import MAX_LEVEL, Criteria, view_of
from .drift import Drift
from .hidden import Hidden
from .net import Net
from .slots import Placing, Slots

__all__ = ["Mode", "Sqrt3", "Update", "sqrt3"]

Mode = Literal["exact", "filter"]
"""Uniform subdivision's points wherever they are shown, or the paper's own way; see `Sqrt3`."""

#: Room to begin with, beyond the control mesh: pages that are never touched cost nothing.
_FACES, _VERTICES = 1 << 16, 1 << 15


@dataclass(frozen=True, slots=True)
class Update:
    """What an update did.

    Attributes
    ----------
    faces, vertices : int
        Of the mesh now; a vertex on a sharp edge counts once on each side.
    split, undone : int
        Faces that were split, and splits that were undone.
    is_done : bool
        False if there was more to split than was allowed.
    """

    faces: int
    vertices: int
    split: int
    undone: int
    is_done: bool = True


class Sqrt3:
    """A √3 refinement that follows a camera.

    A face is split if it meets the criteria, or if a finer face beside it needs it to be; a vertex stands
    where uniform √3 subdivision has it on the highest generation of its faces. Nothing reads the mesh of
    the moment, so the result is the same whatever was looked at before.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed.
    sharp : (k, 2) int, optional
        The vertices, in [0, n), of edges that stay sharp, as `sharp_edges` finds them; the surface is smooth
        between. Of a vertex's edges sharp or on the border, two are a crease, which becomes a cubic spline as
        a border does; at more it is a corner and stays. At one, where a crease ends, it stays as well: Hoppe
        et al. move it as if inside, but for that no closed form is known to us.
    name : str
        What errors call it.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface, or a sharp edge none of its edges; the sentence names the edge or
        vertex.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> from foveal.view.camera import Camera
    >>> refined = Sqrt3(icosphere(1))
    >>> done = refined.update(Camera.around([-1, -1, -1], [1, 1, 1]))
    >>> len(refined.mesh().faces) == done.faces > 80
    True
    """

    def __init__(self, mesh: TriMesh, /, *, sharp: ArrayLike | None = None, name: str = "mesh") -> None:
        cage = Cage.of(mesh, sharp=sharp, name=name)
        count, faces = len(cage.positions), len(cage.faces)
        net = Net.empty(2 * faces + _FACES, count + faces + _VERTICES, count)
        net.counts[[FACES, VERTICES, DOUBTFUL]] = faces, count, -1
        net.faces["corners"][:faces], net.faces["beside"][:faces] = cage.faces, cage.beside
        net.vertices["around"][cage.faces] = np.arange(faces, dtype=np.int32)[:, None]
        net.vertices["triple"][:count] = net.vertices["pair"][:count] = net.vertices["child"][:count] = -1
        net.vertices["twin"][:count] = cage.twins
        surface = cage.positions, cage.starts, cage.ring, cage.is_border, cage.is_corner
        base_kernels.base_points(*surface, net.vertices, net.normals, net.shrinks)
        self._net, self._origins = net, cage.origins
        low, high = cage.positions.min(axis=0), cage.positions.max(axis=0)
        # All levels lie in the control mesh's convex hull, so in its box.
        self._corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3)
        self._drift = Drift(float(np.linalg.norm(high - low)))

    def update(
        self,
        camera: Camera,
        /,
        *,
        criteria: Criteria | None = None,
        hidden: Hidden | None = None,
        most_splits: int | None = None,
    ) -> Update:
        """Bring the mesh to what `camera` sees, from where it is.

        Parameters
        ----------
        camera : Camera
            In the space of the mesh: of a placed model move the camera, inversely.
        criteria : Criteria, optional
        hidden : Hidden, optional
            Refine faces that it hides as those that face away. A depth buffer other than the last
            one has all asked anew, which takes half of what a fresh refinement does.
        most_splits : int, optional
            Stop after about so many, with a mesh that is whole but not yet as fine as wanted. Further updates
            go on, and end in the very mesh that one without this limit makes.
        """
        view, limits = view_of(camera), (criteria or Criteria()).limits()
        if hidden is not None:
            view = np.concatenate([view, hidden.words])
        # Of the same view the rest is done: what was forced for faces not split yet is not to be undone.
        undone = 0 if self._drift.is_still(view, limits) else self._coarsen(view, limits)
        before = self._vertices()
        most = before + most_splits if most_splits is not None else np.iinfo(np.int64).max
        chain = np.empty((2 * MAX_LEVEL + 2, 2), np.int64)
        while not kernels.refine(self._net, most, chain, view, limits, self._drift.now):
            self._net = self._net.grown(2 * len(self._net.faces), 2 * len(self._net.vertices))
        counts, vertices = self._net.counts, self._vertices()
        return Update(
            int(counts[FACES] - counts[FREE_FACES]),
            vertices,
            vertices - before,
            undone,
            bool(counts[QUEUED] == 0),
        )

    def _coarsen(self, view: NDArray[np.float64], limits: NDArray[np.float64]) -> int:
        """Undo what a view does not need, and let faces wait that have to be asked."""
        net = self._net
        if not self._drift.move(view, limits, self._corners):
            net.faces["until"] = net.vertices["until"] = 0
        drift = self._drift.now
        kernels.review(net, view, limits, drift)
        undone = int(kernels.coarsen(net, view, limits, drift))
        kernels.wake_expired(net, drift)
        return undone

    def _vertices(self) -> int:
        return int(self._net.counts[VERTICES] - self._net.counts[FREE_VERTICES])

    def mesh(self, *, positions: Placing = "control") -> TriMesh:
        """The mesh as it is: faces in no particular order, counter-clockwise as those of the control mesh.

        On sharp edges the sides have vertices in common, as in the control mesh.
        """
        slots = self.slots(positions=positions)
        is_face = self._net.faces["state"][: len(slots.faces)] >= 0
        count = len(slots.positions)
        own, twins = np.arange(count, dtype=np.int32), self._net.vertices["twin"][:count]
        first = np.where(twins >= 0, np.minimum(own, twins), own)  # of the two on a crease
        first[: len(self._origins)] = self._origins
        is_shown = (self._net.births[:count] >= 0) & (first == own)
        index = np.cumsum(is_shown, dtype=np.int32) - 1
        return TriMesh(slots.positions[is_shown], index[first[slots.faces[is_face]]])

    def slots(self, *, positions: Placing = "control") -> Slots:
        """The mesh as it is, slot by slot: what did not change since the last time is where it was.

        Each side of a sharp edge has vertices of its own, at places equal bit for bit, so that normals made
        of faces are sharp there.
        """
        faces, vertices = int(self._net.counts[FACES]), int(self._net.counts[VERTICES])
        slots = Slots.empty(faces, vertices)
        highest = np.empty(vertices, np.int8)
        show.show_faces(self._net, slots.faces, slots.levels, highest)
        show.show_vertices(self._net, positions == "limit", highest, slots.positions, slots.starts)
        return slots

    @property
    def bytes_used(self) -> int:
        """What the arrays take for the slots in use, all told."""
        faces, vertices = int(self._net.counts[FACES]), int(self._net.counts[VERTICES])
        return sum(
            a.nbytes // len(a) * (faces if len(a) == len(self._net.faces) else min(vertices, len(a)))
            for a in self._net
        )


def sqrt3(
    mesh: TriMesh,
    camera: Camera,
    /,
    *,
    criteria: Criteria | None = None,
    sharp: ArrayLike | None = None,
    mode: Mode = "exact",
) -> TriMesh:
    """A mesh refined for one view; see `Sqrt3`, which follows a camera.

    Parameters
    ----------
    mesh, camera, criteria, sharp
        As for `Sqrt3` and its `update`.
    mode : "exact" or "filter"
        "filter" is the paper's own way, `Sqrt3Filter`, to compare with.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> from foveal.refine import Region
    >>> from foveal.view.camera import Camera
    >>> everywhere = Criteria(Region(2), Region(2), Region(2))
    >>> len(sqrt3(tetrahedron(), Camera.of([0, 0, 9], [0, 0, 0]), criteria=everywhere).faces)
    36
    """
    if mode not in get_args(Mode):
        raise ValueError(f"mode must be exact or filter, got {mode!r}")
    if mode == "filter":
        from .filter import Sqrt3Filter

        if sharp is not None:
            raise ValueError("the paper's own mode knows no sharp edges")
        published = Sqrt3Filter(mesh)
        published.update(camera, criteria=criteria)
        return published.mesh()
    refined = Sqrt3(mesh, sharp=sharp)
    refined.update(camera, criteria=criteria)
    return refined.mesh()
