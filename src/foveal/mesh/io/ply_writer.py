"""Writing PLY: binary, little endian."""

import os

import numpy as np

from foveal.base.files import whole_file

from ..trimesh import TriMesh

__all__ = ["write_ply"]

_ROWS = 1 << 18  # written at a time
# float32 is kept to if it moves no vertex by more than this part of the mesh's size: half the step of
# a 20-bit grid, finer than scanners and than any picture.
_SENSIBLE = 2.0**-21


def write_ply(mesh: TriMesh, path: str | os.PathLike[str], /, *, comment: str = "") -> None:
    """Write a mesh with normals, colours and texture coordinates (s, t); the file appears when it is whole.

    Positions are written as float32, or as float64 where float32 would move a vertex by more than
    2^-21 of the mesh's largest extent, as it would UTM coordinates.

    Raises
    ------
    FovealError
        If the file cannot be written there.
    """
    number = "f8" if _needs_double(mesh) else "f4"
    vertex = [(n, "<" + number) for n in "xyz"]
    lines = ["ply", "format binary_little_endian 1.0"]
    lines += [f"comment {line}" for line in comment.splitlines()]
    lines += [f"element vertex {len(mesh.positions)}"]
    lines += [f"property {'double' if number == 'f8' else 'float'} {n}" for n in "xyz"]
    if mesh.normals is not None:
        vertex += [(n, "<f4") for n in ("nx", "ny", "nz")]
        lines += [f"property float {n}" for n in ("nx", "ny", "nz")]
    if mesh.colours is not None:
        vertex += [(n, "u1") for n in ("red", "green", "blue")]
        lines += [f"property uchar {n}" for n in ("red", "green", "blue")]
    if mesh.uvs is not None:
        vertex += [(n, "<f4") for n in "st"]
        lines += [f"property float {n}" for n in "st"]
    lines += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header", ""]
    with whole_file(path) as file:
        file.write("\n".join(lines).encode("utf-8"))
        for begin in range(0, len(mesh.positions), _ROWS):
            file.write(_vertex_rows(mesh, slice(begin, begin + _ROWS), np.dtype(vertex)).tobytes())
        face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
        for begin in range(0, len(mesh.faces), _ROWS):
            part = mesh.faces[begin : begin + _ROWS]
            rows = np.empty(len(part), dtype=face)
            rows["count"] = 3
            rows["corners"] = part
            file.write(rows.tobytes())


def _vertex_rows(mesh: TriMesh, part: slice, layout: np.dtype[np.void]) -> np.ndarray:
    positions = mesh.positions[part]
    rows = np.empty(len(positions), dtype=layout)
    for k, name in enumerate("xyz"):
        rows[name] = positions[:, k]
    if mesh.normals is not None:
        for k, name in enumerate(("nx", "ny", "nz")):
            rows[name] = mesh.normals[part, k]
    if mesh.colours is not None:
        for k, name in enumerate(("red", "green", "blue")):
            rows[name] = mesh.colours[part, k]
    if mesh.uvs is not None:
        rows["s"], rows["t"] = mesh.uvs[part].T
    return rows


def _needs_double(mesh: TriMesh) -> bool:
    with np.errstate(over="ignore"):  # what float32 cannot hold is infinitely far off
        narrow = mesh.positions.astype(np.float32).astype(np.float64)
    off = np.abs(narrow - mesh.positions).max(initial=0)
    extent = np.ptp(mesh.positions, axis=0).max() if len(mesh.positions) else 0.0
    return bool(off > _SENSIBLE * extent)
