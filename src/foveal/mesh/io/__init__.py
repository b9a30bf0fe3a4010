"""Files in and out: PLY, STL and OBJ by streaming readers, USD by usd-core, the rest through trimesh."""

from .blocks import FaceBlock, MeshSource, VertexBlock
from .glb_writer import write_glb
from .ply_writer import write_ply
from .polygons import read_polygons
from .source import open_source, read_mesh, source_from_mesh

__all__ = [
    "FaceBlock",
    "MeshSource",
    "VertexBlock",
    "open_source",
    "read_mesh",
    "read_polygons",
    "source_from_mesh",
    "write_glb",
    "write_ply",
]
