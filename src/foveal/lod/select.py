"""Which nodes to expand for a view: largest screen error first, within budgets.

The same rule runs in the viewer, `viewer/src/select/cut.ts`; both are held to
`spec/golden/selection.json`. It is a pure function: no memory of earlier frames, so the same view over
the same nodes always gives the same picture.

Based on Cignoni, P. et al. (2005). Batched multi triangulation. IEEE Visualization.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from foveal.view.camera import Camera

from . import _kernels_select as kernels
from .graph import Graph

__all__ = ["Cut", "cut", "cut_by_error"]


@dataclass(frozen=True)
class Cut:
    """A surface without cracks, and what would make it better.

    Attributes
    ----------
    expanded : (n,) bool
        The nodes whose patches are in use. With every node its parents are.
    drawn : (k,) int32
        Patches to draw, the nodes with the larger screen error first.
    wanted : (w,) int32
        Nodes that the view asks for and that are not available, falling in screen error; every node
        comes after its parents. Loading them all keeps within the budgets.
    triangles : int
        Of the drawn patches.
    held_bytes : int
        Of the expanded nodes.
    error_px : float
        The largest screen error that is left in view: what is drawn is no worse than this. Infinite
        while node 0 is not available.
    """

    expanded: NDArray[np.bool_]
    drawn: NDArray[np.int32]
    wanted: NDArray[np.int32]
    triangles: int
    held_bytes: int
    error_px: float


def cut(
    graph: Graph,
    camera: Camera,
    /,
    *,
    error_px: float = 1.0,
    triangle_budget: int | None = None,
    byte_budget: int | None = None,
    available: ArrayLike | None = None,
    is_culling: bool = True,
) -> Cut:
    """The coarsest cut that looks right from a camera to `error_px`, or the best within the budgets.

    First all nodes count as available, and are expanded in the order of falling screen error (of
    equals the lower index) while the error is above `error_px`, the node may be seen, all its parents
    are expanded, and the next one keeps within the budgets. Of these, what is available and has all
    parents expanded makes the cut; what is not available is wanted. So nothing is loaded that the
    budgets would not let in, and what arrives never pushes out what is there.

    Parameters
    ----------
    graph : Graph
    camera : Camera
        In the unit of the graph and relative to the same origin.
    error_px : float
        Nodes with a screen error above this are expanded. Below 0: all that may be seen, even those
        whose error is 0.
    triangle_budget, byte_budget : int, optional
        Limits of the triangles drawn and of the bytes of expanded nodes (`graph.node_bytes`). Node 0 is
        expanded even if it alone is above them. A larger budget expands the same nodes and more.
    available : (n,) bool, optional
        The nodes at hand; all by default. Without node 0 nothing is drawn.
    is_culling : bool
        Whether what the frustum has outside is left coarse and not drawn.

    Raises
    ------
    ValueError
        If `available` has not one value a node, or `error_px` is NaN.

    Examples
    --------
    >>> root_and_leaf = Graph(
    ...     centres=np.zeros((2, 3)), radii=np.ones(2), errors=np.array([np.inf, 0.1]),
    ...     first_patch=np.array([0, 1, 2]), finer=np.array([1, -1], dtype=np.int32),
    ...     triangles=np.array([100, 200]), vertices=np.array([50, 100]), patch_bytes=np.array([200, 400]),
    ... )
    >>> near = Camera.of([0, 0, 5], [0, 0, 0])
    >>> far = Camera.of([0, 0, 500], [0, 0, 0])
    >>> cut(root_and_leaf, near).triangles, cut(root_and_leaf, far).triangles
    (200, 100)
    """
    view = (camera.position, camera.pixels_per_radian(), camera.near)
    seen = np.ones(len(graph.errors), dtype=np.bool_)
    if is_culling:
        kernels.find_seen(*graph.bounds, camera.frustum(), seen)
    at_hand = (
        np.ones(len(seen), dtype=np.bool_) if available is None else np.asarray(available, dtype=np.bool_)
    )
    if at_hand.shape != seen.shape:
        raise ValueError(f"available must have shape {seen.shape}, got {at_hand.shape}")
    if math.isnan(error_px):
        raise ValueError("error_px must be a number, got NaN")
    return _select(graph, graph.bounds, view, seen, at_hand, error_px, triangle_budget, byte_budget)


def cut_by_error(graph: Graph, /, *, error: float | None = None) -> Cut:
    """The coarsest cut whose distance to the original is at most `error` everywhere, seen from nowhere.

    Parameters
    ----------
    graph : Graph
    error : float, optional
        In the unit of the asset. By default all nodes are expanded: the original, every triangle.

    Returns
    -------
    Cut
        With `error_px` in the unit of the asset: the largest bound that is left.
    """
    # Seen from a distance of one unit at one pixel a radian, the screen error is the error.
    centres = np.full_like(graph.bounds[0], [1.0, 0.0, 0.0])
    bounds = (centres, np.zeros(len(centres)), graph.bounds[2])
    every = np.ones(len(centres), dtype=np.bool_)
    view = (np.zeros(3), 1.0, 1.0)
    return _select(graph, bounds, view, every, every, -1.0 if error is None else error, None, None)


def _select(
    graph: Graph,
    bounds: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]],
    view: tuple[NDArray[np.float64], float, float],
    seen: NDArray[np.bool_],
    available: NDArray[np.bool_],
    error_px: float,
    triangle_budget: int | None,
    byte_budget: int | None,
) -> Cut:
    count = len(graph.errors)
    patches, links = graph.patches, graph.links
    hidden, node_bytes = graph.hidden_triangles, graph.node_bytes
    triangle_limit = math.inf if triangle_budget is None else float(triangle_budget)
    byte_limit = math.inf if byte_budget is None else float(byte_budget)
    seen[0] = True  # what stands in node 0 is decided patch by patch

    keys, heap, pending = np.empty(count), np.empty(count, dtype=np.int32), np.diff(links[0])
    order = np.empty(count, dtype=np.int32)
    chosen, worst = kernels.ideal_cut(
        *(bounds, view, patches, links, hidden, node_bytes, seen),
        *(float(error_px), triangle_limit, byte_limit, (keys, heap, pending), order),
    )
    order = order[:chosen]
    expanded, wanted = np.zeros(count, dtype=np.bool_), np.empty(chosen, dtype=np.int32)
    missing, shown, held, worst = kernels.real_cut(
        *(order, keys, worst, patches, links, hidden, node_bytes, seen),
        *(available, triangle_limit, expanded, wanted),
    )
    drawn = np.empty(len(graph.finer), dtype=np.int32)
    standing = kernels.drawn_patches(order, *patches[:2], seen, expanded, drawn)
    return Cut(
        expanded, drawn[:standing].copy(), wanted[:missing].copy(), int(shown), int(held), float(worst)
    )
