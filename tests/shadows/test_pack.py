"""Words say what the tree says, at every pixel and every level."""

import dataclasses
import importlib
import itertools

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.shadows.pack import pack
from foveal.shadows.tree import Tree
from shadows.maps import TREES
from shadows.naive_lookup import cut, value_in
from shadows.naive_shadows import value_at

packing = importlib.import_module("foveal.shadows.pack")  # the function has its name


@pytest.fixture(params=TREES, scope="module")
def tree(request):
    return TREES[request.param]()


def pixels_of(tree):
    side = range(1 << tree.levels)
    return list(itertools.product(side, side, side if tree.children == 8 else [0]))[
        :: 3 if len(side) > 8 else 1
    ]


@pytest.mark.parametrize("most", [65535, 300, 40])
def test_every_pixel_has_the_value_of_the_tree(tree, most, monkeypatch):
    monkeypatch.setattr(packing, "_MOST_POINTER", most)
    packed = pack(tree)
    for x, y, z in pixels_of(tree):
        assert value_in(packed, x, y, z) == value_at(tree, x, y, z)


def test_words_are_four_bytes_a_leaf_or_empty_node_and_eight_an_inner_one(tree):
    packed = pack(tree)
    assert len(packed.words) == len(tree.masks) + len(tree.values)
    assert (packed.scales == 1).all()


def test_a_level_is_the_map_of_the_tree_cut_there(tree):
    for level in range(tree.levels + 1):
        coarse, packed = cut(tree, level), pack(tree)
        for x, y, z in pixels_of(coarse):
            assert value_in(packed, x, y, z, level) == value_at(coarse, x, y, z)


def test_the_scale_is_that_of_least_padding(monkeypatch):
    tree = TREES["noise"]()
    monkeypatch.setattr(packing, "_MOST_POINTER", 40)
    packed = pack(tree)
    assert packed.scales[0] == 1
    assert packed.scales[1] > 1
    best = len(packed.words)
    monkeypatch.setattr(packing, "_TRIALS", 3)
    assert len(pack(tree).words) >= best


def test_what_pointers_cannot_reach_is_told(monkeypatch):
    monkeypatch.setattr(packing, "_MOST_POINTER", 1)
    with pytest.raises(FovealError, match="too large for 16-bit pointers"):
        pack(TREES["noise"]())
    monkeypatch.undo()
    monkeypatch.setattr(packing, "_MOST_WORDS", 100)
    with pytest.raises(FovealError, match="more than 2\\^32"):
        pack(TREES["noise"]())


def test_packing_changes_nothing_of_the_tree(tree):
    before = [np.copy(getattr(tree, field.name)) for field in dataclasses.fields(Tree)]
    pack(tree)
    for field, was in zip(dataclasses.fields(Tree), before, strict=True):
        np.testing.assert_array_equal(getattr(tree, field.name), was)
