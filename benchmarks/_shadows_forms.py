"""Forms of one shadow map beside each other: the authors' greedy tree, all pixels' trees, plain coders."""

import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from _shadows_scenes import Scene
from numpy.typing import NDArray

from foveal.base.tasks import threads_unless
from foveal.shadows import ShadowMap, Tree
from foveal.shadows._kernels_flat import SHEET, Flat
from foveal.shadows.casters import casters_of
from foveal.shadows.construct import pixels_of_triangles, tree_of_pixels
from foveal.shadows.flat import flatten
from foveal.shadows.topdown import tree_from_the_root

__all__ = ["aligned_bytes", "constructions", "file_bytes", "nodes", "pixels", "raw_coders", "seen"]

Pixels = tuple[NDArray[np.uint32], NDArray[np.uint32]]
"""Lowest and highest legal value of each pixel."""


def seen(scene: Scene, resolution: int) -> Flat:
    """A scene's triangles before its light."""
    casters = casters_of(scene[0])
    return flatten(casters, scene[1].projections(casters.positions, resolution)[0])


def pixels(flat: Flat, resolution: int, *, is_next_surface: bool = False) -> Pixels:
    """Legal values by rays through all pixels.

    Exits are those of solids, and the next surface where what is met is open; or with `is_next_surface` the
    next surface everywhere, as if nothing were closed.
    """
    if is_next_surface:
        flat = flat._replace(sides=np.full_like(flat.sides, SHEET))
    with threads_unless(None) as executor:
        return pixels_of_triangles(flat, resolution.bit_length() - 1, executor=executor)


def constructions(intervals: Pixels) -> dict[str, Callable[[], Tree]]:
    """The paper's two constructions and ours, each from the same pixels."""

    def upward(most: int) -> Tree:
        with threads_unless(None) as executor:
            return tree_of_pixels(*intervals, executor=executor, most=most)

    return {
        "top-down": lambda: tree_from_the_root(*intervals),
        "bottom-up": lambda: upward(1),
        "optimal": lambda: upward(8),
    }


def aligned_bytes(tree: Tree) -> int:
    """In the authors' aligned layout: 4 bytes a leaf or empty node, 8 an inner one."""
    return 4 * (len(tree.values) + len(tree.masks))


def nodes(tree: Tree) -> int:
    """Leaves, empty and inner nodes."""
    kinds = sum(int(np.count_nonzero(tree.masks >> 2 * child & 3)) for child in range(tree.children))
    return 1 + kinds


def file_bytes(shadow: ShadowMap, folder: Path) -> int | None:
    """Of the whole `.fov`; None where this version writes none."""
    try:
        shadow.save(folder / "shadow.fov")
    except ImportError:
        return None
    return (folder / "shadow.fov").stat().st_size


def raw_coders(first: NDArray[np.uint32]) -> dict[str, int]:
    """Bytes of the map of first surfaces by coders for any data, which cannot be looked up."""
    sizes = {"zlib-6": len(zlib.compress(first.tobytes(), 6))}
    try:
        import zstandard
    except ImportError:
        return sizes
    deltas = first.copy()
    deltas[1:] -= first[:-1]
    across = deltas.copy()
    across[:, 1:] -= deltas[:, :-1]
    planes = np.stack([(across >> shift).astype(np.uint8) for shift in (24, 16, 8, 0)])
    coder = zstandard.ZstdCompressor(level=19, threads=2)
    sizes["zstd-19 of deltas"] = len(coder.compress(planes.tobytes()))
    return sizes
