"""The graph of patches: its links by hand, and what it refuses."""

import dataclasses

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.lod.graph import Graph


def small():
    """Node 0 holds patches 0, 1; node 1 patches 2, 3; node 2 patch 4. Node 2 refines 1 and 3."""
    return Graph(
        centres=np.zeros((3, 3)),
        radii=np.array([3.0, 2.0, 1.0]),
        errors=np.array([np.inf, 0.5, 0.25]),
        first_patch=np.array([0, 2, 4, 5]),
        finer=np.array([1, 2, -1, 2, -1], dtype=np.int32),
        triangles=np.array([10, 20, 15, 7, 40]),
        vertices=np.array([5, 10, 7, 4, 20]),
        patch_bytes=np.array([30, 60, 45, 21, 120]),
    )


def test_links_and_sums_by_hand():
    graph = small()
    assert [list(p) for p in graph.parents] == [[], [0], [0, 1]]
    _, _, first_child, children = graph.links
    assert first_child.tolist() == [0, 2, 3, 3]
    assert children.tolist() == [1, 2, 2]
    assert graph.owner.tolist() == [0, 0, 1, 1, 2]
    assert graph.node_bytes.tolist() == [90, 66, 120]
    assert graph.hidden_triangles.tolist() == [0, 10, 27]


def test_a_node_without_patches_has_no_bytes():
    graph = dataclasses.replace(small(), first_patch=np.array([0, 4, 4, 5]))
    assert graph.node_bytes.tolist() == [156, 0, 120]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"radii": np.zeros(2)}, "different lengths"),
        ({"triangles": np.zeros(4, dtype=np.int64)}, "different lengths"),
        ({"first_patch": np.array([0, 4, 2, 5])}, "do not follow"),
        ({"first_patch": np.array([1, 2, 4, 5])}, "do not follow"),
        ({"finer": np.array([0, 2, -1, 2, -1], dtype=np.int32)}, "does not come after"),
        ({"finer": np.array([1, 2, 1, 2, -1], dtype=np.int32)}, "does not come after"),
        ({"finer": np.array([1, 3, -1, 2, -1], dtype=np.int32)}, "does not come after"),
        ({"finer": np.array([1, -2, -1, 2, -1], dtype=np.int32)}, "does not come after"),
    ],
)
def test_columns_that_make_no_graph_are_refused(change, words):
    with pytest.raises(FovealError, match=words):
        dataclasses.replace(small(), **change)


def test_no_node_is_refused():
    nothing = np.zeros(0, dtype=np.int64)
    with pytest.raises(FovealError, match="no node"):
        Graph(np.zeros((0, 3)), nothing, nothing, np.zeros(1), nothing, nothing, nothing, nothing)
