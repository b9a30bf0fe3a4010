"""Whether a control mesh shows its outside."""

import numpy as np

from foveal.base.progress import Progress, Stage
from foveal.mesh.trimesh import TriMesh

__all__ = ["Once", "is_inside_out", "tell_inside_out"]

_LEAST = 1e-9  # of the box of the longest side: less is a sheet of two sides, which has no inside


def is_inside_out(mesh: TriMesh, /) -> bool:
    """Whether a mesh is closed and its triangles are clockwise seen from outside: its volume is negative.

    Examples
    --------
    >>> from foveal.mesh.shapes import grid_patch, icosphere
    >>> ball = icosphere(1)
    >>> is_inside_out(ball), is_inside_out(TriMesh(ball.positions, ball.faces[:, ::-1].copy()))
    (False, True)
    >>> is_inside_out(grid_patch(3))
    False
    """
    count = len(mesh.positions)
    begin = mesh.faces.reshape(-1).astype(np.int64)
    end = np.roll(mesh.faces, -1, axis=1).reshape(-1).astype(np.int64)
    if not len(begin) or not np.array_equal(np.sort(begin * count + end), np.sort(end * count + begin)):
        return False
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    corners = (mesh.positions / (float((high - low).max()) or 1.0))[mesh.faces]
    corners -= corners[0, 0]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    return bool(volume < -_LEAST)


def tell_inside_out(mesh: TriMesh, name: str, progress: Progress, /) -> None:
    """Say that a control mesh is inside out, if it is, and what to do."""
    if is_inside_out(mesh):
        progress.note(
            f"{name}: it is inside out: closed, with triangles clockwise seen from outside, so its back is "
            "shown and refined as its front. Reverse the corners of each triangle where it was made."
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
