# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops over meshes: welding by hashing, normals."""

import numpy as np

from foveal.base.jit import kernel


@kernel
def weld_positions(bits, table, out):
    """out[i] = the number of vertex i's position in order of first appearance; how many there are.

    `bits` are positions as (n, 3) uint64, without -0; `table` a power of two of -1, over twice as long.
    """
    mask = np.uint64(len(table) - 1)
    owners = np.empty(len(bits), dtype=np.int32)  # the first vertex at each place
    count = 0
    for i in range(len(bits)):
        key = bits[i, 0] * np.uint64(0x9E3779B97F4A7C15)
        key = ((key >> np.uint64(29)) ^ key ^ bits[i, 1]) * np.uint64(0xBF58476D1CE4E5B9)
        key = ((key >> np.uint64(32)) ^ key ^ bits[i, 2]) * np.uint64(0x94D049BB133111EB)
        slot = (key ^ (key >> np.uint64(31))) & mask
        while True:
            place = table[slot]
            if place < 0:
                table[slot] = count
                owners[count] = i
                out[i] = count
                count += 1
                break
            j = owners[place]
            if bits[j, 0] == bits[i, 0] and bits[j, 1] == bits[i, 1] and bits[j, 2] == bits[i, 2]:
                out[i] = place
                break
            slot = (slot + np.uint64(1)) & mask
    return count


@kernel
def add_face_normals(positions, faces, out):
    """Add each triangle's cross product, twice its area long, to its three vertices in `out`."""
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux = positions[b, 0] - positions[a, 0]
        uy = positions[b, 1] - positions[a, 1]
        uz = positions[b, 2] - positions[a, 2]
        vx = positions[c, 0] - positions[a, 0]
        vy = positions[c, 1] - positions[a, 1]
        vz = positions[c, 2] - positions[a, 2]
        x = uy * vz - uz * vy
        y = uz * vx - ux * vz
        z = ux * vy - uy * vx
        for corner in range(3):
            v = faces[f, corner]
            out[v, 0] += x
            out[v, 1] += y
            out[v, 2] += z
