"""The graph of patches that a cut is taken from, for meshes and, later, for points.

A *node* is swapped in as a whole: expanding it shows its patches. Each patch either has the original
resolution or names the finer node that can take its place. Node 0 is always expanded; its patches are
the coarsest picture of the whole. A node may be expanded only when all its parents are, the parents
being the nodes that hold a patch which it refines. Every such set of expanded nodes is a *cut*, and
the patches of expanded nodes whose finer node is not expanded are a surface without cracks
(Cignoni et al. 2005, Batched multi triangulation, section 3).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

__all__ = ["Graph"]

Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True)
class Graph:
    """Nodes with their bounds, and their patches.

    Parents come before children in the order of nodes. Bounds are true and nested: a node's error is at
    least each of its children's, and its sphere holds theirs.

    Attributes
    ----------
    centres, radii : (n, 3) float64, (n,) float64
        A sphere around all that the node, and every node below it, can show. In the unit of the asset,
        relative to its origin.
    errors : (n,) float64
        Upper bound of the two-sided distance between the original surface and what is shown in the
        node's place while it is not expanded. Infinite for node 0.
    first_patch : (n + 1,) int64
        Node i holds the patches `first_patch[i]:first_patch[i + 1]`.
    finer : (p,) int32
        The node that refines the patch, -1 for a patch of the original resolution.
    triangles, vertices : (p,) int64
        What the patch holds.
    patch_bytes : (p,) int64
        Its encoded size. A node's patches lie one after the other in the node's chunk.

    Raises
    ------
    FovealError
        If the columns' lengths do not fit together, or a patch names a node that does not come after
        its own. Bounds that are not nested are accepted: a cut stays conforming with any bounds.
    """

    centres: NDArray[np.float64]
    radii: NDArray[np.float64]
    errors: NDArray[np.float64]
    first_patch: NDArray[np.int64]
    finer: NDArray[np.int32]
    triangles: NDArray[np.int64]
    vertices: NDArray[np.int64]
    patch_bytes: NDArray[np.int64]

    def __post_init__(self) -> None:
        nodes, patches = len(self.errors), len(self.finer)
        if nodes == 0:
            raise FovealError("graph: it has no node.")
        node_columns = (len(self.centres), len(self.radii), len(self.first_patch) - 1)
        patch_columns = (len(self.triangles), len(self.vertices), len(self.patch_bytes))
        if any(n != nodes for n in node_columns) or any(n != patches for n in patch_columns):
            raise FovealError("graph: its columns have different lengths.")
        if (
            self.first_patch[0] != 0
            or self.first_patch[-1] != patches
            or (np.diff(self.first_patch) < 0).any()
        ):
            raise FovealError("graph: the patches of its nodes do not follow one another.")
        if ((self.finer != -1) & (self.finer <= self.owner)).any() or (self.finer >= nodes).any():
            raise FovealError("graph: a patch is refined by a node that does not come after its own.")

    @cached_property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Centres, radii and errors as kernels take them: what is read from a file may be read-only."""
        return _for_kernels(np.float64, self.centres, self.radii, self.errors)

    @cached_property
    def owner(self) -> NDArray[np.int32]:
        """(p,): the node that holds each patch."""
        counts = np.diff(self.first_patch)
        return np.repeat(np.arange(len(self.errors), dtype=np.int32), counts)

    @cached_property
    def links(self) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
        """Both directions of the graph: first_parent (n + 1,), parents, first_child (n + 1,), children.

        The parents of node i are `parents[first_parent[i]:first_parent[i + 1]]`, each once, rising; its
        children likewise.
        """
        count = len(self.errors)
        refined = self.finer >= 0
        pairs = np.unique(self.owner[refined].astype(np.int64) * count + self.finer[refined])
        parent, child = pairs // count, pairs % count
        by_child = np.argsort(child, kind="stable")
        return (
            np.searchsorted(child[by_child], np.arange(count + 1)).astype(np.int32),
            parent[by_child].astype(np.int32),
            np.searchsorted(parent, np.arange(count + 1)).astype(np.int32),
            child.astype(np.int32),
        )

    @cached_property
    def parents(self) -> list[NDArray[np.int32]]:
        """The parents of each node, rising."""
        first, parents, _, _ = self.links
        return np.split(parents, first[1:-1])

    @cached_property
    def patches(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """First patches, finer nodes and triangles as kernels take them."""
        return _for_kernels(np.int64, self.first_patch, self.finer, self.triangles)

    @cached_property
    def node_bytes(self) -> NDArray[np.int64]:
        """(n,): the encoded size of each node's patches."""
        total = np.concatenate([[0], np.cumsum(self.patch_bytes, dtype=np.int64)])
        sums: NDArray[np.int64] = total[self.first_patch[1:]] - total[self.first_patch[:-1]]
        return sums

    @cached_property
    def hidden_triangles(self) -> NDArray[np.int64]:
        """(n,): how many triangles a node hides when it is expanded: those of the patches it refines."""
        refined = self.finer >= 0
        out = np.zeros(len(self.errors), dtype=np.int64)
        np.add.at(out, self.finer[refined], self.triangles[refined])
        return out


def _for_kernels(
    dtype: type[Scalar], a: NDArray[Any], b: NDArray[Any], c: NDArray[Any]
) -> tuple[NDArray[Scalar], NDArray[Scalar], NDArray[Scalar]]:
    # One signature only: each further one would be compiled anew.
    a, b, c = (np.require(column, dtype, ["C_CONTIGUOUS", "WRITEABLE"]) for column in (a, b, c))
    return a, b, c
