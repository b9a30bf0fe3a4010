"""Triangles paired into quadrangles: half the patches, most of them with regular corners.

The paper's conclusion proposes it so that triangle meshes fit slates. The surface is Catmull-Clark's of the
quadrangles, another one than that of the triangles.
"""

from collections import deque

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh

__all__ = ["paired"]

Ints = NDArray[np.int64]


def paired(mesh: TriMesh, /) -> PolyMesh:
    """Triangles joined across edges, those first that make the squarest and flattest quadrangles.

    Then pairs are changed along paths as long as that joins two triangles that are left over, so that on most
    closed meshes none is.

    Parameters
    ----------
    mesh : TriMesh
        An oriented surface.

    Examples
    --------
    >>> from foveal.mesh.shapes import icosphere, torus
    >>> paired(torus(6, 5)).faces, paired(icosphere(1)).faces
    (30, 40)
    """
    faces = mesh.faces.astype(np.int64)
    first, second = _beside(faces, len(mesh.positions))
    order = np.argsort(_badness(mesh.positions, faces, first, second), kind="stable")
    mates = [-1] * len(faces)
    beside: list[dict[int, int]] = [
        {} for _ in faces
    ]  # of a triangle, which are, and beyond which corner's edge
    for h, g in zip(first[order].tolist(), second[order].tolist(), strict=True):
        beside[h // 3].setdefault(g // 3, h)
        beside[g // 3].setdefault(h // 3, g)
        if mates[h // 3] < 0 and mates[g // 3] < 0:
            mates[h // 3], mates[g // 3] = g // 3, h // 3
    for f in range(len(faces)):
        if mates[f] < 0:
            _augment(f, beside, mates)
    rows: list[list[int]] = []
    for f, g in enumerate(mates):
        if g < 0:
            rows.append(faces[f].tolist())
        elif f < g:  # in the order of their first triangles
            h, apex = beside[f][g] % 3, faces[g, (beside[g][f] + 2) % 3]
            rows.append([faces[f, h], apex, faces[f, (h + 1) % 3], faces[f, (h + 2) % 3]])
    starts = np.cumsum([0] + [len(row) for row in rows])
    colours = None if mesh.colours is None else mesh.colours.astype(np.float32)
    return PolyMesh(mesh.positions, starts, np.concatenate(rows), colours=colours)


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
