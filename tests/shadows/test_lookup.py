"""Kernels of lookups against words read one by one."""

import importlib

import numpy as np
import pytest

from foveal.shadows import _kernels_lookup as kernels
from foveal.shadows.pack import pack
from shadows.maps import TREES
from shadows.naive_lookup import lit_count, value_in

packing = importlib.import_module("foveal.shadows.pack")  # the function has its name


@pytest.fixture(params=TREES, scope="module")
def packed(request):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(packing, "_MOST_POINTER", 40)  # so that small trees have scales
        return pack(TREES[request.param]())


def pixels(packed, level, count, seed, *, beside=0):
    """At random and along a path, up to some pixels beside the map."""
    random = np.random.default_rng(seed)
    side = 1 << level
    out = random.integers(-beside, side + beside, (count, 3))
    step = np.cumsum(random.integers(-1, 2, (count // 2, 3)), axis=0) + side // 2
    out[: count // 2] = step.clip(-beside, side - 1 + beside)
    out[:, 2] = out[:, 2].clip(0, side - 1) if packed.children == 8 else 0
    return out


def test_values_of_any_pixels_in_any_order_at_any_level(packed):
    for level in range(packed.levels + 1):
        asked = pixels(packed, level, 300, level)
        out = np.empty(len(asked), np.uint32)
        kernels.values_at(packed, asked, level, out)
        assert out.tolist() == [value_in(packed, *pixel.tolist(), level) for pixel in asked]


@pytest.mark.parametrize("radius", [0, 1, 2, 5])
def test_counts_of_lit_pixels_are_those_of_each_sample(packed, radius):
    for level in range(packed.levels + 1):
        asked = pixels(packed, level, 120, 10 + level, beside=radius + 2)
        steps = np.random.default_rng(radius).choice(packed.words, len(asked)).astype(np.int64)
        steps[::3] = np.random.default_rng(radius).integers(0, 1 << 32, len(steps[::3]))
        out = np.empty(len(asked), np.int64)
        kernels.lit_counts(packed, asked, steps, radius, level, out)
        expected = [
            lit_count(packed, *pixel.tolist(), step, radius, level)
            for pixel, step in zip(asked, steps.tolist(), strict=True)
        ]
        assert out.tolist() == expected
