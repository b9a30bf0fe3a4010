"""Live sessions of Catmull-Clark patches: a page has what the tessellation has, and little is sent."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from foveal import FovealError
from foveal.mesh.poly_shapes import cube, quad_torus
from foveal.mesh.polymesh import PolyMesh
from foveal.refine.depth_words import depths_json, depths_of
from foveal.refine.patch_session import PatchSession, patch_buffers
from foveal.refine.slates import Slates
from foveal.refine.slates_depth import Depths
from foveal.refine.wire import request_of
from refine.wire_page import Page, wish

AWAY = np.array([500_000.25, -4_000_000.5, 12.0])
TORUS = quad_torus(12, 8)
CREASED = PolyMesh.of(
    cube().positions, cube().corners.reshape(-1, 4), creases={(0, 1): 10, (1, 3): 10, (3, 2): 10, (2, 0): 10}
)
COLOURED = replace(
    TORUS, colours=np.random.default_rng(4).uniform(0, 255, (len(TORUS.positions), 3)).astype(np.float32)
)


def ask(session, page, **what):
    """One request, and all that follows from it."""
    session.ask(request_of(json.dumps(wish(seen=page.sequence, **what))))
    got = []
    while (sent := session.answer()) is not None:
        page.apply(sent)
        got.append(sent)
        session.ask(request_of(json.dumps(wish(seen=page.sequence, **what))))
    return got


def triangles(page, column):
    """Of each triangle its rows of a column, in the order of the slots."""
    values = np.array(column)
    return np.array([values[list(face)] for face in page.faces if face != (0, 0, 0)])


@pytest.mark.parametrize("mesh", [TORUS, CREASED], ids=["torus", "creased cube"])
def test_a_page_has_what_the_tessellation_has(mesh):
    session, page, surface = PatchSession(mesh), Page(), Slates(mesh, dtype=np.float32)
    rules = Depths(most=4, cone=math.radians(5), size_px=(1.0, 8.0))
    for angle in (0.0, 0.4, 0.41, 2.0):
        (sent,) = ask(session, page, angle=angle, depths=depths_json(rules))
        request = request_of(json.dumps(wish(angle=angle)))
        done = surface.update(request.camera, depths=rules)
        arrays = surface.arrays()
        assert page.head["triangles"] == done.triangles > 100
        assert (np.array(page.faces) == arrays.faces).all()
        assert (
            triangles(page, page.positions) == arrays.positions[arrays.faces[arrays.faces.any(axis=1)]]
        ).all()
        assert (triangles(page, page.starts) == arrays.normals[arrays.faces[arrays.faces.any(axis=1)]]).all()
        for first, count, depth in zip(arrays.first[0], arrays.counts[0], arrays.depths[0], strict=True):
            assert set(page.levels[first : first + count]) == {depth}
        assert page.head["flags"] == 7  # settled, limit, normals
        assert page.head["base"] == page.sequence - 1 or page.sequence == 1
        assert len(sent) > 0


@pytest.mark.parametrize("mesh", [TORUS, CREASED, COLOURED], ids=["torus", "creased cube", "coloured"])
def test_after_any_walk_a_page_has_the_arrays_of_the_server(mesh, monkeypatch):
    monkeypatch.setattr("foveal.refine.patch_session._MOST_ROWS", 40_000)
    rng = np.random.default_rng(11)
    session, page = PatchSession(mesh), Page()
    bases = []
    for _ in range(40):
        rules = {"most": int(rng.integers(0, 7)), "size_px": [1, float(rng.uniform(2, 30))]}
        view = {"angle": float(rng.uniform(0, 7)), "away": float(rng.uniform(1, 12))}
        if rng.random() < 0.1:
            page.sequence = 0  # it lost what it had
        ask(session, page, depths=rules, budget=int(rng.choice([0, 3_000])), **view)
        arrays = session._surface.arrays()
        for held, there in zip(page.arrays, patch_buffers(arrays, session._colours), strict=True):
            assert bytes(held) == there.tobytes()
        if mesh.colours is not None:
            written = np.unique(arrays.faces[arrays.faces.any(axis=1)])
            expected = np.rint(arrays.columns[0][written])
            assert (np.array(page.vertex_colours)[written, :3] == expected).all()
        expected = np.zeros(len(arrays.faces), np.uint8)
        for first, count, depth in zip(arrays.first[0], arrays.counts[0], arrays.depths[0], strict=True):
            expected[first : first + count] = max(depth, 0)
        assert page.levels == expected.tolist()
        assert (arrays.faces.any(axis=1).sum()) == page.head["triangles"]
        bases.append(page.head["base"])
    assert 2 <= bases.count(0) < 20


def test_colours_go_with_their_vertices():
    session, page = PatchSession(COLOURED), Page()
    for angle in (0.0, 0.3):
        ask(session, page, angle=angle)
        assert page.head["flags"] == 15
    found = np.array(page.vertex_colours)
    surface = Slates(COLOURED, dtype=np.float32)
    surface.show(0)
    corners = np.rint(surface.arrays().columns[0][surface.arrays().faces[:, 0]])
    there = {tuple(c) for c in found[:, :3].tolist()}
    assert {tuple(c) for c in corners.astype(int).tolist()} <= there
    ask(plain := PatchSession(TORUS), other := Page())
    assert not plain.has_colours
    assert other.vertex_colours == []


def test_only_what_changed_is_sent():
    session, page = PatchSession(quad_torus(40, 24)), Page()
    (whole,) = ask(session, page, away=3)
    (same,) = ask(session, page, away=3, budget=10**6)
    (little,) = ask(session, page, away=3, angle=0.01)
    assert len(same) == 40
    assert 40 < len(little) < len(whole) / 4


def test_a_place_far_from_zero_does_not_tremble():
    near, far = (
        PatchSession(TORUS),
        PatchSession(PolyMesh.of(TORUS.positions + AWAY, TORUS.corners.reshape(-1, 4))),
    )
    pages = Page(), Page()
    ask(near, pages[0])
    camera = wish()["camera"]
    for key in ("position", "target"):
        camera[key] = (np.array(camera[key]) + AWAY).tolist()
    ask(far, pages[1], camera=camera)
    assert far.origin == pytest.approx(near.origin + AWAY, rel=1e-15)
    assert pages[0].head["triangles"] == pages[1].head["triangles"]
    assert np.abs(np.array(pages[0].positions) - np.array(pages[1].positions)).max() < 1e-6


def test_the_budget_is_kept():
    session, page = PatchSession(TORUS), Page()
    ask(session, page, budget=3_000)
    assert 1_500 < page.head["triangles"] <= 3_000


def test_a_rate_is_come_to():
    now = [0.0]
    session, page = PatchSession(TORUS, clock=lambda: now[0]), Page()
    fine = depths_json(Depths(most=7, cone=None, backs=False, silhouettes=False, size_px=None))
    frames = []
    drawn = 0.0
    for i in range(40):
        ask(session, page, angle=0.01 * i, rate=25, drawn_ms=drawn, depths=fine)
        drawn = 5 + page.head["triangles"] / 10_000  # 350,000 fit into 40 ms
        frames.append(drawn)
    ending = np.array(frames[-10:])
    assert 0.8 * 40 < ending.min() <= ending.max() < 1.15 * 40
    ask(session, page, rate=0, depths=fine)
    assert page.head["triangles"] > 400_000


def test_what_was_looked_at_long_ago_is_forgotten(monkeypatch):
    monkeypatch.setattr("foveal.refine.patch_session._MOST_ROWS", 12_000)
    session, page = PatchSession(quad_torus(40, 24)), Page()
    sizes, bases = [], []
    for i in range(24):
        ask(session, page, angle=0.3 * i, away=1.6, depths={"size_px": [1, 6]})
        sizes.append(len(page.positions))
        bases.append(page.head["base"])
    assert 0 in bases[1:]
    assert max(sizes) < 4 * min(sizes)


def test_a_mesh_that_needs_more_at_once_is_sent_once(monkeypatch):
    monkeypatch.setattr("foveal.refine.patch_session._MOST_ROWS", 10)
    session, page = PatchSession(TORUS), Page()
    ask(session, page)
    assert len(page.positions) > 10
    ask(session, page, angle=0.01)
    assert (page.head["base"], page.sequence) == (1, 2)


def test_texture_coordinates_cost_nothing():
    uvs = np.random.default_rng(2).random((len(TORUS.positions), 2), np.float32)
    session, page = PatchSession(replace(COLOURED, uvs=uvs)), Page()
    ask(session, page)
    assert len(session._surface.arrays().columns) == 1
    ask(PatchSession(COLOURED), other := Page())
    assert page.arrays == other.arrays


def test_what_was_lost_is_sent_anew():
    session, page = PatchSession(TORUS), Page()
    ask(session, page)
    session.ask(request_of(json.dumps(wish(seen=0))))
    other = Page()
    other.apply(session.answer())
    assert (other.arrays, other.head["base"]) == (page.arrays, 0)


@pytest.mark.parametrize(
    "depths",
    [
        *(
            3,
            None,
            [],
            {"most": 9},
            {"most": 2.5},
            {"most": True},
            {"cone_degrees": 200},
            {"cone_degrees": "8"},
        ),
        *(
            {"cone_degrees": 0},
            {"size_px": [3]},
            {"size_px": [3, 5]},
            {"size_px": [math.nan, 5]},
            {"backs": 1},
        ),
        *(
            {"silhouettes": None},
            {"epsilon": 2},
            {"epsilon": None},
            {"size_px": "38"},
            {"size_px": [0, 1e300]},
        ),
    ],
)
def test_depths_that_are_none_are_refused(depths):
    with pytest.raises(FovealError, match="request: it is no such object"):
        request_of(json.dumps(wish(depths=depths)))


@pytest.mark.parametrize(
    "rules", [Depths(), Depths(most=0, cone=None, size_px=None), Depths(8, 0.5, False, False, 0.25, (0, 7))]
)
def test_depths_there_and_back(rules):
    back = depths_of(json.loads(json.dumps(depths_json(rules))))
    assert (back.cone or 0) == pytest.approx(rules.cone or 0, rel=1e-15)
    assert replace(back, cone=None) == replace(rules, cone=None)


def test_a_mesh_that_is_no_surface_or_too_large_is_refused():
    with pytest.raises(FovealError, match=r"box\.obj: .*too large"):
        PatchSession(PolyMesh.of(cube().positions * 1e200, cube().corners.reshape(-1, 4)), name="box.obj")
    torn = PolyMesh(cube().positions, cube().starts, cube().corners[::-1].copy() * 0)
    with pytest.raises(FovealError, match=r"^box\.obj: face 0"):
        PatchSession(torn, name="box.obj")
