"""Statistics of patches, made into tables."""

from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.coding import rans

from . import _kernels_layout as layout
from . import _kernels_train
from .encode import coarse_grid, events
from .grown import Grown, grow
from .patch import Patch
from .tables import Tables

__all__ = ["train"]

#: First and last context, and how many tables they may share.
_POOLS = (
    (layout.ALONG_AT, layout.ACROSS_AT, 12),
    (layout.ACROSS_AT, layout.COLOUR_AT, 8),
    (layout.COLOUR_AT, layout.NORMAL_AT, 8),
    (layout.NORMAL_AT, layout.COARSE_AT, 8),
    (layout.COARSE_AT, layout.CONTEXTS, 2),
)
_CODE_TABLES = 16
_ROUNDS = 12  # of clustering; it settles in fewer
_ENOUGH = 1 << 18  # triangles
_MANY = 16  # patches of which some can be left out and all levels still be there
_PRIOR = 0.01  # how strongly weights lean to the plain parallelogram b - o


def train(patches: Iterable[Patch], /, *, normal_bits: int = 10, executor: Executor | None = None) -> Tables:
    """Tables for a file that holds `patches`, or patches like them.

    Give patches of all levels; of more than a quarter of a million triangles only a part is looked at,
    which costs about 0.3 % in size. Any patch can be coded with any tables; with those of other
    patches it is only longer. The tables are the same with an executor, which works on several patches
    at once, as without.
    """
    spread: Callable[..., Iterable[Any]] = map if executor is None else executor.map
    sample = _sample(list(patches))
    pairs = list(zip(sample, spread(grow, sample), strict=True))
    weights = _train_weights(pairs, spread)
    blank = Tables(normal_bits, weights, *_no_contexts(), np.zeros((1, layout.SYMBOLS), np.int32))
    counts = np.zeros((layout.CONTEXTS, layout.SYMBOLS), np.int64)
    shift_of = np.zeros(layout.CONTEXTS, np.uint8)

    def events_of(pair: tuple[Patch, Grown]) -> Any:
        return events(*pair, coarse_grid(pair[0]), blank.all_weights, normal_bits)

    coded = list(spread(events_of, pairs))
    sums = np.zeros((layout.CONTEXTS, 2), np.int64)
    for contexts, values in coded:
        _kernels_train.magnitudes(contexts, values, sums)
    _choose_shifts(sums, shift_of)
    for contexts, values in coded:
        _kernels_train.count_values(contexts, values, shift_of, counts)
    for _, grown in pairs:
        _kernels_train.count_codes(grown.codes, grown.code_contexts, grown.extra, counts)
    return _make_tables(normal_bits, weights, counts, shift_of)


def _sample(patches: list[Patch]) -> list[Patch]:
    """Every k-th patch, or of few the first k-th of each, such that _ENOUGH triangles are left."""
    every = -(-sum(len(patch.faces) for patch in patches) // _ENOUGH)
    if every <= 1:
        return patches
    if len(patches) >= _MANY * every:
        return patches[::every]
    return [_beginning(patch, len(patch.faces) // every) for patch in patches]


def _beginning(patch: Patch, triangles: int) -> Patch:
    """The first triangles of a patch, and the vertices they use."""
    faces = patch.faces[:triangles]
    is_used = np.zeros(len(patch.positions), np.bool_)
    is_used[faces] = True
    index = np.cumsum(is_used, dtype=np.int32) - 1
    return Patch(
        patch.positions[is_used],
        index[faces],
        None if patch.normals is None else patch.normals[is_used],
        None if patch.colours is None else patch.colours[is_used],
    )


def _no_contexts() -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    return np.zeros(layout.CONTEXTS, np.uint8), np.zeros(layout.CONTEXTS, np.uint8)


def _train_weights(
    pairs: list[tuple[Patch, Grown]], spread: Callable[..., Iterable[Any]]
) -> NDArray[np.int8]:
    """Weights of the four points by weighted least squares, twice: the second time outliers count less."""
    unknowns = layout.WEIGHT_ROWS * 4
    weights = np.zeros((layout.KINDS, layout.WEIGHT_ROWS, 4), np.int8)
    weights[:, 0, 0], weights[:, 0, 1] = 1 << layout.WEIGHT_BITS, -(1 << layout.WEIGHT_BITS)
    for turn in range(2):
        current = Tables(10, weights, *_no_contexts(), np.zeros((1, 1), np.int32)).all_weights
        system = partial(_accumulated, weights=current, turn=turn)
        squares = np.zeros((layout.KINDS, unknowns, unknowns))
        products = np.zeros((layout.KINDS, unknowns))
        for more_squares, more_products in spread(system, pairs):
            squares += more_squares
            products += more_products
        for kind in range(layout.KINDS):
            scale = np.trace(squares[kind]) / unknowns
            if scale <= 0:
                continue
            ridge = squares[kind] + _PRIOR * scale * np.eye(unknowns)
            solved = np.linalg.solve(ridge, products[kind]).reshape(layout.WEIGHT_ROWS, 4)
            solved[0] += (1, -1, 0, 0)
            weights[kind] = np.rint(solved * (1 << layout.WEIGHT_BITS)).clip(-128, 127)
    return weights


def _accumulated(
    pair: tuple[Patch, Grown], *, weights: NDArray[np.int64], turn: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What a patch adds to the squares and products of the least squares."""
    patch, grown = pair
    unknowns = layout.WEIGHT_ROWS * 4
    squares, products = np.zeros((layout.KINDS, unknowns, unknowns)), np.zeros((layout.KINDS, unknowns))
    positions = np.ascontiguousarray(patch.positions[grown.order], np.int32)
    _kernels_train.accumulate(
        positions, grown.degree, grown.corners, grown.vertices, weights, turn, squares, products
    )
    return squares, products


def _choose_shifts(sums: NDArray[np.int64], shift_of: NDArray[np.uint8]) -> None:
    """Shift each context's values such that their mean magnitude is 4 to 8; unseen ones go by neighbours."""
    for first, last, _ in _POOLS:
        seen = np.flatnonzero(sums[first:last, 0]) + first
        for context in seen:
            count, total = sums[context]
            while (total >> int(shift_of[context])) >= 8 * count and shift_of[context] < 15:
                shift_of[context] += 1
        for unseen in set(range(first, last)) - set(seen.tolist()):
            if len(seen):
                shift_of[unseen] = shift_of[seen[np.abs(seen - unseen).argmin()]]


def _make_tables(
    normal_bits: int,
    weights: NDArray[np.int8],
    counts: NDArray[np.int64],
    shift_of: NDArray[np.uint8],
) -> Tables:
    """Let contexts with like statistics share a table."""
    table_of = np.zeros(layout.CONTEXTS, np.uint8)
    rows: list[NDArray[np.int64]] = []
    codes = counts[: layout.WALK_AT]
    codes[:, : layout.CODES] += codes[:, : layout.CODES].sum(axis=0) > 0
    code_rows, table_of[: layout.WALK_AT] = _cluster(codes, _CODE_TABLES)
    for row in code_rows:
        row[: layout.CODES] += row[: layout.CODES] == 0
        rows.append(row)
    walk = counts[layout.WALK_AT].copy()
    walk[: layout.WALK_FAR + 1] += 1
    table_of[layout.WALK_AT] = len(rows)
    rows.append(walk)
    for first, last, most in _POOLS:
        pool, chosen = _cluster(counts[first:last], most)
        table_of[first:last] = chosen + len(rows)
        for row in pool:
            row[layout.ESCAPE] += row[layout.ESCAPE] == 0
            rows.append(row)
    frequencies = np.stack([rans.normalise(row, bits=layout.PROBABILITY_BITS) for row in rows])
    return Tables(normal_bits, weights, table_of, shift_of, frequencies)


def _cluster(counts: NDArray[np.int64], most: int) -> tuple[list[NDArray[np.int64]], NDArray[np.int64]]:
    """Group rows of counts into at most `most` sums such that coding each row with its sum costs least.

    Rows without counts go with the nearest row that has some. Returns the sums and each row's choice.
    """
    seen = np.flatnonzero(counts.sum(axis=1))
    if not len(seen):
        return [np.zeros(counts.shape[1], np.int64)], np.zeros(len(counts), np.int64)
    some = counts[seen].astype(np.float64)
    heavy = seen[np.argsort(-counts[seen].sum(axis=1), kind="stable")][:most]
    sums = counts[heavy].astype(np.float64)
    choice = np.zeros(len(seen), np.int64)
    for _ in range(_ROUNDS):
        smooth = sums + 0.02
        bits = -np.log2(smooth / smooth.sum(axis=1, keepdims=True))
        cost = np.einsum("cs,ks->ck", some, bits)
        before, choice = choice, cost.argmin(axis=1)
        sums = np.stack([some[choice == k].sum(axis=0) for k in range(len(sums))])
        if (before == choice).all():
            break
    kept = np.unique(choice)
    choice = np.searchsorted(kept, choice)
    nearest = np.abs(np.arange(len(counts))[:, None] - seen[None, :]).argmin(axis=1)
    return [counts[seen][choice == k].sum(axis=0) for k in range(len(kept))], choice[nearest]
