"""The door behind every reader: what leaves it are finite positions and true indices."""

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from .blocks import Blocks, VertexBlock

__all__ = ["bytes_of_colours", "check_blocks"]

_MOST = 2**31 - 1  # faces are int32 in a TriMesh


def check_blocks(blocks: Blocks, name: str, vertices: int | None = None) -> Blocks:
    """Pass blocks on; `vertices` is their number where a header has told it.

    Raises
    ------
    FovealError
        NaN or infinite coordinates, an index of no vertex, no vertex or no triangle at all.
    """
    points, triangles, highest, highest_at = 0, 0, -1, 0
    for block in blocks:
        if isinstance(block, VertexBlock):
            finite = np.isfinite(block.positions).all(axis=1)
            if not finite.all():
                raise FovealError(
                    f"{name}: vertex {points + int(finite.argmin())} has a coordinate that is NaN or"
                    " infinite. Repair the file in a mesh editor."
                )
            points += len(block.positions)
        else:
            low, high = int(block.faces.min(initial=0)), int(block.faces.max(initial=-1))
            if low < 0 or (vertices is not None and high >= vertices):
                wrong = (block.faces < 0) | (block.faces >= (vertices or _MOST))
                _refuse_index(
                    block.faces[wrong][0], triangles + int(wrong.any(axis=1).argmax()), vertices, name
                )
            if high > highest:
                highest, highest_at = high, triangles + int((block.faces == high).any(axis=1).argmax())
            triangles += len(block.faces)
        yield block
    if points == 0:
        raise FovealError(f"{name}: there is no vertex in it. Choose a file with a triangle mesh.")
    if triangles == 0:
        raise FovealError(
            f"{name}: it holds {points} points and no triangle. Make a surface of the points first."
        )
    if highest >= points:
        _refuse_index(highest, highest_at, points, name)
    if points > _MOST:
        raise FovealError(f"{name}: it has {points} vertices; at most {_MOST} can be numbered.")


def _refuse_index(index: int, triangle: int, vertices: int | None, name: str) -> None:
    known = f"vertices go from 0 to {vertices - 1}" if vertices else "there is no such vertex"
    raise FovealError(
        f"{name}: triangle {triangle} names vertex {index}, but {known}. The file is damaged;"
        " export or copy it again."
    )


def bytes_of_colours(values: NDArray[np.floating], scale: float) -> NDArray[np.uint8]:
    """Channels in 0 to 255 / `scale` as bytes, rounded; what is not a number becomes 0."""
    result: NDArray[np.uint8] = np.clip(np.rint(np.nan_to_num(values * scale)), 0, 255).astype(np.uint8)
    return result
