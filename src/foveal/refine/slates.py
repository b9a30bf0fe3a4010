"""Catmull-Clark surfaces tessellated on the fly: each patch as deep as a view needs it, without gaps.

Based on: V. Settgast, K. Müller, Chr. Fünfzig, D. Fellner. Adaptive tessellation of subdivision surfaces
(slates, depths, fans, frame rate); T. DeRose, M. Kass, T. Truong. Subdivision surfaces in character
animation. SIGGRAPH 1998 (creases).
"""

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from foveal.base.errors import FovealError
from foveal.base.tasks import thread_count
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .slates_blocks import Blocks
from .slates_cage import SlateCage
from .slates_depth import Depths, Views
from .slates_mesh import joined
from .slates_pairs import paired
from .slates_placements import Placements
from .slates_result import SlateArrays, Tessellated
from .slates_shown import Shown

__all__ = ["Slates", "slates"]

Floats = NDArray[np.float64]


class Slates:
    """A Catmull-Clark surface that follows a camera, in one place or in many.

    The control mesh is made of quadrangles by one step, where it has other faces; depths count from there.
    Limit points and normals are kept between views and computed anew only where a patch gets deeper than it
    ever was or the control mesh moved; what the triangles are depends on the view and the rules alone.

    Parameters
    ----------
    mesh : PolyMesh or TriMesh
        An oriented surface, open or closed, with creases and corners.
    placements : (k, 4, 4) float, optional
        Where the surface stands: matrices from its own space to that of the camera, invertible, the last row
        0 0 0 1. Each placement has its own depths and triangles; all share points and normals.
    pair_triangles : bool
        Join triangles in pairs first, as `paired` does. Half the patches, on another surface.
    dtype : float64 or float32
        Of positions and normals that come out; all is computed in float64.
    workers : int, optional
        Threads for points that many patches need at once, such as in a first view; None for as many as there
        are processors. What comes out is the same.
    name : str
        What errors call the mesh.

    Raises
    ------
    FovealError
        If the mesh is no oriented surface, or a placement no such matrix, in a sentence.

    Examples
    --------
    >>> from foveal.mesh.poly_shapes import cube
    >>> from foveal.view.camera import Camera
    >>> surface = Slates(cube())
    >>> done = surface.update(Camera.around([-1, -1, -1], [1, 1, 1]))
    >>> len(surface.mesh().faces) == done.triangles > 1000
    True
    >>> surface.update(Camera.around([-1, -1, -1], [1, 1, 1])).patches  # nothing is computed twice
    0
    """

    def __init__(
        self,
        mesh: PolyMesh | TriMesh,
        /,
        *,
        placements: ArrayLike | None = None,
        pair_triangles: bool = False,
        dtype: DTypeLike = np.float64,
        workers: int | None = 1,
        name: str = "mesh",
    ) -> None:
        polygons = PolyMesh.of_triangles(mesh) if isinstance(mesh, TriMesh) else mesh
        checked = polygons.checked(name)
        self._mesh, self._name = paired(checked) if pair_triangles else checked, name
        if np.dtype(dtype) not in (np.dtype(np.float64), np.dtype(np.float32)):
            raise ValueError(f"dtype must be float64 or float32, got {np.dtype(dtype)}")
        self._cage = SlateCage.of(self._mesh)
        self._placements = Placements.of(placements, name=name)
        self._blocks = Blocks(self._cage, _columns(self._mesh), dtype, workers=thread_count(workers))
        self._views = Views(self._cage, self._blocks)
        self._shown = Shown(self._cage, len(self._placements))

    def update(
        self,
        camera: Camera,
        /,
        *,
        depths: Depths | None = None,
        budget: int | None = None,
        positions: ArrayLike | None = None,
        placements: ArrayLike | None = None,
    ) -> Tessellated:
        """Tessellate for what `camera` sees.

        Parameters
        ----------
        camera : Camera
            In the space of the placements; without these in that of the mesh.
        depths : Depths, optional
            The rules.
        budget : int, optional
            Triangles at most, of all placements together. First the maximum depth is lowered, then patches
            that look largest get the next depth back. `FrameRate` finds the budget for a rate of frames.
        positions : (n, 3) float, optional
            Of the control mesh from now on: only patches with a vertex that moved in their one-ring are
            computed anew.
        placements : (k, 4, 4) float, optional
            From now on, as many as before.

        Raises
        ------
        FovealError
            If there are other than n positions, one is not finite, or placements are none.
        """
        self._move(positions, placements)
        look = self._views.look(camera, depths or Depths(), self._placements)
        chosen, is_capped = (look.depths(), False) if budget is None else look.within(budget)
        return self._show(chosen, is_capped=is_capped)

    def show(self, depths: ArrayLike, /, *, positions: ArrayLike | None = None) -> Tessellated:
        """Tessellate at given depths.

        Parameters
        ----------
        depths : int, or (m,) or (k, m) int
            Of patches, from 0 to 8: everywhere, of each patch, or of each of each placement.
        positions : (n, 3) float, optional
            As for `update`.

        Examples
        --------
        >>> from foveal.mesh.poly_shapes import cube
        >>> Slates(cube()).show(2).triangles
        192
        >>> Slates(cube()).show([0, 1, 0, 0, 0, 0]).triangles
        30
        """
        self._move(positions, None)
        k, m = len(self._placements), len(self._cage.faces)
        wanted = np.asarray(depths)
        if wanted.dtype.kind not in "iu" or not ((wanted >= 0) & (wanted <= 8)).all():
            raise ValueError("depths must be whole numbers from 0 to 8")
        chosen = np.broadcast_to(wanted, (k, m)).astype(np.int8)
        return self._show(np.where(self._cage.is_shown, chosen, np.int8(-1)).reshape(-1))

    def _move(self, positions: ArrayLike | None, placements: ArrayLike | None) -> None:
        if placements is not None:
            matrices = Placements.of(placements, name=self._name)
            if len(matrices) != len(self._placements):
                raise FovealError(
                    f"{self._name}: there are {len(self._placements)} placements, got {len(matrices)}."
                )
            self._placements = matrices
        if positions is not None:
            points = np.asarray(positions, np.float64)
            if points.shape != self._mesh.positions.shape or not np.isfinite(points).all():
                raise FovealError(
                    f"{self._name}: positions must be {len(self._mesh.positions)} times three finite numbers."
                )
            self._views.move(*self._blocks.move(points))

    def _show(self, depths: NDArray[np.int8], *, is_capped: bool = False) -> Tessellated:
        sides = self._shown.along_sides(depths)
        is_elsewhere, patches = self._blocks.ensure(*self._shown.wanted(depths, sides))
        renewed = self._shown.show(depths, sides, self._blocks.places, is_elsewhere)
        deepest = int(depths.max(initial=-1))
        return Tessellated(self._shown.triangles, len(patches), len(renewed), deepest, is_capped)

    def changed(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Which rows of `arrays` the last update wrote: of positions, normals and columns, and of faces.

        Returns
        -------
        (r, 2), (s, 2) int64
            Ascending ranges, the first row and the one after the last. All other rows are as they were, so
            that who holds a copy needs these alone.

        Examples
        --------
        >>> from foveal.mesh.poly_shapes import cube
        >>> surface = Slates(cube())
        >>> _ = surface.show(0)
        >>> surface.changed()
        (array([[ 0, 24]]), array([[ 0, 12]]))
        """
        return self._blocks.changed(), self._shown.changed()

    @property
    def patches(self) -> int:
        """How many there are, holes with them."""
        return len(self._cage.faces)

    def arrays(self) -> SlateArrays:
        """What is shown, without a copy."""
        positions, normals, *columns = self._blocks.rows
        shape = len(self._placements), self.patches
        shown = self._shown
        return SlateArrays(
            positions,
            normals,
            shown.rows,
            shown.places.reshape(shape),
            shown.counts.reshape(shape),
            shown.depths.reshape(shape),
            self._cage.faces,
            columns,
            shown.levels,
        )

    def mesh(self) -> TriMesh:
        """What is shown as one mesh, in the space of the camera.

        Vertices of patches beside each other are one where place, normal and attributes agree, so that only
        creases, corners and placements are apart.
        """
        return joined(self.arrays(), self._placements.matrices, has_colours=self._mesh.colours is not None)

    @property
    def bytes_beside(self) -> int:
        """What the work takes beside rows that come out: slates, limits at vertices, where things are."""
        return self._blocks.bytes_beside


def slates(
    mesh: PolyMesh | TriMesh,
    camera: Camera,
    /,
    *,
    depths: Depths | None = None,
    budget: int | None = None,
) -> TriMesh:
    """A Catmull-Clark surface tessellated for one view, with limit normals; see `Slates`.

    Examples
    --------
    >>> from foveal.mesh.poly_shapes import cube
    >>> from foveal.view.camera import Camera
    >>> seen = slates(cube(), Camera.around([-1, -1, -1], [1, 1, 1]), budget=500)
    >>> 400 < len(seen.faces) <= 500
    True
    """
    surface = Slates(mesh, workers=None)
    surface.update(camera, depths=depths, budget=budget)
    return surface.mesh()


def _columns(mesh: PolyMesh) -> list[Floats]:
    """Positions, then the attributes by three columns."""
    columns = [mesh.positions]
    if mesh.colours is not None:
        columns.append(mesh.colours.astype(np.float64))
    if mesh.uvs is not None:
        columns.append(np.column_stack([mesh.uvs, np.zeros(len(mesh.uvs))]))
    return columns
