"""Bringing an RGB triangulation to what a function of the user's asks for, many edges at a time."""

import numpy as np
from numpy.typing import NDArray

from . import _kernels_rgb_ask as kernels
from . import _kernels_rgb_update as update_kernels
from ._kernels_drift import NEVER
from ._kernels_rgb_layout import FACES, PRESENT, SPLITS
from .rgb_edges import Edges, Measure
from .rgb_state import State

__all__ = ["bring_measured"]

#: Edges that are asked at once.
_EDGES = 1 << 15

#: No view: the function alone decides.
_VIEW, _LIMITS = np.zeros(24), np.zeros((3, 3))


def bring_measured(state: State, measure: Measure, scale: float, most_faces: int) -> None:
    """Split the edges for which `measure` is above `scale`; stops early with more than `most_faces`."""
    net = state.net
    net.faces["until"][: net.counts[FACES]] = net.vertices["until"] = 0
    _answer_split(state, measure, scale)
    update_kernels.coarsen(state.net)
    update_kernels.enqueue_expired(state.net, kernels.NO_DRIFT)
    while state.faces <= most_faces:
        before = int(state.net.counts[SPLITS])
        asked = _answer_candidates(state, measure, scale)
        if int(state.net.counts[SPLITS]) > before:  # what was forced may be wanted for itself
            _answer_split(state, measure, scale)
        elif not asked:
            break


def _answer_split(state: State, measure: Measure, scale: float) -> None:
    """Ask about the edges that are split and were not asked yet."""
    vertices = state.net.vertices
    is_asked = (vertices["flags"] & PRESENT != 0) & (vertices["birth"] > 0) & (vertices["until"] < NEVER)
    slots = np.nonzero(is_asked)[0].astype(np.int32)
    for order in np.split(slots, range(_EDGES, len(slots), _EDGES)):
        edges, begin = _room(len(order)), 0
        while (begin := int(kernels.describe_split(state.net, order, begin, *edges))) < len(order):
            state.grow()
        kernels.set_meets(state.net, order, _answers(measure, edges, scale))


def _answer_candidates(state: State, measure: Measure, scale: float) -> bool:
    """Ask about unsplit edges and split those; whether there were any."""
    edges, pairs = _room(_EDGES), np.empty((_EDGES, 2), np.int32)
    if not update_kernels.has_room(state.net):
        state.grow()
    count = int(kernels.candidates(state.net, pairs, *edges))
    is_split = _answers(
        measure, Edges(edges.ends[:count], edges.levels[:count], edges.middles[:count]), scale
    )
    wanted, begin = pairs[:count][is_split], 0
    while (begin := int(kernels.split_pairs(state.net, wanted, begin, _VIEW, _LIMITS))) < len(wanted):
        state.grow()
    return count > 0


def _room(count: int) -> Edges:
    return Edges(np.empty((count, 2, 3)), np.empty(count, np.int64), np.empty((count, 3)))


def _answers(measure: Measure, edges: Edges, scale: float) -> NDArray[np.bool_]:
    count = len(edges.levels)
    answers = np.asarray(measure(edges)) if count else np.zeros(0)
    if answers.shape != (count,) or answers.dtype.kind not in "bfiu":
        raise ValueError(
            f"criteria must give {count} numbers or booleans, one for each edge, got {answers.dtype} "
            f"of shape {answers.shape}"
        )
    if answers.dtype.kind == "b":
        if scale != 1.0:
            raise ValueError("a budget needs criteria that give numbers, to know which edges matter most")
        return answers.astype(np.bool_)
    is_wanted: NDArray[np.bool_] = answers > scale
    return is_wanted
