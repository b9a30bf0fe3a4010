"""Packing, lookups and bias: the cases of spec/golden/, as in the viewer."""

import importlib
import json

import numpy as np
import pytest

from foveal.shadows import Projection
from foveal.shadows import _kernels_lookup as kernels
from foveal.shadows.bias import receivers, window_of
from foveal.shadows.pack import Packed, pack
from foveal.shadows.tree import Tree
from shadows.golden_lookup import PATH, WORDS_PATH

packing = importlib.import_module("foveal.shadows.pack")  # the function has its name

GOLDEN = json.loads(PATH.read_text())
WORDS = np.frombuffer(WORDS_PATH.read_bytes(), "<u4").astype(np.uint32)


@pytest.fixture(params=GOLDEN["trees"], ids=lambda data: data["name"])
def data(request):
    return request.param


def packed_of(data):
    words = WORDS[data["word_start"] : data["word_start"] + data["word_count"]]
    return Packed(words, np.array(data["scales"], np.int64), data["levels"], data["children"], data["root"])


def test_a_tree_has_the_golden_words(data, monkeypatch):
    monkeypatch.setattr(packing, "_MOST_POINTER", data["most_pointer"])
    tree = Tree(
        *(data["levels"], data["children"], data["root"]),
        *(np.array(data["masks"], np.uint16), np.array(data["mask_starts"])),
        *(np.array(data["tree_values"], np.uint32), np.array(data["value_starts"])),
    )
    found, expected = pack(tree), packed_of(data)
    np.testing.assert_array_equal(found.words, expected.words)
    np.testing.assert_array_equal(found.scales, expected.scales)


def test_lookups_have_the_golden_answers(data):
    packed = packed_of(data)
    for case in data["values"]:
        out = np.empty(len(case["pixels"]), np.uint32)
        kernels.values_at(packed, np.array(case["pixels"]), case["level"], out)
        assert out.tolist() == case["values"]
    for case in data["lit"]:
        counts = np.empty(len(case["pixels"]), np.int64)
        asked = (np.array(case["pixels"]), np.array(case["steps"]))
        kernels.lit_counts(packed, *asked, case["radius"], case["level"], counts)
        assert counts.tolist() == case["lit"]


def test_receivers_are_at_the_golden_pixels_and_steps():
    for case in GOLDEN["receivers"]:
        window = window_of(Projection(np.reshape(case["matrix"], (4, 4))), case["levels"])
        normals = None if case["normal"] is None else [case["normal"]]
        ((x, y, step),) = receivers(
            window, [case["point"]], normals=normals, radius=case["radius"], level=case["level"]
        ).tolist()
        assert [x, y] == case["pixel"]
        assert abs(step - case["step"]) <= 1  # the order of sums is not the page's business
