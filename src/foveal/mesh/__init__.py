"""Triangle meshes: the data structure, topology, normals, distance, reading and writing."""

from .trimesh import TriMesh

__all__ = ["TriMesh"]
