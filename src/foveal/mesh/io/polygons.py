"""Reading control meshes: polygons stay polygons, and the tags of creases and corners are kept."""

import os
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.base.progress import SILENT, Progress

from ..polymesh import PolyMesh
from .blocks import MeshSource, VertexBlock
from .detect import detect
from .obj_tags import read_obj_tags
from .source import mesh_of, open_source
from .usd import SUFFIXES, read_usd

__all__ = ["read_polygons"]


def read_polygons(
    path: str | os.PathLike[str], /, *, prim: str | None = None, progress: Progress = SILENT
) -> PolyMesh:
    """Read a whole mesh file as polygons: OBJ, OFF, PLY and USD; as triangles what `read_mesh` reads beside.

    Vertices and faces are those of the file, in its order; faces of fewer than three corners are left out.
    Of files that hold triangles alone (STL, GLB), vertices at exactly the same position are merged.

    Of OBJ the tags that OpenSubdiv's shapes write are kept: `t crease`, `t corner`, `t hole` and
    `t interpolateboundary` (0 none, 1 edge and corner, 2 edge only); others are passed by and told of, which
    are `creasemethod`, `smoothtriangles` and edits. Texture coordinates are kept of an OBJ in which each
    vertex has one, that is, without seams; with seams they are left out, since a vertex is one vertex here.

    Parameters
    ----------
    path
        A file of any of these formats; but for USD it may be gzipped.
    prim : str, optional
        The path of the mesh in a USD file; otherwise the first is read. See `usd.read_usd`.
    progress : Progress
        Told of tags that are passed by.

    Raises
    ------
    FovealError
        If the file cannot be read, or is no surface: see `PolyMesh.checked`.
    """
    path = Path(path)
    if path.suffix.lower() in SUFFIXES:
        return read_usd(path, prim=prim)
    if prim is not None:
        raise ValueError(f"only a USD file has prims, got {path.name}")
    kind = detect(path)
    source = open_source(path)
    if kind not in ("obj", "off", "ply"):
        from ..topology import weld  # which brings SciPy with it

        return PolyMesh.of_triangles(weld(mesh_of(source))[0]).checked(path.name)
    positions, colours, starts, corners = _gathered(source)
    if kind != "obj":
        return PolyMesh(positions, starts, corners, colours=colours).checked(path.name)
    tags = read_obj_tags(path, len(positions))
    if tags.passed_by:
        progress.note(
            f"{path}: its tags {', '.join(tags.passed_by)} are passed by: the surface is as without them."
        )
    parts: list[Any] = [positions, starts, corners, list(tags.creases), list(tags.creases.values())]
    parts += [list(tags.sharp_corners), list(tags.sharp_corners.values())]
    parts += [tags.boundary, colours, tags.uvs, tags.holes]
    return PolyMesh(*parts).checked(path.name)


def _gathered(
    source: MeshSource,
) -> tuple[NDArray[np.float64], NDArray[np.float32] | None, NDArray[np.int32], NDArray[np.int32]]:
    """Positions, colours, starts and corners of all of a source."""
    points, triangles, sizes = [], [], []
    with closing(source.blocks()) as blocks:
        for block in blocks:
            if isinstance(block, VertexBlock):
                points.append(block)
                continue
            triangles.append(block.faces)
            sizes.append(np.full(len(block.faces), 3) if block.sizes is None else block.sizes)
    positions = np.concatenate([b.positions for b in points])
    colours = [b.colours for b in points if b.colours is not None]
    return (
        positions,
        np.concatenate(colours).astype(np.float32) if source.has_colours else None,
        *_polygons(np.concatenate(triangles), np.concatenate(sizes)),
    )


def _polygons(
    triangles: NDArray[np.int64], sizes: NDArray[np.int64]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Starts and corners of the polygons whose fans the triangles are: see `FaceBlock.sizes`."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    first = np.concatenate([[0], np.cumsum(sizes - 2)])[:-1]
    corners = np.empty(starts[-1], np.int32)
    is_last = np.ones(len(corners), np.bool_)  # the last corner of a triangle
    for corner in range(2):
        corners[starts[:-1] + corner] = triangles[first, corner]
        is_last[starts[:-1] + corner] = False
    corners[is_last] = triangles[:, 2]
    return starts.astype(np.int32), corners
