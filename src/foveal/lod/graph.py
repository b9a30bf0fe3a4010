"""The graph of patches that a cut is taken from, for meshes and, later, for points.

A *node* is swapped in as a whole: expanding it shows its patches. Each patch either has the original
resolution or names the finer node that can take its place. Node 0 is always expanded; its patches are
the coarsest picture of the whole. A node may be expanded only when all its parents are, the parents
being the nodes that hold a patch which it refines. Every such set of expanded nodes is a *cut*, and
the patches of expanded nodes whose finer node is not expanded are a surface without cracks
(Cignoni et al. 2005, Batched multi triangulation, section 3).
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = ["Graph"]


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
    """

    centres: NDArray[np.float64]
    radii: NDArray[np.float64]
    errors: NDArray[np.float64]
    first_patch: NDArray[np.int64]
    finer: NDArray[np.int32]
    triangles: NDArray[np.int64]
    vertices: NDArray[np.int64]
    patch_bytes: NDArray[np.int64]
    parents: list[NDArray[np.int32]] = field(init=False)

    def __post_init__(self) -> None:
        owner = np.repeat(np.arange(len(self.errors), dtype=np.int32), np.diff(self.first_patch))
        parents = [np.unique(owner[self.finer == node]) for node in range(len(self.errors))]
        object.__setattr__(self, "parents", parents)
