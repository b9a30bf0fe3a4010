"""RGB triangulations for a view: conforming at every step, a function of mesh, camera and criteria alone.

Based on: E. Puppo. Selectively refinable subdivision meshes. Eurographics Symposium on Geometry Processing
2006. Where ours is another way:

* The mesh is a set of split edges of the infinite Loop hierarchy, closed under what splits require; the diagonal
  of a triangle with two split edges ends at the lower address. As published it depends on the order of
  splits.
* Points are closed forms of where a vertex was born and of its limit, and what a stencil takes is computed by
  address, not split into the mesh for a time.
* As the set is unique, Qr and Qc need no priorities: a queue holds the faces whose edges are to be
  asked, and vertices that are not needed are taken out finest first. A budget chooses the threshold.
"""

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels_rgb_base as base_kernels
from . import _kernels_rgb_show as show_kernels
from . import _kernels_rgb_update as kernels
from ._kernels_rgb_address import LEVELS
from ._kernels_rgb_layout import (
    BUTTERFLY,
    CLOCK,
    FACES,
    FACES_IN_USE,
    FREE_CODE,
    FREE_FACE,
    FREE_VERTEX,
    IN_USE,
    LOOP,
    MERGES,
    PRESENT,
    PRESENT_COUNT,
    SCHEME,
    SPLITS,
    VERTICES,
)
from .cage import Cage
from .criteria import Criteria, view_of
from .rgb_net import MAX_BASE, RgbNet
from .sqrt3 import Update

__all__ = ["Rgb", "rgb"]

_SCHEMES = {"loop": LOOP, "butterfly": BUTTERFLY}

#: Room to begin with, beyond the control mesh: pages that are never touched cost nothing.
_FACES, _VERTICES = 1 << 16, 1 << 16


class Rgb:
    """An RGB triangulation that follows a camera.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface, open or closed.
    """

    def __init__(self, mesh: TriMesh, /, *, scheme: str = "loop", cached: int = 1 << 17, name: str = "mesh") -> None:
        cage = Cage.of(mesh, name=name)
        if scheme not in _SCHEMES:
            raise ValueError(f"scheme must be one of {', '.join(_SCHEMES)}, got {scheme!r}")
        self._cached = cached
        count, faces = len(cage.positions), len(cage.faces)
        net = RgbNet.empty(2 * faces + _FACES, 2 * count + _VERTICES, cage)
        net.counts[[FACES, FACES_IN_USE]] = faces
        net.counts[[VERTICES, IN_USE, PRESENT_COUNT]] = count
        net.counts[[FREE_FACE, FREE_VERTEX]] = -1
        net.counts[SCHEME] = _SCHEMES[scheme]
        net.faces["corners"][:faces], net.faces["beside"][:faces] = cage.faces, cage.beside
        net.faces["base"][:faces] = np.arange(faces)
        net.vertices["around"][cage.faces] = np.arange(faces, dtype=np.int32)[:, None]
        base_kernels.base_vertices(net, cage.positions, cage.starts, cage.ring, cage.is_border)
        base_kernels.base_normals(net)
        self._net = net
        low, high = cage.positions.min(axis=0), cage.positions.max(axis=0)
        # All levels lie in the control mesh's convex hull, so in its box.
        self._corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), axis=-1).reshape(-1, 3)
        self._drift = 1.0
        self._view, self._limits = np.zeros(24), np.zeros((3, 3))

    def update(self, camera: Camera, /, *, criteria: Criteria | None = None) -> Update:
        """Bring the mesh to what `camera` sees, from where it is."""
        view, limits = view_of(camera), (criteria or Criteria()).limits()
        self._move(view, limits)
        net, drift = self._net, self._drift
        net.counts[CLOCK] += 1
        splits, merges = net.counts[[SPLITS, MERGES]].tolist()
        order, begin = self._order(), 0
        while (begin := int(kernels.review(net, order, begin, view, limits, drift))) < len(order):
            net = self._grow()
        kernels.mark_needed(net, order)
        kernels.coarsen(net, order)
        kernels.enqueue_expired(net, drift)
        while not kernels.refine(net, view, limits, drift):
            net = self._grow()
        self._forget()
        counts = net.counts
        return Update(
            int(counts[FACES_IN_USE]),
            int(counts[PRESENT_COUNT]),
            int(counts[SPLITS]) - splits,
            int(counts[MERGES]) - merges,
        )

    def _order(self) -> NDArray[np.int32]:
        order = np.empty(int(self._net.counts[PRESENT_COUNT]), np.int32)
        return order[: kernels.sort_by_birth(self._net, np.empty(LEVELS + 3, np.int64), order)]

    def _grow(self) -> RgbNet:
        self._net = net = self._net.grown(2 * len(self._net.faces), 2 * len(self._net.vertices))
        base_kernels.fill_table(net)
        return net

    def _move(self, view: NDArray[np.float64], limits: NDArray[np.float64]) -> None:
        """Add to the drift what the view moved by; for other criteria or pixels no answer holds."""
        if not np.array_equal(limits, self._limits) or view[3] != self._view[3]:
            self._net.faces["until"] = 0.0
            self._net.vertices["until"] = 0.0
        else:
            planes = (view[4:] - self._view[4:]).reshape(5, 4)
            moved = float(np.abs(self._corners @ planes[:, :3].T + planes[:, 3]).max())
            self._drift += 1.001 * max(float(np.linalg.norm(view[:3] - self._view[:3])), moved)
        self._view, self._limits = view, limits

    def _forget(self) -> None:
        """Keep of the vertices that are not in the mesh so many as were used last."""
        net = self._net
        if int(net.counts[IN_USE] - net.counts[PRESENT_COUNT]) <= self._cached:
            return
        count = int(net.counts[VERTICES])
        outside = np.nonzero((net.births[:count] >= 0) & (net.flags[:count] & PRESENT == 0))[0]
        excess = len(outside) - self._cached
        stamps = net.vertices["stamp"][outside]
        show_kernels.forget(net, outside[np.argpartition(stamps, excess)[:excess]])

    def _positions(self) -> NDArray[np.float64]:
        count = int(self._net.counts[VERTICES])
        levels, out = np.empty(count, np.int8), np.zeros((count, 3))
        show_kernels.shown_levels(self._net, levels)
        begin = 0
        while (begin := int(show_kernels.place_all(self._net, levels, begin, out))) < count:
            self._grow()
        return out

    def mesh(self) -> TriMesh:
        """The mesh as it is."""
        positions, net = self._positions(), self._net
        faces = net.faces[: net.counts[FACES]]
        corners = faces["corners"][faces["code"] != FREE_CODE]
        is_used = net.flags[: len(positions)] & PRESENT != 0
        index = np.cumsum(is_used, dtype=np.int32) - 1
        return TriMesh(positions[is_used], index[corners].astype(np.int32))


def rgb(mesh: TriMesh, camera: Camera, /, *, scheme: str = "loop", criteria: Criteria | None = None) -> TriMesh:
    """A mesh refined for one view."""
    refined = Rgb(mesh, scheme=scheme)
    refined.update(camera, criteria=criteria)
    return refined.mesh()
