"""The shadows of a light, precomputed: from meshes to a shadow map."""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor, threads_unless
from foveal.mesh.trimesh import TriMesh

from ._kernels_flat import Flat
from ._kernels_sets import KEPT
from .casters import Casters, casters_of, winding_number
from .construct import pixels_of_triangles, tree_of_triangles
from .flat import flatten
from .frames import checked_resolution
from .light import Light
from .projection import Projection
from .shadow_map import ShadowMap
from .stack import tree_of_stack
from .topdown import tree_from_the_root
from .tree import FAR, LEAF

__all__ = ["METHODS", "Exits", "Method", "build", "intervals"]

Method = Literal["optimal", "bottom-up", "top-down"]
Exits = Literal["surface", "strict"]
METHODS = ("optimal", "bottom-up", "top-down")
_MOST_TOP_DOWN = 8192
_MOST_PIXELS = 1 << 14


def build(
    meshes: TriMesh | Sequence[TriMesh],
    light: Light,
    /,
    *,
    resolution: int = 4096,
    method: Method = "optimal",
    exits: Exits = "surface",
    executor: Executor | None = None,
    progress: Progress = SILENT,
) -> ShadowMap:
    """Precompute the shadow map of a light, of any resolution, lossless for the test of every pixel's sample.

    A ray from the light through the middle of a pixel enters the model at one depth and leaves it at another.
    Any value from the one to just before the other gives the right answer for all that stands outside; values
    are chosen such that as few as possible have to be kept.

    Parameters
    ----------
    meshes : TriMesh or sequence of TriMesh
        What casts. Closed parts cast as solids, whether they go through each other or not, open ones as
        sheets.
    light : Light
        `Directional`, `Sun`, `Spot`, `Point`, or for a stack of maps `AreaLight`, `SunPath`.
    resolution : int
        Pixels a side, a power of two from 2 to 2^20. Pixels are never all made: time and bytes follow the
        length of silhouettes, and double where the side doubles.
    method : {"optimal", "bottom-up", "top-down"}
        "optimal" keeps the fewest values (parsimony); the others are those of the paper, to compare with:
        "top-down" needs all pixels at once, so a side of 8,192 at most, and takes no stacks.
    exits : {"surface", "strict"}
        Where a ray that meets an open part may be said to leave: "surface" just before the next surface,
        right for all that casts itself; "strict" at once, right also for what moves in the air below a roof
        of one sheet. Such parts then take about as many values as pixels.
    executor : Executor, optional
        Local threads by default. The result does not depend on it.
    progress : Progress
        Told of the work done.

    Returns
    -------
    ShadowMap
        Answers `lookup`, `pcf`, `filtered` and `soft`; `save` writes it.

    Raises
    ------
    FovealError
        In a sentence: nothing casts, nothing is before the light, the light is inside a solid, a resolution
        that cannot be.

    Based on: Scandolo, Bauszat, Eisemann. Compressed Multiresolution Hierarchies for High-Quality Precomputed
    Shadows. 2016, section 3.1; the fewest values: Hartigan. Minimum Mutation Fits to a Given Tree. 1973.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> from foveal.shadows import Directional
    >>> shadow = build(icosphere(3), Directional((0, 0, -1)), resolution=1024)
    >>> shadow.lookup([[0, 0, 1.01], [0, 0, -1.01], [1.4, 0, -1]]).tolist()
    [True, False, True]
    """
    from .shadow_map import ShadowMap

    if method not in METHODS:
        raise FovealError(f"method must be one of {', '.join(METHODS)}, got {method!r}.")
    is_strict = _is_strict(exits)
    side = checked_resolution(resolution, images=light.images)
    if method == "top-down" and (side > _MOST_TOP_DOWN or light.is_stack):
        raise FovealError(
            f"top-down construction needs all pixels at once: one map, a resolution of {_MOST_TOP_DOWN} at "
            "most. Use 'optimal', which makes smaller trees, too."
        )

    times = dict.fromkeys(("joining", "projecting", "tracing"), 0.0)
    with _timed(times, "joining"):
        casters = _casters(meshes)
        projections = light.projections(casters.positions, side)
        _refuse_inside(casters, projections)
    levels = side.bit_length() - 1
    most = KEPT if method == "optimal" else 1
    with threads_unless(executor) as pool, _timed(times, "tracing"):
        flats = _flattened(casters, projections, times)
        if light.is_stack:
            made = [
                tree_of_stack(
                    [partial(flatten, casters, projection) for projection in projections],
                    levels,
                    executor=pool,
                    is_strict=is_strict,
                    most=most,
                    progress=progress,
                )
            ]
        elif method == "top-down":
            made = [
                tree_from_the_root(*pixels_of_triangles(flat, levels, executor=pool, is_strict=is_strict))
                for flat in flats
            ]
        else:
            made = [
                tree_of_triangles(
                    flat, levels, executor=pool, is_strict=is_strict, most=most, progress=progress
                )
                for flat in flats
            ]
    times["tracing"] -= times["projecting"]
    is_all_lit = all(tree.root == LEAF and tree.values[0] == FAR for tree in made)
    if is_all_lit and not any(len(flatten(casters, projection).corners) for projection in projections):
        raise FovealError("the light meets nothing: no part of the model is where it shines.")
    return ShadowMap(light, projections, tuple(made), times=times)


def intervals(
    meshes: TriMesh | Sequence[TriMesh],
    light: Light,
    /,
    *,
    resolution: int = 1024,
    exits: Exits = "surface",
    executor: Executor | None = None,
) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """The values that are legal for each pixel of a map: all that a tree has to keep to, uncompressed.

    Parameters
    ----------
    meshes, light, exits, executor
        As for `build`.
    resolution : int
        A power of two, at most 16,384.

    Returns
    -------
    lower, upper : (images, resolution, resolution) uint32
        Steps of depth, where a ray enters and just before where it leaves, both legal; six images of a point
        light. Pixel (x, y) is at [y, x]. Where nothing is met both are 2^32 - 1.

    Raises
    ------
    FovealError
        As `build`.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere
    >>> from foveal.shadows import Directional
    >>> lower, upper = intervals(icosphere(2), Directional((0, 0, -1)), resolution=4)
    >>> (lower[0] < upper[0]).astype(int)
    array([[0, 1, 1, 0],
           [1, 1, 1, 1],
           [1, 1, 1, 1],
           [0, 1, 1, 0]])
    """
    is_strict = _is_strict(exits)
    side = checked_resolution(resolution, images=light.images)
    if side > _MOST_PIXELS:
        raise FovealError(f"all pixels at once are for a resolution of {_MOST_PIXELS} at most, got {side}.")
    casters = _casters(meshes)
    projections = light.projections(casters.positions, side)
    shape = (len(projections), side, side)
    lower, upper = np.empty(shape, np.uint32), np.empty(shape, np.uint32)
    with threads_unless(executor) as pool:
        for image, projection in enumerate(projections):
            lower[image], upper[image] = pixels_of_triangles(
                flatten(casters, projection), side.bit_length() - 1, executor=pool, is_strict=is_strict
            )
    return lower, upper


def _is_strict(exits: str) -> bool:
    if exits not in ("surface", "strict"):
        raise FovealError(f"exits must be 'surface' or 'strict', got {exits!r}.")
    return exits == "strict"


def _casters(meshes: TriMesh | Sequence[TriMesh]) -> Casters:
    every = [meshes] if isinstance(meshes, TriMesh) else list(meshes)
    casters = casters_of(every) if every else None
    if casters is None or len(casters.faces) == 0:
        raise FovealError("nothing casts a shadow: there is no triangle with three corners apart.")
    return casters


def _refuse_inside(casters: Casters, projections: tuple[Projection, ...]) -> None:
    """Refuse a light that stands in a solid: its rays would begin inside, and all would be dark."""
    if projections[0].is_parallel:
        return
    middle = projections[len(projections) // 2].eye()
    if round(winding_number(casters, middle)) > 0:
        place = ", ".join(f"{x:.6g}" for x in middle)
        raise FovealError(
            f"the light at ({place}) is inside a closed part of the model, where all is dark. "
            "Move it outside."
        )


@contextmanager
def _timed(times: dict[str, float], phase: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    times[phase] += time.perf_counter() - start


def _flattened(
    casters: Casters, projections: tuple[Projection, ...], times: dict[str, float]
) -> Iterator[Flat]:
    for projection in projections:
        with _timed(times, "projecting"):
            flat = flatten(casters, projection)
        yield flat
