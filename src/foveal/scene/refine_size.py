"""How many triangles a refinement will have, about, and may have."""

import math

import numpy as np
import psutil
from numpy.typing import NDArray

from foveal.view.camera import Camera

from .control_mesh import ControlMesh

__all__ = ["MOST_TRIANGLES", "everywhere", "expected", "most_triangles"]

MOST_TRIANGLES = 50_000_000
"""What a refinement may have: a minute of work and a file of a gigabyte; more is hardly ever meant."""

# Of memory for a triangle, with what growing takes and the mesh that is handed out. Measured at 19, 21 and 7
# million: 190 for √3, 275 for Loop, 86 for the √3 paper's way.
_BYTES = {"sqrt3": 220, "loop": 300, "butterfly": 300, "filter": 200, "catmull-clark": 300}
_SHARE = 0.8  # of the memory that is free


def most_triangles(scheme: str, /) -> int:
    """How many triangles the memory that is free now holds, and not more than 50 million.

    Of a scheme, or of the √3 paper's own way, "filter".
    """
    free = int(psutil.virtual_memory().available * _SHARE)
    return min(MOST_TRIANGLES, free // _BYTES[scheme])


def everywhere(triangles: int, scheme: str, iterations: int, /) -> int:
    """How many there are after so many uniform iterations, borders or not.

    Examples
    --------
    >>> everywhere(20, "sqrt3", 3), everywhere(20, "loop", 3)
    (540, 1280)
    """
    return int(triangles * (3 if scheme == "sqrt3" else 4) ** iterations)


def expected(cage: ControlMesh, camera: Camera, /) -> float:
    """About how many there will be for a camera, to show how far the work is: mostly within twice as many.

    As if each triangle of the control mesh stayed flat: what bends less than asked, or leaves the view
    half-way, is counted all the same.
    """
    mesh, refinement = cage.mesh, cage.refinement
    corners = mesh.positions[mesh.faces]
    edges = np.roll(corners, -1, axis=1) - corners
    longest = np.linalg.norm(edges, axis=2).max(axis=1)
    middles = corners.mean(axis=1)
    towards = camera.position - middles
    away = np.maximum(np.linalg.norm(towards, axis=1), 1e-300)
    planes = camera.frustum()
    is_seen = (middles @ planes[:, :3].T + planes[:, 3] + longest[:, None] >= 0).all(axis=1)
    is_front = (np.cross(edges[:, 0], edges[:, 1]) * towards).sum(axis=1) > 0
    size = longest * camera.pixels_per_radian() / away
    growth = 3 if refinement.scheme == "sqrt3" else 4
    criteria = refinement.criteria
    front, silhouette, back = (
        _levels(size, region.iterations, region.edge_px, growth)
        for region in (criteria.front, criteria.silhouette, criteria.back)
    )
    levels = np.where(is_front, front, back)
    # Along a silhouette a line is refined, and no area: each step gives the square root of the growth.
    further = np.where(_is_silhouette(mesh.faces, is_front), np.maximum(silhouette - levels, 0), 0)
    counts = np.where(is_seen, np.exp2((levels + 0.5 * further) * math.log2(growth)), 1.0)
    return float(counts.sum())


def _levels(size: NDArray[np.float64], iterations: int, edge_px: float, growth: int) -> NDArray[np.float64]:
    """How often a triangle is split whose longest edge has so many pixels."""
    if edge_px == 0:
        return np.full(len(size), float(iterations))
    steps = np.ceil(np.log(np.maximum(size / edge_px, 1.0)) / (0.5 * math.log(growth)))
    return np.minimum(steps, iterations)


def _is_silhouette(faces: NDArray[np.int32], is_front: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which faces have a corner at which fronts and backs meet."""
    count = int(faces.max(initial=-1)) + 1
    fronts = np.bincount(faces[is_front].reshape(-1), minlength=count)
    backs = np.bincount(faces[~is_front].reshape(-1), minlength=count)
    is_both: NDArray[np.bool_] = (fronts > 0) & (backs > 0)
    return np.asarray(is_both[faces].any(axis=1))
