"""The `.fov` of kind "shadow": a light, how it sees, and its trees, coded. See spec/container.md."""

import os
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike
from foveal.base.version import __version__
from foveal.container import Container, create, open_container

from .coded import MOST_LEVELS, Counts, decode, encode, parts_of
from .projection import Projection
from .tree import INNER, Tree

if TYPE_CHECKING:
    from .shadow_map import ShadowMap

__all__ = ["is_shadow", "read_parts", "read_shadow", "write_shadow"]

KIND, VERSION = "shadow", 1


def write_shadow(shadow_map: "ShadowMap", path: PathLike, /) -> None:
    """Write a shadow map; trees are coded one after the other, level by level in the file.

    Raises
    ------
    ValueError
        If a tree is none, or trees and projections are not as many as they should be.
    FovealError
        If the file cannot be written, or a stack was read without its finest levels.
    """
    trees, projections = shadow_map.trees, shadow_map.projections
    levels, children = trees[0].levels, trees[0].children
    if any((tree.levels, tree.children) != (levels, children) for tree in trees):
        raise ValueError("trees of one file have the same levels and children")
    if len(trees) != _trees(children, len(projections)):
        raise ValueError(f"{len(projections)} projections and {len(trees)} trees do not fit")
    if children == 8 and not _fits(len(projections), trees[0].spread, levels):
        raise FovealError(f"{path}: a stack read without its finest levels cannot be written. Read it whole.")
    parts = parts_of(trees)
    header = {
        "generator": f"foveal {__version__}",
        "light": shadow_map.light.to_json(),
        "projections": [projection.matrix.tolist() for projection in projections],
        "levels": levels,
        "children": children,
        "images": len(projections) if children == 8 else 1,
        **({"spread": trees[0].spread} if children == 8 else {}),
        "parts": parts,
        "nodes": _nodes(trees),
    }
    coded = [encode(tree, parts) for tree in trees]
    with create(path, kind=KIND, version=VERSION) as writer:
        for part in range(len(parts)):
            for chunks in coded:
                writer.add_chunk(chunks[part])
        writer.finish(header, b"".join(_counts_bytes(Counts.of(tree)) for tree in trees))


def read_shadow(
    source: str | os.PathLike[str] | bytes | Container, /, *, levels: int | None = None
) -> "ShadowMap":
    """Read a `.fov` of kind "shadow".

    Parameters
    ----------
    source
        A path, an address that fsspec knows, the bytes themselves, or the open file.
    levels : int
        Read no more than is needed for a map of 2^levels pixels a side; it may have more.

    Raises
    ------
    FovealError
        If it cannot be read, is damaged, or is of another kind or version.
    """
    from .light import light_from_json
    from .shadow_map import ShadowMap

    if not isinstance(source, Container):
        with open_container(source) as file:
            return read_shadow(file, levels=levels)
    light, projections, trees = read_parts(source, levels=levels)
    try:
        return ShadowMap(light=light_from_json(light), projections=projections, trees=trees)
    except FovealError as error:
        raise FovealError(f"{source.name}: {error}") from error


def is_shadow(path: PathLike, /) -> bool:
    """Whether a file is a `.fov` that holds a shadow map; what else is wrong its reader says."""
    if not os.fspath(path).lower().endswith(".fov"):
        return False
    with open_container(path) as file:
        return file.kind == KIND


def read_parts(
    file: Container, /, *, levels: int | None = None
) -> tuple[Any, tuple[Projection, ...], tuple[Tree, ...]]:
    """The light as JSON, the projections and the trees of an open file, as in `read_shadow`."""
    file.expect(KIND, VERSION)
    header = file.header
    all_levels, children = _count(file, "levels", 0, MOST_LEVELS), _count(file, "children", 4, 8)
    projections = _projections(file)
    trees = _trees(children, len(projections))
    parts = _parts(file, all_levels)
    spread = _count(file, "spread", 0, all_levels) if children == 8 and "spread" in header else 0
    if children == 8 and not _fits(len(projections), spread, all_levels):
        raise _damaged(file, "spread")
    first = file.chunk(0)
    size = len(first) // trees
    if len(file) != 1 + len(parts) * trees or len(first) != trees * 8 * (all_levels + 1):
        raise _damaged(file, "lengths")
    wanted = len(parts) if levels is None else 1 + sum(part < levels for part in parts[:-1])
    found = []
    for tree in range(trees):
        chunks = [file.chunk(1 + part * trees + tree) for part in range(wanted)]
        counts = _counts_of(first[tree * size : (tree + 1) * size], all_levels, children)
        try:
            read = decode(counts, parts, chunks)
            found.append(replace(read, spread=spread - (all_levels - read.levels)) if children == 8 else read)
        except FovealError as error:
            raise FovealError(f"{file.name}: {error}") from error
    return header.get("light"), projections, tuple(found)


def _trees(children: int, projections: int) -> int:
    """Quadtrees stand for a projection each; one octree stands for all."""
    return projections if children == 4 else 1


def _fits(images: int, spread: int, levels: int) -> bool:
    return spread >= 0 and (images - 1) << spread < 1 << levels


def _nodes(trees: tuple[Tree, ...]) -> dict[str, int]:
    masks = sum(len(tree.masks) for tree in trees)
    values = sum(len(tree.values) for tree in trees)
    inner = sum(
        int(np.bitwise_count(tree.masks & tree.masks >> 1 & 0x5555).sum()) + (tree.root == INNER)
        for tree in trees
    )
    return {"leaf": values - inner, "empty": masks - inner, "inner": inner}


def _counts_bytes(counts: Counts) -> bytes:
    return np.concatenate([[counts.root], counts.masks, counts.values]).astype("<u4").tobytes()


def _counts_of(data: bytes, levels: int, children: int) -> Counts:
    numbers = np.frombuffer(data, "<u4").astype(np.int64)
    return Counts(levels, children, int(numbers[0]), numbers[1 : 1 + levels], numbers[1 + levels :])


def _projections(file: Container) -> tuple[Projection, ...]:
    try:
        matrices: NDArray[np.float64] = np.array(file.header.get("projections"), np.float64)
    except (ValueError, TypeError, OverflowError) as error:
        raise _damaged(file, "projections") from error
    if matrices.ndim != 3 or matrices.shape[1:] != (4, 4) or not len(matrices):
        raise _damaged(file, "projections")
    if not np.isfinite(matrices).all():
        raise _damaged(file, "projections")
    return tuple(Projection(matrix) for matrix in matrices)


def _parts(file: Container, levels: int) -> list[int]:
    parts = file.header.get("parts")
    if not isinstance(parts, list) or not parts or not all(type(part) is int for part in parts):
        raise _damaged(file, "parts")
    if parts[0] < 0 or parts[-1] != levels or any(b <= a for a, b in pairwise(parts)):
        raise _damaged(file, "parts")
    return parts


def _count(file: Container, key: str, least: int, most: int) -> int:
    value = file.header.get(key)
    if type(value) is not int or not least <= value <= most:
        raise _damaged(file, key)
    return value


def _damaged(file: Container, what: str) -> FovealError:
    return FovealError(f"{file.name}: its header is damaged ({what}). Copy or build the file again.")
