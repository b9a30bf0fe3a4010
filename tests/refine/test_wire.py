"""What goes over the wire: golden messages, a page in plain Python, requests that make no sense."""

import json
import math
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal import FovealError
from foveal.refine.slots import Slots
from foveal.refine.wire import MAX_REQUEST_BYTES, Buffers, Head, buffers, changes, message, request_of
from refine import golden_wire
from refine.wire_page import Page, Refused, parse, wish

GOLDEN = json.loads((golden_wire.FOLDER / "wire.json").read_text())
PLAIN = Head(1, 0, True, False, 0, 0.0, 1.0)


def test_the_golden_session_is_what_is_written():
    for case, sent in zip(GOLDEN["messages"], golden_wire.messages(), strict=True):
        assert (golden_wire.FOLDER / case["file"]).read_bytes() == sent


def test_the_golden_session_is_what_a_page_makes_of_it():
    page = Page()
    whole = zip(GOLDEN["messages"], golden_wire.session(), golden_wire.vertex_colours(), strict=True)
    for case, slots, colours in whole:
        page.apply((golden_wire.FOLDER / case["file"]).read_bytes())
        assert page.head == case["head"]
        np.testing.assert_array_equal(page.faces, slots.faces)
        np.testing.assert_array_equal(page.positions, np.float32(slots.positions - golden_wire.ORIGIN))
        np.testing.assert_array_equal(page.starts, np.float32(slots.starts - golden_wire.ORIGIN))
        assert (page.levels, page.colours) == (slots.levels.tolist(), slots.colours.tolist())
        assert bytes(page.arrays[4]) == colours.astype("<u4").tobytes()
        assert page.vertex_colours == [tuple(c) for c in case.get("vertex_colours", [])]
        for name in ("faces", "positions", "starts"):
            np.testing.assert_array_equal(getattr(page, name), case[name])


def test_the_golden_session_has_what_can_be_got_wrong():
    heads = [case["head"] for case in GOLDEN["messages"]]
    assert [head["base"] for head in heads] == [0, 1, 2, 0, 0, 0, 6]
    assert heads[0]["faces"] < heads[1]["faces"]  # arrays grow
    assert heads[1]["ranges"] > 4  # more than one range in an array
    assert heads[2]["ranges"] == 0
    assert heads[3]["is_limit"]
    assert [head["flags"] >> 2 for head in heads] == [0, 0, 0, 0, 1, 3, 3]  # normals, colours
    assert 0 < heads[6]["ranges"] < 4  # colours change alone
    assert heads[1]["faces"] % 4  # tags have a tail


def test_the_golden_request_is_read():
    request = request_of(json.dumps(GOLDEN["request"]))
    assert (request.seen, request.budget, request.rate, request.drawn_ms) == (1, 1000, 60, 3.5)
    assert request.positions == "limit"
    assert request.camera.field_of_view == 0.7


words = st.lists(st.integers(0, 2), max_size=200)


@given(words, words)
def test_ranges_bring_a_page_from_anything_to_anything(old, new):
    old = (old + [0] * 201)[: 3 * (min(len(old), len(new)) // 3)]
    new = new[: 3 * (len(new) // 3)]
    before, after = (_buffers(values) for values in (old, new))
    page = Page()
    page.apply(message(PLAIN, before, changes(before, Buffers.empty())))
    page.apply(message(PLAIN._replace(sequence=2, base=1), after, changes(after, before)))
    assert page.faces == [tuple(new[i : i + 3]) for i in range(0, len(new), 3)]


def _buffers(faces):
    zeros = np.zeros((1, 3))
    tags = np.zeros(len(faces) // 3, np.uint8)
    return buffers(Slots(np.array(faces, np.int32).reshape(-1, 3), zeros, zeros, tags, tags), np.zeros(3))


def test_what_did_not_change_is_not_sent():
    rng = np.random.default_rng(3)
    slots = golden_wire.slots(rng, 10_000, 5_000, 0)
    before = buffers(slots, golden_wire.ORIGIN)
    slots.positions[[17, 4_000]] += 1
    after = buffers(slots, golden_wire.ORIGIN)
    sent = message(PLAIN._replace(base=1, sequence=2), after, changes(after, before))
    _, ranges = parse(sent)
    assert [number for number, _, _ in ranges] == [1, 1]
    assert len(sent) <= 40 + 2 * (12 + 128)


def test_a_message_holds_copies():
    slots = golden_wire.session()[0]
    held = buffers(slots, golden_wire.ORIGIN)
    kept = [words.copy() for words in held]
    slots.faces[:], slots.positions[:], slots.starts[:] = 1, 7.0, 7.0
    assert all((a == b).all() for a, b in zip(held, kept, strict=True))


@pytest.mark.parametrize("name", ["wire_0.bin", "wire_3.bin", "wire_5.bin"])
def test_the_page_refuses_every_prefix(name):
    whole = (golden_wire.FOLDER / name).read_bytes()
    for length in range(len(whole)):
        with pytest.raises((Refused, struct.error)):
            Page().apply(whole[:length])


def changed(**values):
    def edit(data):
        for path, value in values.items():
            *way, last = path.split("__")
            inner = data
            for key in way:
                inner = inner[key]
            inner[last] = value
        return data

    return edit


def without(*way):
    def edit(data):
        inner = data
        for key in way[:-1]:
            inner = inner[key]
        del inner[way[-1]]
        return data

    return edit


@pytest.mark.parametrize(
    "edit",
    [
        without("camera"),
        without("camera", "up"),
        without("criteria", "back"),
        without("criteria", "front", "bend"),
        without("seen"),
        changed(camera=None),
        changed(camera=[1, 2]),
        changed(camera__position=[1, 2]),
        changed(camera__position=[1, 2, "3"]),
        changed(camera__position=[0, 0, 0]),  # where it looks
        changed(camera__up=[0, 0, 0]),
        changed(camera__position=[math.nan, 0, 0]),
        changed(camera__position=[1e200, 0, 0]),
        changed(camera__fov=0),
        changed(camera__fov=4),
        changed(camera__fov="wide"),
        changed(camera__width=0),
        changed(camera__width=1.5),
        changed(camera__height=10**9),
        changed(camera__near=0),
        changed(camera__far=math.nan),
        changed(criteria__front__iterations=31),
        changed(criteria__front__iterations=1.5),
        changed(criteria__front__iterations=True),
        changed(criteria__front__iterations="4"),
        changed(criteria__back__edge_px=-1),
        changed(criteria__back__edge_px=math.inf),
        changed(criteria__silhouette__bend=3.2),
        changed(criteria__silhouette=7),
        changed(budget=-1),
        changed(budget=None),
        changed(budget=2**40),
        changed(rate=-1),
        changed(rate=math.inf),
        changed(positions="best"),
        changed(positions=["control"]),
        changed(seen=-1),
        changed(seen=[]),
        changed(drawn_ms=-1),
    ],
)
def test_a_request_that_makes_no_sense_gets_a_sentence(edit):
    with pytest.raises(FovealError, match=r"^(request|camera): .*\.$"):
        request_of(json.dumps(edit(wish())))


@pytest.mark.parametrize(
    "text",
    ["", "{", "null", "[]", "3", '"camera"', "[" * 9000, "{}", "\0", "9" * 5000, '{"camera": NaN}'],
)
def test_what_is_no_request_gets_a_sentence(text):
    with pytest.raises(FovealError, match=r"^request: .*\.$"):
        request_of(text)


def test_a_request_may_be_so_long_and_no_longer():
    text = json.dumps(wish())
    request_of(text + " " * (MAX_REQUEST_BYTES - len(text)))
    with pytest.raises(FovealError, match="longer"):
        request_of(text + " " * (MAX_REQUEST_BYTES + 1 - len(text)))


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(),
        lambda c: st.lists(c) | st.dictionaries(st.text(), c),
    )
)
def test_any_json_is_read_or_refused(data):
    with pytest.raises(FovealError):
        request_of(json.dumps(data))


def test_wanted_tells_requests_apart_but_not_acknowledgements():
    same = request_of(json.dumps(wish(seen=3, drawn_ms=9)))
    assert same.wanted == request_of(json.dumps(wish())).wanted
    for other in (
        wish(angle=1e-9),
        wish(edge_px=4.5),
        wish(budget=1),
        wish(rate=1),
        wish(positions="limit"),
        changed(camera__near=0.02)(wish()),
    ):
        assert same.wanted != request_of(json.dumps(other)).wanted
