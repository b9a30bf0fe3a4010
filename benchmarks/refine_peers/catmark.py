"""Catmull-Clark by a Python package, in a process of its own: catmark.py bpy|pymeshlab MESH STEPS

Prints triangles and milliseconds in its last line, of one processor where a process can be pinned to one.
Blender's subdivision modifier gives limit points, pymeshlab points of that step; neither gives limit normals.
MESH is as `_slates_peer.write` writes it.
"""

import os
import sys
import time
from collections.abc import Callable

import numpy as np

Read = tuple[np.ndarray, list[list[int]]]


def read(path: str) -> Read:
    """Positions and faces."""
    with open(path, "rb") as file:
        data = file.read()
    vertices, count, corners = np.frombuffer(data, np.int32, 3)
    positions = np.frombuffer(data, np.float64, 3 * vertices, 12).reshape(-1, 3)
    sizes = np.frombuffer(data, np.int32, count, 12 + positions.nbytes)
    index = np.frombuffer(data, np.int32, corners, 12 + positions.nbytes + sizes.nbytes)
    return positions, [face.tolist() for face in np.split(index, np.cumsum(sizes)[:-1])]


def by_blender(mesh: Read, steps: int) -> Callable[[], int]:
    """The subdivision modifier, with limit points."""
    import bpy

    data = bpy.data.meshes.new("cage")
    data.from_pydata(mesh[0].tolist(), [], mesh[1])
    thing = bpy.data.objects.new("cage", data)
    bpy.context.collection.objects.link(thing)
    modifier = thing.modifiers.new("surface", "SUBSURF")
    modifier.levels, modifier.use_limit_surface, modifier.quality = steps, True, 3
    bpy.context.view_layer.update()

    def subdivide() -> int:
        data.vertices[0].co.x += 1e-9  # what did not change is not made anew
        data.update()
        thing.update_tag()
        return 2 * len(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.polygons)

    return subdivide


def by_pymeshlab(mesh: Read, steps: int) -> Callable[[], int]:
    """Its filter, which tells of its steps on the way."""
    import pymeshlab

    def subdivide() -> int:
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=mesh[0], face_list_of_indices=mesh[1]))
        meshes.meshing_surface_subdivision_catmull_clark(iterations=steps)
        return int(meshes.current_mesh().face_number())

    return subdivide


def main() -> None:
    """The second of two runs."""
    name, path, steps = sys.argv[1:]
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    subdivide = {"bpy": by_blender, "pymeshlab": by_pymeshlab}[name](read(path), int(steps))
    subdivide()
    begin = time.process_time()
    triangles = subdivide()
    print(triangles, 1e3 * (time.process_time() - begin))


if __name__ == "__main__":
    main()
