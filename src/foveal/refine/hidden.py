"""What the depth buffer of a picture hides, so that it need not be refined."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

__all__ = ["Hidden"]

_WIDTH = 256


@dataclass(frozen=True, slots=True, eq=False)
class Hidden:
    """A depth buffer, such as the last frame's, with its camera.

    A face is hidden if a ball around it is: if all that the picture shows there is nearer. What the picture
    does not show is not hidden. `Sqrt3.update(..., hidden=...)` refines hidden faces as those that face away.

    Based on: P. Alliez, N. Laurent, H. Sanson, F. Schmitt. Efficient view-dependent refinement of 3D meshes
    using √3-subdivision, its future work; N. Greene, M. Kass, G. Miller. Hierarchical Z-buffer visibility.
    SIGGRAPH 1993.

    Attributes
    ----------
    words : (n,) float64
        What `_kernels_hidden.py` reads: the camera, then the farthest depth of ever larger squares.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> from foveal.refine import Sqrt3
    >>> refined = Sqrt3(icosphere(1))
    >>> camera = Camera.of([0, 0, 4], [0, 0, 0])
    >>> before = refined.update(camera)
    >>> after = refined.update(camera, hidden=Hidden.behind(refined.mesh(), camera))
    >>> after.faces == before.faces  # no front of a ball is hidden
    True
    """

    words: NDArray[np.float64]

    @classmethod
    def behind(cls, mesh: TriMesh, camera: Camera, /, *, width: int = _WIDTH) -> "Hidden":
        """What is behind a mesh, seen by a camera; drawn so many pixels wide."""
        from foveal.raster import rasterise

        small = camera.resized(width, max(1, round(width * camera.height / camera.width)))
        return cls.of(rasterise(mesh.positions, mesh.faces, small).depth, camera)

    @classmethod
    def of(cls, depth: NDArray[np.float32], camera: Camera, /) -> "Hidden":
        """A depth buffer that there is: (height, width), distances along the viewing direction, infinite
        where nothing is seen, the first row the highest. The camera's picture may be larger or smaller."""
        if depth.ndim != 2 or not depth.size:
            raise ValueError(f"depth must have the shape (height, width), got {depth.shape}")
        height, width = depth.shape
        small = camera.resized(width, height)
        levels = [np.asarray(depth, np.float64)]
        while levels[-1].size > 1:
            levels.append(_halved(levels[-1]))
        head = [*small.basis().reshape(-1), *small.position, small.pixels_per_radian(), width, height]
        return cls(np.concatenate([head, *(level.reshape(-1) for level in levels)]))


def _halved(level: NDArray[np.float64]) -> NDArray[np.float64]:
    """The farthest of every two by two."""
    height, width = level.shape
    even = np.pad(level, ((0, height % 2), (0, width % 2)), constant_values=0.0)
    found: NDArray[np.float64] = even.reshape((height + 1) // 2, 2, (width + 1) // 2, 2).max(axis=(1, 3))
    return found
