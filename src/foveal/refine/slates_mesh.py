"""A tessellation as one mesh."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from foveal.mesh.trimesh import TriMesh

from .slates_result import SlateArrays

__all__ = ["joined"]


def joined(arrays: SlateArrays, placements: NDArray[np.float64], /, *, has_colours: bool) -> TriMesh:
    """The triangles of all placements over shared vertices; see `Slates.mesh`."""
    own, copies = _shared([arrays.positions, arrays.normals, *arrays.columns], arrays.faces)
    points, normals, faces, colours, uvs = [], [], [], [], []
    has_uvs = len(arrays.columns) > has_colours
    base = 0
    for matrix, first, count in zip(placements, arrays.first, arrays.counts, strict=True):
        triangles = own[arrays.faces[_runs(first, count)]]
        used, index = np.unique(triangles, return_inverse=True)
        rows, linear = copies[used], matrix[:3, :3]
        points.append(arrays.positions[rows].astype(np.float64) @ linear.T + matrix[:3, 3])
        turned = arrays.normals[rows].astype(np.float64) @ np.linalg.inv(linear)
        normals.append(_unit(turned))
        faces.append(index.reshape(-1, 3)[:, :: -1 if np.linalg.slogdet(linear).sign < 0 else 1] + base)
        if has_colours:
            colours.append(np.rint(arrays.columns[0][rows]).clip(0, 255).astype(np.uint8))
        if has_uvs:
            uvs.append(arrays.columns[-1][rows, :2].astype(np.float32))
        base += len(used)
    return TriMesh(
        np.concatenate(points),
        np.concatenate(faces).astype(np.int32),
        np.concatenate(normals).astype(np.float32),
        np.concatenate(colours) if has_colours else None,
        np.concatenate(uvs) if has_uvs else None,
    )


def _runs(first: NDArray[np.int64], count: NDArray[np.int64]) -> NDArray[np.int64]:
    """first[i], first[i] + 1 .. count[i] of them, one run after the other."""
    ends = np.cumsum(count)
    return np.repeat(first - ends + count, count) + np.arange(ends[-1])


def _shared(
    columns: list[NDArray[Any]], faces: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Of each row in some face its number among those that differ, and a row for each number."""
    is_used = np.zeros(len(columns[0]), np.bool_)
    is_used[faces] = True
    rows = np.flatnonzero(is_used)
    data = np.ascontiguousarray(np.concatenate([column[rows] for column in columns], axis=1))
    data += 0.0  # -0 and 0 are the same place
    keys = data.view(np.dtype((np.void, data.itemsize * data.shape[1]))).reshape(-1)
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    own = np.zeros(len(columns[0]), np.int64)
    own[rows] = number.reshape(-1)
    return own, rows[first]


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: NDArray[np.float64] = np.where(length > 0, vectors / np.where(length > 0, length, 1), 0)
    return unit
