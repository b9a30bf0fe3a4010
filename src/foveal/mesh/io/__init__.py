"""Files in and out: PLY, STL and OBJ by streaming readers, the rest through trimesh."""
