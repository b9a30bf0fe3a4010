"""Chunk 0 of a multires file: the graph's columns and the codec's tables, as in spec/container.md."""

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.lod.graph import Graph

__all__ = ["nested_spheres", "pack", "rounded_up", "unpack"]


def rounded_up(values: NDArray[np.float64], /) -> NDArray[np.float64]:
    """The least float32 that are at least `values`, as float64.

    Examples
    --------
    >>> bool(rounded_up(np.array([0.1]))[0] >= 0.1), rounded_up(np.array([0.5]))
    (True, array([0.5]))
    """
    narrow = values.astype(np.float32)
    below = narrow.astype(np.float64) < values
    narrow[below] = np.nextafter(narrow[below], np.float32(np.inf))
    return narrow.astype(np.float64)


def nested_spheres(
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    children: list[NDArray[np.int64]],
    /,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Spheres, as float32 can hold them, around boxes and around the spheres of children.

    Parameters
    ----------
    low, high : (n, 3) float64
        Each node's own box.
    children : list of n arrays
        Nodes after this one.

    Returns
    -------
    centres, radii : (n, 3) and (n,) float64
        Values of float32.
    """
    low, high = low.copy(), high.copy()
    count = len(low)
    centres, radii = np.empty((count, 3)), np.empty(count)
    for node in range(count - 1, -1, -1):
        below = children[node]
        own = np.stack([low[node], high[node]])
        if len(below):
            low[node] = np.minimum(low[node], low[below].min(axis=0))
            high[node] = np.maximum(high[node], high[below].max(axis=0))
        centre = ((low[node] + high[node]) / 2).astype(np.float32).astype(np.float64)
        corner = np.maximum(np.abs(own[0] - centre), np.abs(own[1] - centre))
        radius = float(np.linalg.norm(corner))
        if len(below):
            apart = np.linalg.norm(centres[below] - centre, axis=1)
            radius = max(radius, float((apart + radii[below]).max()))
        centres[node] = centre
        radii[node] = rounded_up(np.array([radius * (1 + 1e-7)]))[0]
    return centres, radii


def pack(graph: Graph, tables: bytes, /) -> bytes:
    """Chunk 0. Errors and radii must be values of float32 already; see `rounded_up`."""
    spheres = np.concatenate([graph.centres, graph.radii[:, None]], axis=1)
    return b"".join(
        [
            graph.first_patch.astype("<u4").tobytes(),
            spheres.astype("<f4").tobytes(),
            graph.errors.astype("<f4").tobytes(),
            graph.finer.astype("<i4").tobytes(),
            graph.triangles.astype("<u4").tobytes(),
            graph.vertices.astype("<u4").tobytes(),
            graph.patch_bytes.astype("<u4").tobytes(),
            tables,
        ]
    )


def unpack(chunk: bytes, nodes: int, patches: int, /, *, name: str) -> tuple[Graph, bytes]:
    """The graph and the tables of chunk 0.

    Raises
    ------
    FovealError
        In a sentence that begins with `name`, if the chunk is too short or its numbers contradict each
        other.
    """

    def wrong(what: str) -> FovealError:
        return FovealError(f"{name}: the graph of patches is damaged ({what}). Copy or build the file again.")

    if nodes < 1 or patches < 1 or len(chunk) < 4 + 24 * nodes + 16 * patches:
        raise wrong("too short")
    at = 0

    def column(kind: str, count: int) -> NDArray[np.generic]:
        nonlocal at
        values = np.frombuffer(chunk, kind, count, at)
        at += values.nbytes
        return values

    first = column("<u4", nodes + 1).astype(np.int64)
    spheres = column("<f4", 4 * nodes).astype(np.float64).reshape(nodes, 4)
    errors = column("<f4", nodes).astype(np.float64)
    finer = column("<i4", patches).astype(np.int32)
    triangles, vertices, patch_bytes = (column("<u4", patches).astype(np.int64) for _ in range(3))
    if first[0] != 0 or first[-1] != patches or (np.diff(first) < 0).any():
        raise wrong("patches")
    if not np.isfinite(spheres).all() or (spheres[:, 3] < 0).any():
        raise wrong("spheres")
    if np.isnan(errors).any() or (errors < 0).any() or errors[0] != np.inf:
        raise wrong("errors")
    owner = np.repeat(np.arange(nodes), np.diff(first))
    if (finer < -1).any() or (finer >= nodes).any() or ((finer >= 0) & (finer <= owner)).any():
        raise wrong("order of nodes")
    graph = Graph(
        spheres[:, :3].copy(), spheres[:, 3].copy(), errors, first, finer, triangles, vertices, patch_bytes
    )
    return graph, chunk[at:]
