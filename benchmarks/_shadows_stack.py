"""An octree of many maps against a quadtree for each."""

import math
from collections.abc import Iterator

from _shadows_scenes import scene
from _shape import Row

from foveal.base.tasks import threads_unless
from foveal.shadows import AreaLight, build
from foveal.shadows.casters import casters_of
from foveal.shadows.construct import tree_of_triangles
from foveal.shadows.flat import flatten
from foveal.shadows.pack import pack

__all__ = ["stack"]

RADII_DEGREES = (5.0, 2.0, 1.0, 0.2666)
"""Of the disc that the light comes from; the last is the sun's. The wider, the less images have in common."""


def stack(*, is_quick: bool) -> Iterator[Row]:
    """64 samples of 512²; of separate trees the smallest, optimal ones, with the same frames."""
    found = scene("small plaza")
    assert found is not None
    meshes, middle = found
    casters, side = casters_of(meshes), 512
    for degrees in RADII_DEGREES[: 1 if is_quick else None]:
        light = AreaLight(middle, math.radians(degrees), samples=64)
        together = build(meshes, light, resolution=side).packed[0].words.nbytes
        apart = {8: 0, 1: 0}
        with threads_unless(None) as executor:
            for projection in light.projections(casters.positions, side):
                flat = flatten(casters, projection)
                for most in apart:
                    tree = tree_of_triangles(flat, side.bit_length() - 1, executor=executor, most=most)
                    apart[most] += pack(tree).words.nbytes
        case = f"small plaza, {degrees:g}° of light"
        peers = {"greedy ones": apart[1] / apart[8], "MB": together / 1e6}
        yield Row("stack_vs_separate", case, together / apart[8], "x", "lower", 0.6, peers=peers)
