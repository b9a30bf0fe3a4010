"""What a live refinement and a page tell each other, as spec/wire.md has it: requests, and slot buffers."""

import json
import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.view.camera import Camera

from ._kernels_wire import gather
from .criteria import Criteria, Region
from .depth_words import depths_of
from .slates_depth import Depths
from .slots import Placing, Slots

__all__ = [
    "MAX_REQUEST_BYTES",
    "Buffers",
    "Head",
    "Ranges",
    "Request",
    "buffers",
    "changes",
    "message",
    "request_of",
]

Words = NDArray[np.uint32]
_NO_WORDS: Words = np.zeros(0, np.uint32)
Ranges = NDArray[np.int64]
"""(r, 2): first and the one after the last, ascending, apart from each other."""

MAX_REQUEST_BYTES = 16_384

_HEADER = struct.Struct("<4sIIIIIIIff")
_MAGIC = b"FVL\x01"
_SETTLED, _LIMIT, _NORMALS, _COLOURS = 1, 2, 4, 8
_COLOUR_SHIFT = 5

#: Changes are looked for in blocks of so many words, as many as a uint64 has bytes. After 1 degree of orbit
#: at 125,000 triangles 35 KB differ; by blocks of 4, 8 and 16 words 98, 133 and 192 KB are sent, in 1,820,
#: 1,379 and 982 ranges.
_BLOCK = 8


@dataclass(frozen=True, slots=True)
class Request:
    """What a page wants, all of it.

    Attributes
    ----------
    camera : Camera
        In the control mesh's coordinates.
    criteria : Criteria
    budget : int
        Triangles at most, or 0.
    positions : "control" or "limit"
    rate : float
        Frames a second to be held, or 0.
    drawn_ms : float
        What the page took for its last frame.
    seen : int
        Sequence of the last message it applied, or 0.
    wanted : tuple of float
        All of the above but the last two, to be compared.
    depths : Depths or None
        Rules of patches, where it tells some.
    """

    camera: Camera
    criteria: Criteria
    budget: int
    positions: Placing
    rate: float
    drawn_ms: float
    seen: int
    wanted: tuple[Any, ...]
    depths: Depths | None = None


def request_of(text: str, /) -> Request:
    """Read a request.

    Raises
    ------
    FovealError
        In a sentence: too long, not JSON, a key that is missing or not what it should be.
    """
    if len(text) > MAX_REQUEST_BYTES:
        raise FovealError(f"request: it is longer than {MAX_REQUEST_BYTES} bytes.")
    try:
        data = json.loads(text)
        if not isinstance(data, dict):
            raise TypeError(f"it is a {type(data).__name__}")
        camera, criteria = _camera(data["camera"]), _criteria(data["criteria"])
        budget, rate = _number(data, "budget", 2**32), _number(data, "rate", 1e6)
        drawn, seen = _number({"drawn_ms": 0, **data}, "drawn_ms", 1e9), _number(data, "seen", 2**32)
        if data["positions"] not in ("control", "limit"):
            raise FovealError('request: "positions" must be "control" or "limit".')
        depths = depths_of(data["depths"]) if "depths" in data else None
        told = int(budget), data["positions"], rate
        wanted = (camera[1], *criteria.limits().reshape(-1).tolist(), *told, depths)
        return Request(camera[0], criteria, *told, drawn, int(seen), wanted, depths)
    except FovealError:
        raise
    except (ValueError, TypeError, KeyError, RecursionError, OverflowError) as error:
        what = f"{type(error).__name__}: {error}"
        raise FovealError(f"request: it is no such object as spec/wire.md tells ({what:.200}).") from error


def _number(data: dict[str, Any], key: str, most: float) -> float:
    value = data[key]
    if type(value) not in (int, float) or not 0 <= value <= most:
        raise FovealError(f'request: "{key}" must be a number from 0 to {most:g}, got {value!r:.40}.')
    return float(value)


def _camera(data: dict[str, Any]) -> tuple[Camera, tuple[Any, ...]]:
    camera = Camera.of(
        data["position"],
        data["target"],
        up=data["up"],
        field_of_view=float(data["fov"]),
        width=data["width"],
        height=data["height"],
        near=float(data["near"]),
        far=float(data["far"]),
    )
    triples = (*camera.position.tolist(), *camera.target.tolist(), *camera.up.tolist())
    return camera, (*triples, camera.field_of_view, camera.width, camera.height, camera.near, camera.far)


def _criteria(data: dict[str, Any]) -> Criteria:
    regions = []
    for name in ("front", "silhouette", "back"):
        iterations = _number(data[name], "iterations", 30)
        if iterations != int(iterations):
            raise FovealError('request: "iterations" must be a whole number.')
        edge_px, bend = _number(data[name], "edge_px", 1e9), _number(data[name], "bend", math.pi)
        regions.append(Region(int(iterations), edge_px, bend))
    return Criteria(*regions)


class Buffers(NamedTuple):
    """The arrays of a message, each as (n,) uint32 words.

    Normals may be in place of starts; colours are one word a vertex, or none at all.
    """

    faces: Words
    positions: Words
    starts: Words
    tags: Words
    colours: Words = _NO_WORDS

    @classmethod
    def empty(cls) -> "Buffers":
        """Of no slots."""
        return cls(*(_NO_WORDS,) * 4)

    def grown(self, other: "Buffers", /) -> "Buffers":
        """The same with zeros behind, as long as those of `other`."""
        longer = zip(self, other, strict=True)
        return Buffers._make(
            a if len(a) == len(b) else np.append(a, np.zeros(len(b) - len(a), np.uint32)) for a, b in longer
        )  # mostly none has grown, and to copy 250,000 triangles takes 8 ms


def buffers(slots: Slots, origin: NDArray[np.float64], /) -> Buffers:
    """What a page is to have, of copies."""
    tags = np.zeros(-(-len(slots.faces) // 4) * 4, np.uint8)
    np.left_shift(slots.colours, _COLOUR_SHIFT, out=tags[: len(slots.faces)])
    tags[: len(slots.faces)] |= slots.levels
    positions, starts = (
        np.subtract(places, origin).astype("<f4").reshape(-1).view(np.uint32)
        for places in (slots.positions, slots.starts)
    )
    faces = slots.faces.astype("<i4").reshape(-1).view(np.uint32)
    return Buffers(faces, positions, starts, tags.view(np.uint32))


class Head(NamedTuple):
    """What a message tells beside the slots."""

    sequence: int
    base: int
    is_settled: bool
    is_limit: bool
    triangles: int
    milliseconds: float
    threshold: float
    has_normals: bool = False
    has_colours: bool = False

    @property
    def flags(self) -> int:
        """As they are on the wire."""
        told = _SETTLED * self.is_settled | _LIMIT * self.is_limit
        return told | _NORMALS * self.has_normals | _COLOURS * self.has_colours


def message(head: Head, new: Buffers, ranges: Sequence[Ranges], /) -> bytes:
    """A message that brings a page to `new`, from what differs in these ranges of words of each array."""
    found = [_gathered(words, bounds) for words, bounds in zip(new, ranges, strict=True)]
    table = np.concatenate(
        [
            np.column_stack([np.full(len(bounds), number), 4 * bounds[:, 0], 4 * np.diff(bounds)[:, 0]])
            for number, bounds in enumerate(ranges)
        ]
    ).astype("<u4")
    header = _HEADER.pack(
        _MAGIC,
        head.sequence,
        head.base,
        head.flags,
        len(new.faces) // 3,
        len(new.positions) // 3,
        head.triangles,
        len(table),
        head.milliseconds,
        head.threshold,
    )
    return b"".join([header, table.tobytes(), *(words.tobytes() for words in found)])


def _gathered(words: Words, ranges: Ranges) -> Words:
    found = np.empty(np.diff(ranges).sum(), np.uint32)
    gather(words, ranges, found)
    return found.astype("<u4", copy=False)


def changes(new: Buffers, old: Buffers, /) -> list[Ranges]:
    """Where `new` differs from `old`, which may be shorter; zeros are there then."""
    return [_differences(words, was) for words, was in zip(new, old.grown(new), strict=True)]


def _differences(words: Words, was: Words) -> Ranges:
    """(r, 2): begins and ends of what differs: whole blocks, a lone equal one between them kept in."""
    is_changed = np.zeros((-(-len(words) // _BLOCK), _BLOCK), np.bool_)
    np.not_equal(words, was, out=is_changed.reshape(-1)[: len(words)])
    is_sent = np.concatenate([[False], is_changed.view(np.uint64)[:, 0] != 0, [False]])
    is_sent[1:-1] |= is_sent[:-2] & is_sent[2:]
    edges = np.flatnonzero(np.diff(is_sent))
    bounds: Ranges = np.minimum(_BLOCK * edges.reshape(-1, 2), len(words))
    return bounds
