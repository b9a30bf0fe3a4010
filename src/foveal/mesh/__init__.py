"""Triangle and polygon meshes: the data structures, topology, normals, distance, reading and writing."""

from .io.blocks import FaceBlock, MeshSource, VertexBlock
from .io.polygons import read_polygons
from .io.source import open_source, read_mesh, source_from_mesh
from .polymesh import PolyMesh
from .trimesh import TriMesh

__all__ = [
    "FaceBlock",
    "MeshSource",
    "PolyMesh",
    "TriMesh",
    "VertexBlock",
    "open_source",
    "read_mesh",
    "read_polygons",
    "source_from_mesh",
]
