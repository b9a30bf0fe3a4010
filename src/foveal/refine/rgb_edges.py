"""Criteria of one's own for edges: a function of many edges at once."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Edges", "Measure", "by_distance", "by_length"]


class Edges(NamedTuple):
    """Edges of uniform subdivision that might be split.

    Attributes
    ----------
    ends : (n, 2, 3) float64
        Where the ends are on the edge's level.
    levels : (n,) int64
    middles : (n, 3) float64
        Where the vertex that splits it is born.
    """

    ends: NDArray[np.float64]
    levels: NDArray[np.int64]
    middles: NDArray[np.float64]


Measure = Callable[[Edges], NDArray[Any]]
"""(n,) numbers, an edge being split where it is above 1, or (n,) bool. If it asks nothing but the edges, the
mesh depends on nothing else."""


def by_length(length: float, /) -> Measure:
    """Edges longer than `length` are split.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> from foveal.refine import Rgb
    >>> refined = Rgb(tetrahedron())
    >>> refined.update(criteria=by_length(0.5)).faces > 4
    True
    """

    def measure(edges: Edges) -> NDArray[np.float64]:
        lengths: NDArray[np.float64] = np.linalg.norm(edges.ends[:, 1] - edges.ends[:, 0], axis=1) / length
        return lengths

    return measure


def by_distance(distance: float, /) -> Measure:
    """Edges whose middle is farther than `distance` from the vertex that would split it are split."""

    def measure(edges: Edges) -> NDArray[np.float64]:
        moved: NDArray[np.float64] = (
            np.linalg.norm(edges.middles - edges.ends.mean(axis=1), axis=1) / distance
        )
        return moved

    return measure
