"""Opening a mesh file of any format, and reading it as blocks or as a whole."""

import os
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError

from ..trimesh import TriMesh
from .blocks import Blocks, FaceBlock, MeshSource, VertexBlock
from .detect import detect
from .obj import ObjSource
from .off import read_off
from .other import read_other
from .ply import PlySource
from .stl import StlSource

__all__ = ["mesh_of", "open_source", "read_mesh", "source_from_mesh"]


def open_source(path: str | os.PathLike[str], /, *, up: str | None = None) -> MeshSource:
    """Open a mesh file: PLY, STL, OBJ, OFF, and by trimesh GLB, glTF and more; each may be gzipped.

    The format is told from the content; the suffix decides where the content does not.

    Parameters
    ----------
    up : "x", "y" or "z", optional
        Which axis of the file points up; y where not said.

    Raises
    ------
    FovealError
        If there is no such file, or it is no mesh that can be read. What lies deeper in the file is
        found while its blocks are read.
    """
    if up not in (None, "x", "y", "z"):
        raise ValueError(f'up must be "x", "y" or "z", got {up!r}')
    path = Path(path)
    up = up or "y"
    kind = detect(path)
    if kind == "ply":
        return PlySource(path, up=up)
    if kind == "stl":
        return StlSource(path, up=up)
    if kind == "obj":
        return ObjSource(path, up=up)
    sizes = None
    if kind == "off":
        mesh, sizes, notes = read_off(path)
    else:
        mesh, notes = read_other(path, kind)
    source = _in_memory(mesh, path.name, up, sizes)
    source.notes += notes
    return source


def read_mesh(path: str | os.PathLike[str], /, *, up: str | None = None) -> TriMesh:
    """Read a whole mesh file into memory; formats and errors as for `open_source`.

    Vertices are those of the file, in its order; see `topology.weld` for what STL leaves apart.
    """
    return mesh_of(open_source(path, up=up))


def mesh_of(source: MeshSource, /) -> TriMesh:
    """All blocks of a source as one mesh in memory."""
    points: list[VertexBlock] = []
    faces = []
    with closing(source.blocks()) as blocks:
        for block in blocks:
            if isinstance(block, VertexBlock):
                points.append(block)
            else:
                faces.append(block.faces.astype(np.int32))
    return TriMesh(
        np.concatenate([b.positions for b in points]),
        np.concatenate(faces),
        np.concatenate([b.normals for b in points if b.normals is not None]) if source.has_normals else None,
        np.concatenate([b.colours for b in points if b.colours is not None]) if source.has_colours else None,
    )


_ROWS = 1 << 17  # of a block


@dataclass
class _MeshInMemory(MeshSource):
    mesh: TriMesh = field(kw_only=True)
    sizes: NDArray[np.int64] | None = field(kw_only=True, default=None)

    def blocks(self) -> Blocks:
        mesh = self.mesh
        for begin in range(0, len(mesh.positions), _ROWS):
            part = slice(begin, begin + _ROWS)
            yield VertexBlock(
                mesh.positions[part],
                None if mesh.normals is None else mesh.normals[part],
                None if mesh.colours is None else mesh.colours[part],
            )
        for begin in range(0, len(mesh.faces), _ROWS):
            faces = mesh.faces[begin : begin + _ROWS].astype(np.int64)
            self.bytes_read = self.size_hint * (begin + len(faces)) // len(mesh.faces)
            yield FaceBlock(faces, self.sizes if self.sizes is None or begin == 0 else self.sizes[:0])


def source_from_mesh(mesh: TriMesh, /, *, name: str = "mesh", up: str = "y") -> MeshSource:
    """A mesh in memory as a source, so that builders need to know sources only.

    Examples
    --------
    >>> from foveal.mesh.shapes import tetrahedron
    >>> [type(block).__name__ for block in source_from_mesh(tetrahedron()).blocks()]
    ['VertexBlock', 'FaceBlock']
    """
    if len(mesh.faces) == 0:
        raise FovealError(f"{name}: there is no triangle in it.")
    if up not in ("x", "y", "z"):
        raise ValueError(f'up must be "x", "y" or "z", got {up!r}')
    return _in_memory(mesh, name, up)


def _in_memory(mesh: TriMesh, name: str, up: str, sizes: NDArray[np.int64] | None = None) -> _MeshInMemory:
    return _MeshInMemory(
        name=name,
        up=up,
        has_normals=mesh.normals is not None,
        has_colours=mesh.colours is not None,
        size_hint=mesh.positions.nbytes + mesh.faces.nbytes,
        mesh=mesh,
        sizes=sizes,
    )
