"""Polygons in a `.fov` of kind "cage", version 2, and in other files. See spec/container.md."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.container import Container

if TYPE_CHECKING:
    from foveal.mesh.polymesh import PolyMesh

__all__ = [
    "PolygonCounts",
    "has_border",
    "polygons_chunk",
    "polygons_header",
    "polygons_of",
    "told",
]

_ATTRIBUTES = {"colour": 3, "uv": 2}


@dataclass(frozen=True, slots=True)
class PolygonCounts:
    """What a control mesh of polygons is made of.

    Attributes
    ----------
    triangles, quads, larger : int
        Faces of three, four and more corners.
    creases, semi_sharp, corners : int
        Edges tagged sharp, those of them that become smooth after some steps, and vertices tagged sharp.
    boundary : "edge_only", "edge_and_corner" or "none"
    holes : int
        Faces that are left out.
    """

    triangles: int
    quads: int
    larger: int
    creases: int
    semi_sharp: int
    corners: int
    boundary: str
    holes: int = 0

    @classmethod
    def of(cls, mesh: "PolyMesh", /) -> "PolygonCounts":
        """Count.

        Examples
        --------
        >>> from foveal.mesh.poly_shapes import cube
        >>> PolygonCounts.of(cube()).quads
        6
        """
        from foveal.mesh.polymesh import INFINITELY_SHARP

        sizes, sharp = np.diff(mesh.starts), mesh.crease_sharpness
        return cls(
            triangles=int((sizes == 3).sum()),
            quads=int((sizes == 4).sum()),
            larger=int((sizes > 4).sum()),
            creases=int((sharp > 0).sum()),
            semi_sharp=int(((sharp > 0) & (sharp < INFINITELY_SHARP)).sum()),
            corners=int((mesh.corner_sharpness > 0).sum()),
            boundary=mesh.boundary,
            holes=len(mesh.holes),
        )


def told(counts: PolygonCounts, /) -> str:
    """The counts for people; what there is none of is left out.

    Examples
    --------
    >>> told(PolygonCounts(0, 6, 1, 12, 3, 1, "edge_only"))
    '6 quads, 1 larger polygon, 12 creases (3 semi-sharp), 1 sharp corner'
    """

    def some(count: int, what: str) -> list[str]:
        return [f"{count:,} {what}{'' if count == 1 else 's'}"] if count else []

    creases = some(counts.creases, "crease")
    if counts.semi_sharp:
        creases = [f"{creases[0]} ({counts.semi_sharp:,} semi-sharp)"]
    faces = [*some(counts.quads, "quad"), *some(counts.triangles, "triangle")]
    return ", ".join(
        [
            *faces,
            *some(counts.larger, "larger polygon"),
            *some(counts.holes, "hole"),
            *creases,
            *some(counts.corners, "sharp corner"),
        ]
    )


def has_border(mesh: "PolyMesh", /) -> bool:
    """Whether some edge has one face only.

    Examples
    --------
    >>> from foveal.mesh.poly_shapes import cube, quad_grid
    >>> has_border(cube()), has_border(quad_grid(2))
    (False, True)
    """
    starts, corners = mesh.starts, mesh.corners.astype(np.int64)
    following = np.arange(1, len(corners) + 1)
    following[starts[1:] - 1] = starts[:-1]
    ends = np.stack([corners, corners[following]])
    edges = np.unique(ends.min(axis=0) * len(mesh.positions) + ends.max(axis=0))
    return 2 * len(edges) != len(corners)


def polygons_header(mesh: "PolyMesh", /) -> dict[str, Any]:
    """What the header says of the arrays in chunk 0."""
    attributes = {"colour": mesh.colours, "uv": mesh.uvs}
    return {
        "vertices": len(mesh.positions),
        "triangles": len(mesh.corners) - 2 * mesh.faces,
        "faces": mesh.faces,
        "corners": len(mesh.corners),
        "creases": len(mesh.crease_edges),
        "sharp_corners": len(mesh.corner_vertices),
        "boundary": mesh.boundary,
        **({"holes": len(mesh.holes)} if len(mesh.holes) else {}),
        "attributes": [name for name, values in attributes.items() if values is not None],
    }


def polygons_chunk(mesh: "PolyMesh", /) -> bytes:
    """The bytes of chunk 0."""
    columns: list[tuple[str, Any]] = [
        ("<f8", mesh.positions),
        ("<u4", np.diff(mesh.starts)),
        ("<u4", mesh.corners),
        ("<u4", mesh.crease_edges),
        ("<f4", mesh.crease_sharpness),
        ("<u4", mesh.corner_vertices),
        ("<f4", mesh.corner_sharpness),
        *(("<f4", values) for values in (mesh.colours, mesh.uvs) if values is not None),
        ("<u4", mesh.holes),
    ]
    return b"".join(np.ascontiguousarray(values).astype(kind).tobytes() for kind, values in columns)


def polygons_of(
    file: Container, count: Callable[..., int], damaged: Callable[[str], FovealError], /
) -> "PolyMesh":
    """The polygons of an open file.

    Parameters
    ----------
    count : function
        Of a key, and the least that it may be: the whole number in the header, or the error below.
    damaged : function
        Of a key: what to say where it makes no sense.

    Raises
    ------
    FovealError
        If header and chunk do not agree, or are no surface.
    """
    from foveal.mesh.polymesh import BOUNDARIES, PolyMesh

    n, m, k = count("vertices"), count("faces"), count("corners")
    c, p = count("creases", 0), count("sharp_corners", 0)
    if count("triangles") != k - 2 * m:
        raise damaged("triangles")
    boundary, attributes = file.header.get("boundary"), file.header.get("attributes")
    if boundary not in BOUNDARIES:
        raise damaged("boundary")
    if attributes not in ([], ["colour"], ["uv"], ["colour", "uv"]):
        raise damaged("attributes")
    widths = [_ATTRIBUTES[name] for name in attributes]
    data = file.chunk(0)
    h = count("holes") if "holes" in file.header else 0
    if len(data) != 24 * n + 4 * (m + k + 3 * c + 2 * p + sum(widths) * n + h):
        raise damaged("lengths")
    at = 0

    def column(kind: str, rows: int, width: int = 1) -> NDArray[Any]:
        nonlocal at
        values = np.frombuffer(data, kind, rows * width, at)
        at += values.nbytes
        return values if width == 1 else values.reshape(-1, width)

    positions = column("<f8", n, 3)
    starts = np.concatenate([[0], np.cumsum(column("<u4", m).astype(np.int64))])
    if starts[-1] != k:
        raise damaged("faces")
    tags = column("<u4", k), column("<u4", c, 2), column("<f4", c), column("<u4", p), column("<f4", p)
    further = {name: column("<f4", n, width) for name, width in zip(attributes, widths, strict=True)}
    parts: list[Any] = [positions, starts, *tags, boundary, further.get("colour"), further.get("uv")]
    parts.append(column("<u4", h))
    return PolyMesh(*parts).checked(file.name)
