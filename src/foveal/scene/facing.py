"""Whether a control mesh shows its outside."""

import math

import numpy as np
from numpy.typing import NDArray

from foveal.base.progress import Progress, Stage
from foveal.mesh.trimesh import TriMesh

__all__ = ["Once", "is_inside_out", "tell_inside_out"]

# What is open may be a sheet, of which nobody can say. A head open at the neck has 0.085 of its area open, a
# chess pawn 0.18, a bowl and a terrain from 0.5 on; its volume is 0.08 of its area to the power of 1.5.
_OPEN, _OPEN_VOLUME = 0.2, 1e-3
_VOLUME = 1e-9  # less is a sheet of two sides, which has no inside


def is_inside_out(mesh: TriMesh, /) -> bool:
    """Whether the triangles of a mesh that is closed, or all but closed, are clockwise seen from outside.

    Its volume is negative then, with holes closed from the middle of their borders.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch, icosphere
    >>> ball = icosphere(1)
    >>> is_inside_out(ball), is_inside_out(TriMesh(ball.positions, ball.faces[:, ::-1].copy()))
    (False, True)
    >>> is_inside_out(grid_patch(3))
    False
    """
    if not len(mesh.faces):
        return False
    border = _border(mesh)
    is_open = len(border) > 0
    around = border if is_open else mesh.faces[0]
    with np.errstate(over="ignore", invalid="ignore"):  # of what spans all of float64 nothing is said
        positions = mesh.positions / (float(np.ptp(mesh.positions, axis=0).max()) or 1.0)
        corners = (positions - positions[around].mean(axis=0))[mesh.faces]
        areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = float(np.linalg.norm(areas, axis=1).sum())
    volume = float((corners[:, 0] * areas).sum()) / 3
    is_sheet = float(np.linalg.norm(areas.sum(axis=0))) > _OPEN * area
    least = (_OPEN_VOLUME if is_open else _VOLUME) * area * math.sqrt(area)
    return not is_sheet and volume < -least


def _border(mesh: TriMesh) -> NDArray[np.int64]:
    """The ends of edges of one triangle."""
    count = np.int64(len(mesh.positions))
    others = np.roll(mesh.faces, -1, axis=1)
    edges = np.minimum(mesh.faces, others) * count + np.maximum(mesh.faces, others)
    edges = np.sort(edges, axis=None)
    is_new = np.concatenate([[True], edges[1:] != edges[:-1], [True]])
    alone = edges[is_new[1:] & is_new[:-1]]
    return np.concatenate([alone // count, alone % count])


def tell_inside_out(mesh: TriMesh, name: str, progress: Progress, /) -> None:
    """Say that a control mesh is inside out, if it is, and what to do."""
    if is_inside_out(mesh):
        progress.note(
            f"{name}: it is inside out: its triangles are clockwise seen from outside, so its back is shown "
            "and refined as its front. Reverse the corners of each triangle where it was made."
        )


class Once:
    """A `Progress` that notes each sentence once."""

    def __init__(self, progress: Progress, /) -> None:
        self._progress = progress
        self._noted: set[str] = set()

    def stage(self, what: str, total: float | None) -> Stage:
        """As the other one does."""
        return self._progress.stage(what, total)

    def note(self, sentence: str) -> None:
        """The same, unless it was said."""
        if sentence not in self._noted:
            self._noted.add(sentence)
            self._progress.note(sentence)
