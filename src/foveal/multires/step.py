"""The grid's step, from how large the errors of simplification are anyway."""

from concurrent.futures import Executor
from typing import TYPE_CHECKING

import numpy as np

from .bounds import deviation
from .pieces import Piece, is_proper, join
from .simplify import simplify

if TYPE_CHECKING:
    from .levels import Cells

__all__ = ["choose_step"]

_SAMPLES = 4

#: Half a diagonal of the grid, over the error of the first simplification. At a quarter the least error
#: that any node stores grows by a quarter at most, and that node is swapped for the finest at the same
#: distance where the grid alone would show as a quarter of the tolerance.
_SHARE = 0.25


def choose_step(cells: "Cells", fine_step: float, executor: Executor, /) -> float:
    """Simplify some cells on the door's grid and derive the step from the median of their errors.

    Parameters
    ----------
    cells : Cells
        Of the first level, positions in `fine_step`.
    executor : Executor

    Returns
    -------
    float
        In the unit of `fine_step`; between 2^9 of those (a grid of 21 bits) and 2^19 (11 bits).
    """
    full = [c for c in cells.content if c]
    every = max(1, len(full) // _SAMPLES)
    samples = [[Piece.of(cells.store.get(ref)) for _, ref in content] for content in full[::every][:_SAMPLES]]
    errors = [error for error in executor.map(_error, samples) if error is not None]
    wanted = float(np.median(errors or [0.0])) * _SHARE / (np.sqrt(3.0) / 2.0)
    return float(np.clip(wanted, 1 << 9, 1 << 19)) * fine_step


def _error(pieces: list[Piece]) -> float | None:
    """The error of a cell's first simplification, in the unit of its positions; None where all is flat."""
    whole, _ = join(pieces)
    faces = whole.faces[is_proper(whole.faces)]
    if len(faces) == 0:
        return None
    # In units of 2^6 fine steps: quadrics of numbers this size keep ten digits, and that new vertices are
    # put on whole units is an eighth of the least step at most.
    local = (whole.positions.astype(np.float64) - whole.positions[0]) / 64.0
    size = len(faces)
    coarse = simplify(local, faces, _border(whole), target=size // 2, relaxed_above=size)
    found = deviation(local, faces, np.zeros(size, np.float32), coarse)
    return float(np.max(found, initial=0.0)) * 64.0


def _border(whole: Piece) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Nothing locked: a sample's border has walls."""
    return np.zeros(len(whole.ids), np.bool_)
