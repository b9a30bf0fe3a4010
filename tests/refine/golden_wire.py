"""Writes `spec/golden/wire.json` and `wire_*.bin`, a session that pytest and vitest both read.

    PYTHONPATH=tests python -m refine.golden_wire

The slots are made up, so that nothing but the wire itself can change them.
"""

import json
from pathlib import Path

import numpy as np

from foveal.refine.slots import Slots
from foveal.refine.wire import Buffers, Head, buffers, changes, message
from refine.wire_page import Page, wish

FOLDER = Path(__file__).parents[2] / "spec" / "golden"
ORIGIN = np.array([500_000.25, -4_000_000.5, 12.0])
HEADS = [
    Head(1, 0, False, False, 38, 1.5, 2.0),
    Head(2, 1, False, False, 51, 0.25, 1.0905077),
    Head(3, 2, True, False, 51, 0.125, 1.0),
    Head(4, 0, True, True, 51, 12.0, 1.0),
    Head(5, 0, True, True, 51, 0.5, 1.0, has_normals=True),
    Head(6, 0, False, True, 51, 0.5, 1.0, has_normals=True, has_colours=True),
    Head(7, 6, True, True, 51, 0.5, 1.0, has_normals=True, has_colours=True),
]


def slots(rng: np.random.Generator, faces: int, vertices: int, free: int) -> Slots:
    """Any slots, the last `free` faces free."""
    corners = rng.integers(1, vertices, (faces, 3), dtype=np.int32)
    levels = rng.integers(0, 31, faces).astype(np.uint8)
    colours = rng.integers(0, 3, faces).astype(np.uint8)
    corners[faces - free :], levels[faces - free :], colours[faces - free :] = 0, 0, 0
    positions, starts = (ORIGIN + rng.integers(-99, 99, (vertices, 3)) / 8 for _ in range(2))
    return Slots(corners, positions, starts, levels, colours)


def session() -> list[Slots]:
    """What the page is to have after each message but for colours.

    All, some and more, nothing, all anew, with normals, with colours, with some of other colours.
    """
    rng = np.random.default_rng(20)
    first = slots(rng, 41, 27, 3)
    second = slots(rng, 53, 70, 2)
    for new, old in zip(second, first, strict=True):
        new[: len(old)] = old
    second.faces[38:41] = rng.integers(1, 70, (3, 3))
    second.positions[7] += 0.125
    second.positions[12], second.starts[12] = ORIGIN + 3, ORIGIN + 2.5
    moved = second._replace(positions=second.positions + 0.5)
    normals = ORIGIN + np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]])[np.arange(70) % 3]
    return [first, second, second, moved, *[moved._replace(starts=normals)] * 3]


def vertex_colours() -> list[np.ndarray]:
    """The same of the colours: one word a vertex, or none."""
    none = np.zeros(0, np.uint32)
    values = np.arange(70, dtype=np.uint32)
    words = 255 << 24 | values << 16 | (3 * values) << 8 | (255 - values)
    other = words.copy()
    other[[3, 40, 41]] = 0xFF0102FE
    return [*[none] * 5, words, other]


def messages() -> list[bytes]:
    """The session's messages."""
    found, sent = [], Buffers.empty()
    for head, there, colours in zip(HEADS, session(), vertex_colours(), strict=True):
        new = buffers(there, ORIGIN)._replace(colours=colours)
        found.append(message(head, new, changes(new, sent if head.base else Buffers.empty())))
        sent = new
    return found


def main() -> None:
    """Write them, with what a page makes of them."""
    page, cases = Page(), []
    for number, sent in enumerate(messages()):
        (FOLDER / f"wire_{number}.bin").write_bytes(sent)
        page.apply(sent)
        case = {name: getattr(page, name) for name in ("faces", "positions", "starts", "levels", "colours")}
        coloured = {"vertex_colours": page.vertex_colours} if page.vertex_colours else {}
        cases.append({"file": f"wire_{number}.bin", "head": page.head, **case, **coloured})
    data = {"request": wish(seen=1, budget=1000, rate=60, positions="limit", drawn_ms=3.5), "messages": cases}
    (FOLDER / "wire.json").write_text(json.dumps(data, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
