"""Streams of trees under construction: room for them, their parts put together, what is read from them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foveal.base.tasks import Executor, ordered_map

from . import _kernels_pixels as pixels
from . import _kernels_stream as stream
from ._kernels_sets import KEPT
from .tree import Tree

__all__ = ["AHEAD", "Part", "clear", "empty_up", "joined", "part_of"]

AHEAD = 8
"""Parts under way at once."""


@dataclass(frozen=True, slots=True)
class Part:
    """The stream of a square (see `_kernels_stream`): its nodes, and their intervals."""

    codes: NDArray[np.uint8]
    bounds: NDArray[np.uint32]


def empty_up(codes: int, /, *, levels: int, children: int) -> stream.Up:
    """Room for a stream of so many nodes."""
    bounds = 2 * codes + stream.PUSH_BOUNDS
    ends = 2 * children * KEPT
    return stream.Up(
        codes=np.empty(codes, np.uint8),
        bounds=np.empty(bounds, np.uint32),
        at=np.zeros(2, np.int64),
        filled=np.zeros(levels + 1, np.int64),
        all_leaves=np.zeros(levels + 1, bool),
        begun=np.zeros((levels + 1, 2), np.int64),
        counts=np.zeros((levels + 1, children), np.int64),
        low=np.zeros((levels + 1, children, KEPT), np.int64),
        high=np.zeros((levels + 1, children, KEPT), np.int64),
        ends=np.zeros(ends, np.int64),
        steps=np.zeros(ends, np.int64),
        set_low=np.zeros(KEPT, np.int64),
        set_high=np.zeros(KEPT, np.int64),
    )


def clear(up: stream.Up, /) -> None:
    """Begin a stream anew."""
    up.at[:] = 0
    up.filled[:] = 0


def part_of(up: stream.Up, /) -> Part:
    """What was written, copied."""
    codes, bounds = up.at
    return Part(up.codes[:codes].copy(), up.bounds[:bounds].copy())


def joined(
    parts: list[Part], levels: int, top: int, /, *, children: int, most: int, executor: Executor
) -> Tree:
    """The tree of the squares (or cubes) that a map is divided in `top` times, in the order of the tree."""
    counts = np.array([part.codes[-1] & stream.COUNT for part in parts], np.int64)
    is_inner = np.array([part.codes[-1] & stream.IS_INNER != 0 for part in parts])
    bounds = np.zeros((len(parts), KEPT, 2), np.int64)
    for root, part, count in zip(bounds, parts, counts, strict=True):
        root[:count] = part.bounds[len(part.bounds) - 2 * count :].reshape(-1, 2)
    up = empty_up(2 * len(parts) + 100, levels=top, children=children)
    while not pixels.up_from_roots(up, counts, bounds, is_inner, top, most):
        up = empty_up(2 * len(up.codes), levels=top, children=children)
    above = part_of(up)
    head = _read(above, -1, top, children)
    inner = [part for part, has_more in zip(parts, is_inner, strict=True) if has_more]
    below = levels - top

    def read(task: tuple[Part, int]) -> "_Lists":
        return _read(task[0], task[1], below, children)

    tasks = zip(inner, head.elsewhere.tolist(), strict=True)
    tails = list(ordered_map(executor, read, tasks, ahead=AHEAD))
    # The root of a square is in the head; its mask, of the level where head and tails meet, in its own list.
    masks = [*head.masks[:top], *(_level(tails, "masks", level) for level in range(below))]
    values = [*head.values, *(_level(tails, "values", level) for level in range(1, below + 1))]
    return Tree(
        levels=levels,
        children=children,
        root=head.root,
        masks=np.concatenate([*masks, np.empty(0, np.uint16)]),
        mask_starts=np.cumsum([0, *map(len, masks)]),
        values=np.concatenate(values),
        value_starts=np.cumsum([0, *map(len, values)]),
    )


@dataclass(frozen=True, slots=True)
class _Lists:
    """Masks and values of a part, by level, and what holds where it goes on elsewhere."""

    root: int
    masks: list[NDArray[np.uint16]]
    values: list[NDArray[np.uint32]]
    elsewhere: NDArray[np.int64]


def _level(lists: list[_Lists], name: str, level: int) -> NDArray[np.uint16] | NDArray[np.uint32]:
    kind = np.uint16 if name == "masks" else np.uint32
    return np.concatenate([np.empty(0, kind), *(getattr(part, name)[level] for part in lists)])


def _read(part: Part, inherited: int, levels: int, children: int) -> _Lists:
    nodes, inner = np.zeros(levels + 1, np.int64), np.zeros(levels + 1, np.int64)
    stream.survey(part.codes, children, np.zeros(levels + 1, np.int64), nodes, inner)
    mask_starts, value_starts = np.cumsum([0, *inner]), np.cumsum([0, *nodes])
    begin = np.zeros(levels + 1, np.int64)
    begin[0] = inherited
    down = stream.Down(
        inherited=begin,
        child=np.zeros(levels + 1, np.int64),
        parent=np.zeros(levels + 1, np.int64),
        mask_at=mask_starts[:-1].copy(),
        value_at=value_starts[:-1].copy(),
        masks=np.empty(mask_starts[-1], np.uint16),
        values=np.empty(value_starts[-1], np.uint32),
        elsewhere=np.empty(int(nodes[-1]), np.int64),
        elsewhere_at=np.zeros(1, np.int64),
    )
    root = stream.descend(down, part.codes, part.bounds, children)
    return _Lists(
        root,
        [down.masks[a:b].copy() for a, b in zip(mask_starts, down.mask_at, strict=False)],
        [down.values[a:b].copy() for a, b in zip(value_starts, down.value_at, strict=False)],
        down.elsewhere[: down.elsewhere_at[0]],
    )
