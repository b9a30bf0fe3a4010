"""The cut: golden cases shared with the viewer, its slow twin, and the laws that make it a cut."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.lod import _kernels_select as kernels
from foveal.lod.graph import Graph
from foveal.lod.select import cut, cut_by_error
from foveal.view.camera import Camera
from foveal.view.project import screen_error
from lod import naive_select
from lod.random_graphs import random_model, random_view

GOLDEN = json.loads((Path(__file__).parents[2] / "spec" / "golden" / "selection.json").read_text())
seeds = st.integers(0, 2**32 - 1)
few = settings(max_examples=60, deadline=None)


def golden_graph(columns):
    spheres = np.array(columns["spheres"]).reshape(-1, 4)
    errors = [np.inf if e is None else e for e in columns["errors"]]
    integers = {
        k: np.array(columns[k]) for k in ("first_patch", "finer", "triangles", "vertices", "patch_bytes")
    }
    return Graph(spheres[:, :3], spheres[:, 3], np.array(errors), **integers)


def golden_camera(data):
    vectors = {name: np.array(data[name]) for name in ("position", "target", "up")}
    rest = {name: data[name] for name in ("field_of_view", "width", "height", "near", "far")}
    return Camera(**vectors, **rest)


def as_lists(chosen):
    return {
        "expanded": np.flatnonzero(chosen.expanded).tolist(),
        "drawn": chosen.drawn.tolist(),
        "wanted": chosen.wanted.tolist(),
        "triangles": chosen.triangles,
        "held_bytes": chosen.held_bytes,
        "error_px": chosen.error_px,
    }


@pytest.fixture(scope="module")
def golden_graphs():
    return [golden_graph(columns) for columns in GOLDEN["graphs"]]


@pytest.mark.parametrize("case", GOLDEN["cases"], ids=range(len(GOLDEN["cases"])))
def test_golden_case(case, golden_graphs):
    graph, options = golden_graphs[case["graph"]], dict(case["options"])
    if options["available"] is not None:
        options["available"] = np.isin(np.arange(len(graph.errors)), options["available"])
    chosen = as_lists(cut(graph, golden_camera(case["camera"]), **options))
    chosen["error_px"] = None if np.isinf(chosen["error_px"]) else chosen["error_px"]
    assert chosen == case["cut"]


def shown_atoms(model, drawn):
    return np.sort(np.concatenate([model.covers[patch] for patch in drawn]))


def is_closed(graph, expanded):
    return all(expanded[graph.parents[node]].all() for node in np.flatnonzero(expanded))


@few
@given(seeds, st.sampled_from([-1.0, 0.0, 0.3, 2.0]), st.booleans(), st.booleans(), st.booleans())
def test_agrees_with_its_slow_twin(seed, error_px, is_culling, has_triangle_budget, has_byte_budget):
    rng = np.random.default_rng(seed)
    leaves, scale = int(rng.integers(1, 20)), float(rng.choice([1, 100]))
    graph = random_model(seed, atoms=50, leaves=leaves, zero_errors=True, error_scale=scale).graph
    total = int(graph.triangles.sum())
    options = {
        "error_px": error_px,
        "is_culling": is_culling,
        "triangle_budget": int(rng.integers(total)) if has_triangle_budget else None,
        "byte_budget": int(rng.integers(3 * total)) if has_byte_budget else None,
        "available": rng.random(len(graph.errors)) < rng.choice([0.5, 0.95, 1.0]),
    }
    camera = random_view(rng, Camera)
    assert as_lists(cut(graph, camera, **options)) == naive_select.cut(graph, camera, **options)


@few
@given(seeds, st.floats(0, 10), st.integers(0, 5000), st.floats(0, 1))
def test_every_cut_covers_every_part_once_within_the_budget(seed, error_px, budget, share):
    model, rng = random_model(seed), np.random.default_rng(seed)
    available = rng.random(len(model.graph.errors)) < share
    available[0] = True
    options = {"error_px": error_px, "triangle_budget": budget, "available": available}
    chosen = cut(model.graph, random_view(rng, Camera), is_culling=False, **options)
    assert is_closed(model.graph, chosen.expanded)
    assert not chosen.expanded[~available].any()
    np.testing.assert_array_equal(shown_atoms(model, chosen.drawn), np.arange(model.atoms))
    assert chosen.triangles == model.graph.triangles[chosen.drawn].sum()
    assert chosen.triangles <= budget or chosen.expanded.sum() == 1


@few
@given(seeds, st.floats(0, 10))
def test_culling_leaves_out_only_what_no_ray_of_the_picture_meets(seed, error_px):
    model, camera = random_model(seed), random_view(np.random.default_rng(seed), Camera)
    graph = model.graph
    chosen = cut(graph, camera, error_px=error_px)
    assert is_closed(graph, chosen.expanded)
    whole = cut(graph, camera, error_px=error_px, is_culling=False)
    assert not (chosen.expanded & ~whole.expanded).any()
    for patch in set(whole.drawn) - set(chosen.drawn):
        # Whatever stands there lies in the sphere of its node, which is outside at least one plane; or
        # is refined there, where the coarser surface stands for it.
        node = graph.owner[patch]
        chain = [node] if not chosen.expanded[node] else []
        chain += [graph.finer[patch]] if graph.finer[patch] >= 0 else [node]
        planes = camera.frustum()
        outside = (graph.centres[chain] @ planes[:, :3].T + planes[:, 3] < -graph.radii[chain][:, None]).any(
            1
        )
        hidden_by = [p for p in graph.parents[node] if not chosen.expanded[p]]
        assert outside.any() or hidden_by


@few
@given(seeds, st.floats(0.01, 10), st.floats(1.01, 5))
def test_a_closer_eye_never_refines_less(seed, error_px, nearer):
    model = random_model(seed)
    # The model lies within 30 units of the origin: all of it is ahead, so all distances shrink.
    far = Camera.of([0, 0, 40 + 60 * nearer], [0, 0, 0], near=0.01)
    near = Camera.of([0, 0, 40], [0, 0, 0], near=0.01)
    coarse = cut(model.graph, far, error_px=error_px, is_culling=False).expanded
    fine = cut(model.graph, near, error_px=error_px, is_culling=False).expanded
    assert not (coarse & ~fine).any()


@few
@given(seeds, st.integers(0, 6000), st.integers(0, 3000), st.booleans())
def test_a_larger_budget_expands_the_same_nodes_and_more(seed, budget, more, is_culling):
    graph, camera = random_model(seed).graph, random_view(np.random.default_rng(seed), Camera)
    options = {"error_px": 0.1, "is_culling": is_culling}
    small = cut(graph, camera, triangle_budget=budget, byte_budget=3 * budget, **options)
    large = cut(graph, camera, triangle_budget=budget + more, byte_budget=3 * budget + more, **options)
    assert not (small.expanded & ~large.expanded).any()
    assert large.error_px <= small.error_px


@few
@given(seeds)
def test_everything_at_hand_and_no_tolerance_gives_the_original(seed):
    model = random_model(seed, zero_errors=True)
    chosen = cut(model.graph, random_view(np.random.default_rng(seed), Camera), error_px=-1, is_culling=False)
    assert set(chosen.drawn) == set(np.flatnonzero(model.graph.finer == -1))
    assert chosen.error_px == 0
    assert chosen.wanted.size == 0
    assert set(cut_by_error(model.graph).drawn) == set(chosen.drawn)


@few
@given(seeds, st.integers(0, 8000))
def test_loading_what_is_wanted_reaches_the_ideal_and_never_undoes(seed, budget):
    graph, rng = random_model(seed).graph, np.random.default_rng(seed)
    camera = random_view(rng, Camera)
    ideal = cut(graph, camera, error_px=0.05, triangle_budget=budget, is_culling=False)
    available = np.zeros(len(graph.errors), dtype=bool)
    before = available
    while True:
        now = cut(graph, camera, error_px=0.05, triangle_budget=budget, is_culling=False, available=available)
        assert not (before & ~now.expanded).any()
        if now.wanted.size == 0:
            break
        before = now.expanded
        available = available.copy()
        available[rng.choice(now.wanted)] = True
    np.testing.assert_array_equal(now.expanded, ideal.expanded)


@few
@given(seeds, st.floats(0, 0.1))
def test_a_cut_by_error_leaves_no_error_above_it(seed, error):
    model = random_model(seed)
    chosen = cut_by_error(model.graph, error=error)
    assert is_closed(model.graph, chosen.expanded)
    assert chosen.error_px <= error
    np.testing.assert_array_equal(chosen.expanded, model.graph.errors > error)


@few
@given(seeds)
def test_screen_error_is_that_of_the_view_room(seed):
    rng = np.random.default_rng(seed)
    camera = random_view(rng, Camera)
    centres = camera.position + rng.normal(size=(50, 3))
    radii = np.linalg.norm(centres - camera.position, axis=1) - rng.uniform(-0.02, 0.2, 50)
    errors = rng.choice([0.0, 0.1, 2.0], 50)
    view = (camera.position, camera.pixels_per_radian(), camera.near)
    found = [kernels.screen_error(e, *c, r, *view) for e, c, r in zip(errors, centres, radii, strict=True)]
    np.testing.assert_array_equal(found, screen_error(errors, centres, radii, camera))


def test_a_column_that_came_read_only_from_a_file_is_fine():
    graph = random_model(1).graph
    for name in ("centres", "radii", "errors", "first_patch", "finer", "triangles"):
        getattr(graph, name).flags.writeable = False
    assert cut_by_error(graph).triangles == graph.triangles[graph.finer == -1].sum()


def test_wrong_options_are_refused():
    graph, camera = random_model(1).graph, Camera.of([0, 0, 9], [0, 0, 0])
    with pytest.raises(ValueError, match="available must have shape"):
        cut(graph, camera, available=[True])
    with pytest.raises(ValueError, match="NaN"):
        cut(graph, camera, error_px=float("nan"))
