"""A live refinement: what a page has is what was asked for, however the messages came about."""

import json
import math

import numpy as np
import pytest

from foveal import FovealError
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, tetrahedron
from foveal.mesh.trimesh import TriMesh
from foveal.refine.pace import coarser
from foveal.refine.scheme import refiner
from foveal.refine.session import MOST_TRIANGLES, Session, origin_of
from foveal.refine.wire import request_of
from refine.test_sharp import across, cube
from refine.wire_page import Page, wish

BALL = bumpy_sphere(2)


def ask(session, page, **what):
    """Ask and take in what comes, if anything; whether something did."""
    session.ask(request_of(json.dumps(wish(seen=page.sequence, **what))))
    sent = session.answer()
    if sent is not None:
        page.apply(sent)
    return sent is not None


def settle(session, page, **what):
    """Ask until it is settled; how many messages that took."""
    for count in range(1, 200):
        assert ask(session, page, **what)
        if page.head["is_settled"]:
            assert not ask(session, page, **what)
            return count
    raise AssertionError("it does not settle")


def shown(page):
    """The set of triangles that a page draws, by the bits of their corners."""
    points = np.array(page.positions, "<f4")
    faces = np.array(page.faces)
    corners = points[faces[(faces != 0).any(axis=1)]]
    return {min(c[k:].tobytes() + c[:k].tobytes() for k in range(3)) for c in corners}


def fresh(mesh, step=0, positions="control", scheme="sqrt3", sharp=None, **what):
    """The same by a refinement that never saw anything else."""
    request = request_of(json.dumps(wish(**what)))
    refined = refiner(mesh, scheme=scheme, sharp=sharp)
    refined.update(request.camera, criteria=coarser(request.criteria, step))
    found = refined.mesh(positions=positions)
    points = np.float32(found.positions - origin_of(mesh))
    return {min(c[k:].tobytes() + c[:k].tobytes() for k in range(3)) for c in points[found.faces]}


@pytest.mark.parametrize("scheme", ["sqrt3", "loop", "butterfly"])
@pytest.mark.parametrize("mesh", [BALL, terrain(8), tetrahedron()], ids=["closed", "open", "few"])
def test_a_page_has_what_a_fresh_refinement_has(mesh, scheme):
    session, page = Session(mesh, scheme=scheme), Page()
    rng = np.random.default_rng(5)
    for _ in range(12):
        view = {"angle": float(rng.uniform(0, 7)), "away": float(rng.uniform(1.5, 6)), "iterations": 3}
        settle(session, page, **view)
        assert shown(page) == fresh(mesh, scheme=scheme, **view)
        assert page.head["triangles"] == len(shown(page))
        assert page.head["threshold"] == 1


def test_positions_in_the_limit():
    session, page = Session(BALL), Page()
    settle(session, page)
    before = shown(page)
    settle(session, page, positions="limit")
    assert page.head["is_limit"]
    assert shown(page) == fresh(BALL, positions="limit") != before
    settle(session, page)
    assert shown(page) == before


def test_starts_are_where_vertices_were_born():
    session, page = Session(BALL), Page()
    settle(session, page, iterations=0)
    settle(session, page, iterations=1, edge_px=0)
    starts, corners = np.array(page.starts), np.float32(BALL.positions - origin_of(BALL))
    born = starts[len(corners) :]
    near = np.float32(BALL.positions[BALL.faces].mean(axis=1) - origin_of(BALL))
    assert len(born) > 20
    np.testing.assert_array_equal(starts[: len(corners)], corners)
    distance = np.abs(near[None] - born[:, None]).max(axis=2).min(axis=1)
    assert distance.max() < 1e-6


def test_far_from_zero_nothing_is_lost():
    shift = np.array([5e5, -4e6, 100])
    far = TriMesh(BALL.positions + shift, BALL.faces)
    session, page = Session(far), Page()
    request = wish(iterations=2)
    for key in ("position", "target"):
        request["camera"][key] = (shift + request["camera"][key]).tolist()
    session.ask(request_of(json.dumps(request)))
    page.apply(session.answer())
    near = Page()
    ask(Session(BALL), near, iterations=2)
    assert page.faces == near.faces
    np.testing.assert_allclose(page.positions, near.positions, atol=1e-6)


def test_nothing_is_said_unasked():
    session, page = Session(BALL), Page()
    assert session.answer() is None
    settle(session, page)
    assert session.answer() is None
    assert not ask(session, page, drawn_ms=12)  # an acknowledgement asks for nothing


def test_a_changed_request_is_answered_though_nothing_changed():
    session, page = Session(BALL), Page()
    settle(session, page, iterations=0)
    assert ask(session, page, iterations=0, angle=0.1)
    assert page.head["ranges"] == 0


def test_one_message_is_on_its_way_and_the_newest_request_is_answered():
    session, page = Session(BALL), Page()
    request = lambda seen, angle: request_of(json.dumps(wish(seen=seen, angle=angle)))  # noqa: E731
    session.ask(request(0, 0))
    page.apply(session.answer())
    for i in range(50):  # a page that moves on and does not acknowledge
        session.ask(request(0, 0.1 * i))
        assert session.answer() is None
    session.ask(request(1, 0.3))
    session.ask(request(1, 0.5))
    page.apply(session.answer())
    assert session.answer() is None
    while not page.head["is_settled"]:
        ask(session, page, angle=0.5)
    assert shown(page) == fresh(BALL, angle=0.5)
    assert page.sequence < 5


def test_a_gap_has_all_sent_anew():
    session, page = Session(BALL), Page()
    settle(session, page)
    lost = Page()
    assert ask(session, lost)  # settled, nothing changed: and yet all of it
    assert lost.head["base"] == 0
    assert shown(lost) == shown(page)
    settle(session, lost, angle=1)
    late = Page()
    session.ask(request_of(json.dumps(wish(seen=lost.sequence, angle=2))))
    session.answer()  # with a base: it is lost on its way
    assert ask(session, late, angle=2)
    assert late.head["base"] == 0
    settle(session, late, angle=2.5)
    assert shown(late) == fresh(BALL, angle=2.5)


def test_what_was_not_sent_cannot_have_been_seen():
    session = Session(BALL)
    with pytest.raises(FovealError, match="not sent"):
        session.ask(request_of(json.dumps(wish(seen=1))))


@pytest.mark.parametrize("make", [cube, across])
def test_sharp_edges_are_in_a_session_too(make):
    mesh, sharp = make()
    session, page = Session(mesh, sharp=sharp), Page()
    for angle in (0.0, 2.0, 0.3):
        settle(session, page, angle=angle)
    assert shown(page) == fresh(mesh, angle=0.3, sharp=sharp)
    assert shown(page) != fresh(mesh, angle=0.3)
    with pytest.raises(FovealError, match=r"^cube\.fov: it has sharp edges, which loop does not know"):
        Session(mesh, scheme="loop", sharp=sharp, name="cube.fov")


def test_what_is_no_surface_is_refused():
    two = TriMesh.of(np.eye(3), [[0, 1, 2], [0, 1, 2]])
    with pytest.raises(FovealError, match=r"^two\.obj: .*face opposite"):
        Session(two, name="two.obj")
    huge = TriMesh(icosphere(0).positions * 1e300, icosphere(0).faces)
    with pytest.raises(FovealError, match="too large"):
        Session(huge)


@pytest.mark.parametrize("budget", [100, 1_000, 3_000, 10_000])
def test_a_budget_is_kept_in_every_message_and_used(budget):
    session, page = Session(BALL), Page()
    view = {"edge_px": 1.5, "iterations": 6, "budget": budget}
    for angle in np.linspace(0, 1, 12):
        ask(session, page, angle=float(angle), **view)
        assert page.head["triangles"] <= max(budget, len(BALL.faces))
    settle(session, page, angle=1.0, **view)
    assert page.head["triangles"] <= max(budget, len(BALL.faces))
    step = round(8 * math.log2(page.head["threshold"]))
    assert step == 0 or len(fresh(BALL, step=step - 1, angle=1.0, edge_px=1.5, iterations=6)) > budget


def test_the_mesh_in_a_budget_does_not_depend_on_the_way_there():
    view = {"edge_px": 1.5, "iterations": 6, "budget": 3_000}
    session, page = Session(BALL), Page()
    for angle in (3.0, 0.1, 0.4):
        settle(session, page, angle=angle, **view)
    settle(session, page, angle=0.4, edge_px=1.5, iterations=6)  # without, and again with
    settle(session, page, angle=0.4, **view)
    other, there = Session(BALL), Page()
    settle(other, there, angle=0.4, **view)
    assert shown(page) == shown(there)


def test_no_edge_px_is_kept_to_a_budget_too():
    session, page = Session(BALL), Page()
    settle(session, page, edge_px=0, iterations=9, budget=20_000)  # 320 * 3^9 would be six million
    assert 10_000 < page.head["triangles"] <= 20_000
    assert page.head["threshold"] > 1


def test_more_than_the_servers_own_limit_is_not_refined(monkeypatch):
    monkeypatch.setattr("foveal.refine.session.MOST_TRIANGLES", 30_000)
    session, page = Session(BALL), Page()
    settle(session, page, edge_px=0, iterations=30)
    assert page.head["triangles"] <= 30_000 < MOST_TRIANGLES


class Clock:
    """Time that passes by what is drawn: each update so long for a triangle, and each look a little."""

    def __init__(self, session_of, ms_per_triangle, fixed_ms):
        self.now = 0.0
        self.session = session_of(self)
        self.update = self.session._refined.update
        self.session._refined.update = self.timed
        self.ms_per_triangle, self.fixed_ms, self.noise = ms_per_triangle, fixed_ms, 1.0

    def timed(self, camera, **options):
        done = self.update(camera, **options)
        self.now += 0.001 * self.noise * (self.fixed_ms + self.ms_per_triangle * done.faces)
        return done

    def __call__(self):
        return self.now


@pytest.mark.parametrize(("per_triangle", "fixed"), [(0.01, 0.0), (0.002, 4.0), (0.05, 1.0)])
@pytest.mark.parametrize("noise", [0.0, 0.2])
def test_a_rate_is_held_without_swinging(per_triangle, fixed, noise):
    rng = np.random.default_rng(7)
    clock = Clock(lambda clock: Session(BALL, clock=clock), per_triangle, fixed)
    session, page, rate = clock.session, Page(), 30
    costs, thresholds = [], []
    for i in range(80):
        clock.noise = rng.uniform(1 - noise, 1 + noise)
        begin = clock.now
        ask(session, page, angle=0.002 * i, edge_px=1, iterations=7, rate=rate)
        costs.append(1000 * (clock.now - begin))
        thresholds.append(page.head["threshold"])
    ending = np.array(thresholds[-40:])
    assert np.median(costs[-40:]) <= 1.05 * 1000 / rate
    assert np.median(costs[-40:]) >= 0.4 * 1000 / rate or ending[-1] == 1
    assert ending.max() / ending.min() <= 2 ** (2 / 8)  # two steps, for the noise and the turning view
    turns = np.diff(np.sign(np.diff(ending)[np.diff(ending) != 0]))
    assert np.count_nonzero(turns) <= 4


def test_what_the_page_takes_to_draw_counts():
    clock = Clock(lambda clock: Session(BALL, clock=clock), 0.001, 0.0)
    session, page = clock.session, Page()
    for i in range(40):
        drawn = 0.02 * page.head.get("triangles", 0)  # a slow device
        ask(session, page, angle=0.002 * i, edge_px=1, iterations=7, rate=30, drawn_ms=drawn)
    assert 400 < page.head["triangles"] <= 1000 / 30 / 0.021 * 1.2
    before = page.head["triangles"]
    for i in range(40):
        ask(session, page, angle=0.08 + 0.002 * i, edge_px=1, iterations=7, rate=0, drawn_ms=0)
    assert page.head["triangles"] > 2 * before  # no rate wanted any more


def test_a_long_refinement_comes_in_slices_and_ends_the_same():
    clock = Clock(lambda clock: Session(BALL, clock=clock), 0.01, 0.0)
    view = {"edge_px": 1, "iterations": 7}
    page = Page()
    assert settle(clock.session, page, **view) > 1
    assert shown(page) == fresh(BALL, **view)
