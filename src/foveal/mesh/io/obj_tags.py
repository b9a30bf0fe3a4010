"""What an OBJ file says of a control mesh beside its faces: creases, corners, texture coordinates."""

from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..polymesh import BOUNDARIES, Boundary
from . import _kernels_obj as kernels
from .obj_parser import ObjParser

__all__ = ["ObjTags", "read_obj_tags"]


@dataclass
class ObjTags:
    """As `PolyMesh.of` takes them, not checked; `uvs` where each vertex has one."""

    creases: dict[tuple[int, int], float] = field(default_factory=dict)
    sharp_corners: dict[int, float] = field(default_factory=dict)
    boundary: Boundary = "edge_only"
    uvs: NDArray[np.float32] | None = None
    holes: list[int] = field(default_factory=list)
    passed_by: list[str] = field(default_factory=list)
    """Names of tags that would give another surface, each once."""

    def take(self, text: str) -> None:
        """Heed the rest of a `t` line: a name, how many integers/numbers/words follow, and those.

        Vertices and faces count from 0, other than in `f`. A crease is a pair of vertices, and a line may
        have several; one sharpness holds for all of a line, or each has its own.
        """
        name, *rest = text.split("#", 1)[0].split()
        if name not in ("crease", "corner", "interpolateboundary", "hole"):
            # "normal" is how it is done here, and texture coordinates do not move the surface.
            is_ours = rest[-1:] == ["normal"] or name == "facevaryinginterpolateboundary"
            if not is_ours and name not in self.passed_by:
                self.passed_by.append(name)
            return
        whole, real, _ = (int(count) for count in rest[0].split("/"))
        indices = [_index(word) for word in rest[1 : 1 + whole]]
        sharpness = [float(word) for word in rest[1 + whole : 1 + whole + real]]
        if (len(indices), len(sharpness)) != (whole, real) or whole < 1:
            raise ValueError
        if name == "interpolateboundary":
            self.boundary = BOUNDARIES[indices[0]]
        elif name == "hole":
            self.holes += indices
        elif name == "crease":
            sharpness *= whole // 2 if real == 1 else 1
            ends = zip(indices[0::2], indices[1::2], strict=True)
            self.creases |= zip(ends, sharpness, strict=True)
        else:
            sharpness *= whole if real == 1 else 1
            self.sharp_corners |= zip(indices, sharpness, strict=True)


def _index(word: str) -> int:
    number = int(word)
    if not 0 <= number < 1 << 31:
        raise ValueError
    return number


def read_obj_tags(path: Path, vertices: int) -> ObjTags:
    """Read a file's `t`, `vt` and `f` lines.

    Raises
    ------
    FovealError
        If a tag cannot be read, or the file is damaged.
    """
    tags, uvs, corners, corner_uvs = ObjTags(), [], [], []
    with closing(ObjParser(path, kernels.UVS | kernels.FACES | kernels.TAGS).rows()) as all_rows:
        for rows in all_rows:
            uvs.append(rows.uvs.copy())
            corners.append(rows.triangles.reshape(-1).copy())
            corner_uvs.append(rows.triangle_uvs.reshape(-1).copy())
            if len(rows.statement) == 2:
                try:
                    tags.take(rows.statement[1])
                except (ValueError, IndexError):
                    raise FovealError(
                        f'{path.name}: the tag "t {rows.statement[1].strip()[:40]}" cannot be read.'
                        " Write it as OpenSubdiv's shapes do, such as t crease 2/1/0 4 7 2.5."
                    ) from None
    tags.uvs = _uvs(
        np.concatenate([*uvs, np.empty((0, 2))]),
        np.concatenate(corners),
        np.concatenate(corner_uvs),
        vertices,
    )
    return tags


def _uvs(
    table: NDArray[np.float64], corners: NDArray[np.int64], at: NDArray[np.int64], vertices: int
) -> NDArray[np.float32] | None:
    """(vertices, 2), or None unless all corners at a vertex have the same; 0, 0 where there is no corner."""
    if len(table) == 0 or (at < 0).any() or (at >= len(table)).any():
        return None
    uvs = np.zeros((vertices, 2))
    uvs[corners] = table[at]
    is_one = np.array_equal(uvs[corners], table[at])  # NaN is never
    return uvs.astype(np.float32) if is_one else None
