"""Triangles paired into quadrangles: half the patches, most of them with regular corners.

The paper's conclusion proposes it so that triangle meshes fit slates. The surface is Catmull-Clark's of the
quadrangles, another one than that of the triangles.
"""

from collections import deque
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh

__all__ = ["paired"]

Ints = NDArray[np.int64]


def paired(mesh: TriMesh | PolyMesh, /) -> PolyMesh:
    """Triangles joined across edges, those first that make the squarest and flattest quadrangles.

    Then pairs are changed along paths as long as that joins two triangles that are left over, so that on most
    closed meshes none is. Other faces and holes stay as they are, and so do triangles that meet at a crease.

    Parameters
    ----------
    mesh : TriMesh or PolyMesh
        An oriented surface.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere, torus
    >>> paired(torus(6, 5)).faces, paired(icosphere(1)).faces
    (30, 40)
    """
    polygons = PolyMesh.of_triangles(mesh) if isinstance(mesh, TriMesh) else mesh
    starts, corners = polygons.starts.astype(np.int64), polygons.corners.astype(np.int64)
    is_hole = np.zeros(polygons.faces, np.bool_)
    is_hole[polygons.holes] = True
    triangles = np.flatnonzero((np.diff(starts) == 3) & ~is_hole)
    faces = corners[starts[triangles, None] + np.arange(3)]
    first, second = _smooth(polygons, faces, *_beside(faces, len(polygons.positions)))
    order = np.argsort(_badness(polygons.positions, faces, first, second), kind="stable")
    beside, mates = _mates(first[order].tolist(), second[order].tolist(), len(faces))
    rows: list[Any] = np.split(corners, starts[1:-1])
    gone = []
    for f, g in enumerate(mates):
        if f < g:  # in the place of the first
            h, apex = beside[f][g] % 3, faces[g, (beside[g][f] + 2) % 3]
            rows[triangles[f]] = np.array([faces[f, h], apex, faces[f, (h + 1) % 3], faces[f, (h + 2) % 3]])
            gone.append(triangles[g])
    kept = np.delete(np.arange(len(rows)), gone)
    left = [rows[f] for f in kept]
    return replace(
        polygons,
        starts=np.cumsum([0, *map(len, left)]).astype(np.int32),
        corners=np.concatenate(left).astype(np.int32),
        holes=np.flatnonzero(is_hole[kept]).astype(np.int32),
    )


def _mates(first: list[int], second: list[int], count: int) -> tuple[list[dict[int, int]], list[int]]:
    """Of each triangle its neighbours, each with the corner whose edge is theirs; and its mate, or -1."""
    mates = [-1] * count
    beside: list[dict[int, int]] = [{} for _ in mates]
    for h, g in zip(first, second, strict=True):
        beside[h // 3].setdefault(g // 3, h)
        beside[g // 3].setdefault(h // 3, g)
        if mates[h // 3] < 0 and mates[g // 3] < 0:
            mates[h // 3], mates[g // 3] = g // 3, h // 3
    for f in range(count):
        if mates[f] < 0:
            _augment(f, beside, mates)
    return beside, mates


def _smooth(mesh: PolyMesh, faces: Ints, first: Ints, second: Ints) -> tuple[Ints, Ints]:
    """Those corners whose edges are no creases."""
    count = len(mesh.positions)
    ends = faces[first // 3, first % 3], faces[first // 3, (first + 1) % 3]
    creases = mesh.crease_edges[mesh.crease_sharpness > 0].astype(np.int64)
    keys = np.minimum(*ends) * count + np.maximum(*ends)
    is_smooth = ~np.isin(keys, creases[:, 0] * count + creases[:, 1])
    return first[is_smooth], second[is_smooth]


def _beside(faces: Ints, count: int) -> tuple[Ints, Ints]:
    """Corners h and g of two triangles, whose edges to the next corner are the same one."""
    begin, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    keys = np.minimum(begin, end) * count + np.maximum(begin, end)
    order = np.argsort(keys, kind="stable")
    same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    first, second = order[same], order[same + 1]
    apex = faces[first // 3, (first + 2) % 3] != faces[second // 3, (second + 2) % 3]
    return first[apex], second[apex]


def _badness(points: NDArray[np.float64], faces: Ints, first: Ints, second: Ints) -> NDArray[np.float64]:
    """Of the quadrangle: its largest cosine at a corner, and how far its halves are from one plane."""
    corners = [faces[first // 3, first % 3], faces[second // 3, (second + 2) % 3]]
    corners += [faces[second // 3, second % 3], faces[first // 3, (first + 2) % 3]]
    ring = points[np.stack(corners)]
    sides = np.roll(ring, -1, axis=0) - ring
    sides /= np.maximum(np.linalg.norm(sides, axis=2, keepdims=True), 1e-300)
    largest = abs((sides * np.roll(sides, 1, axis=0)).sum(axis=2)).max(axis=0)
    normals = np.cross(sides[[0, 2]], sides[[1, 3]])
    normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), 1e-300)
    badness: NDArray[np.float64] = largest + 1 - (normals[0] * normals[1]).sum(axis=1)
    return badness


def _augment(start: int, beside: list[dict[int, int]], mates: list[int]) -> None:
    """Along a shortest path of other pairs and own pairs in turn to another triangle that is left over.

    Paths through odd circles are not looked for: of four closed meshes of 2,496 to 20,088 triangles nothing
    was left over without them.
    """
    came: dict[int, int] = {}
    queue, seen = deque([start]), {start}
    while queue:
        f = queue.popleft()
        for g in beside[f]:
            if g in seen:
                continue
            seen.add(g)
            came[g] = f
            if mates[g] < 0:
                _turn_path(g, came, mates, start)
                return
            if mates[g] not in seen:
                seen.add(mates[g])
                queue.append(mates[g])


def _turn_path(g: int, came: dict[int, int], mates: list[int], start: int) -> None:
    """Pair g with the triangle it was reached from, and so on back to the start."""
    while True:
        f = came[g]
        before = mates[f]
        mates[f], mates[g] = g, f
        if f == start:
            return
        g = before
