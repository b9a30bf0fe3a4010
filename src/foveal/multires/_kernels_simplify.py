# mypy: allow-untyped-defs, allow-untyped-calls
"""Edge collapse by quadrics inside one cell: arrays in, arrays changed in place.

Based on: M. Garland, P. Heckbert. Surface simplification using quadric error metrics. SIGGRAPH 1997.
A quadric is 11 numbers: xx xy xz yy yz zz x y z 1 of the summed squared plane distances, then the area.
"""

import math

import numpy as np

from foveal.base.jit import kernel

#: A collapse costs at least this share of the squared distance between what it takes away and what it
#: leaves. The quadric's mean does not see a tip that goes: on the dragon at 11 bits (871 K triangles, seven
#: levels) the errors were 0.51 0.69 1.8 1.8 3.1 4.5 7.4 mm with planes by area, 0.43 0.62 1.1 1.6 2.5 5.7
#: 7.7 by its root, 0.24 0.37 0.49 0.69 0.93 1.3 3.2 with this too; on igea, which has nothing thin, a tenth
#: up or down either way; file size within 0.1 %, 3 to 8 % more time. 1 orders by extremes what is only
#: rough (igea's middle levels got a tenth to a third worse), 1/9 lets more of the dragon go (0.43 0.75 at
#: the second and third level). Adding up the distances of all collapses before was worse on both.
VANISHED = 0.25


@kernel
def incidence(faces, starts, counts, refs):
    """Faces around each vertex: `refs[starts[v]:starts[v] + counts[v]]`, a face once even if it repeats v."""
    counts[:] = 0
    for f in range(len(faces)):
        for k in range(3):
            counts[faces[f, k]] += 1
    total = 0
    for v in range(len(starts)):
        starts[v] = total
        total += counts[v]
        counts[v] = 0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        refs[starts[a] + counts[a]] = f
        counts[a] += 1
        if b != a:
            refs[starts[b] + counts[b]] = f
            counts[b] += 1
        if c != a and c != b:
            refs[starts[c] + counts[c]] = f
            counts[c] += 1


@kernel
def neighbours(faces, starts, counts, refs, out, is_border):
    """The face across each edge (k, k + 1), -1 at a border; a vertex of an edge with one face is border.

    Where more than two faces meet, one that runs along the edge the other way is preferred.
    """
    is_border[:] = False
    for f in range(len(faces)):
        for k in range(3):
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            found = -1
            pivot = a if counts[a] < counts[b] else b
            # A vertex with more faces than any sane one is not searched to its end: time would grow with
            # the square, and a neighbour that is not found costs no more than a border.
            for i in range(starts[pivot], starts[pivot] + min(counts[pivot], 2048)):
                g = refs[i]
                if g == f:
                    continue
                g0, g1, g2 = faces[g, 0], faces[g, 1], faces[g, 2]
                if (g0 == b and g1 == a) or (g1 == b and g2 == a) or (g2 == b and g0 == a):
                    found = g
                    break
                if (g0 == a or g1 == a or g2 == a) and (g0 == b or g1 == b or g2 == b):
                    found = g
            out[f, k] = found
            if found < 0:
                is_border[a] = True
                is_border[b] = True


@kernel
def add_plane(quadrics, v, nx, ny, nz, d, weight):
    """Add weight * (n . x + d)^2 to the quadric of v."""
    quadrics[v, 0] += weight * nx * nx
    quadrics[v, 1] += weight * nx * ny
    quadrics[v, 2] += weight * nx * nz
    quadrics[v, 3] += weight * ny * ny
    quadrics[v, 4] += weight * ny * nz
    quadrics[v, 5] += weight * nz * nz
    quadrics[v, 6] += weight * nx * d
    quadrics[v, 7] += weight * ny * d
    quadrics[v, 8] += weight * nz * d
    quadrics[v, 9] += weight * d * d


@kernel
def face_quadrics(positions, faces, across, border_weight, quadrics):
    """Quadrics of all vertices: planes of the faces, and a wall along each border edge.

    Planes weigh the root of the area: by the area itself the small triangles at the tips of thin features
    cost nothing beside their neighbours, and the tips go first (see `VANISHED`).
    """
    quadrics[:] = 0.0
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ux, uy, uz = (
            positions[b, 0] - positions[a, 0],
            positions[b, 1] - positions[a, 1],
            positions[b, 2] - positions[a, 2],
        )
        vx, vy, vz = (
            positions[c, 0] - positions[a, 0],
            positions[c, 1] - positions[a, 1],
            positions[c, 2] - positions[a, 2],
        )
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = math.sqrt(nx * nx + ny * ny + nz * nz)
        if length > 0.0:
            nx, ny, nz = nx / length, ny / length, nz / length
            d = -(nx * positions[a, 0] + ny * positions[a, 1] + nz * positions[a, 2])
            weight = math.sqrt(0.5 * length)
            for k in range(3):
                add_plane(quadrics, faces[f, k], nx, ny, nz, d, weight)
                quadrics[faces[f, k], 10] += weight
        for k in range(3):
            if across[f, k] >= 0:
                continue
            i, j = faces[f, k], faces[f, (k + 1) % 3]
            ex, ey, ez = (
                positions[j, 0] - positions[i, 0],
                positions[j, 1] - positions[i, 1],
                positions[j, 2] - positions[i, 2],
            )
            wx, wy, wz = ey * nz - ez * ny, ez * nx - ex * nz, ex * ny - ey * nx
            squared = wx * wx + wy * wy + wz * wz
            if length > 0.0 and squared > 0.0:
                size = math.sqrt(squared)
                inverse = 1.0 / size
                wx, wy, wz = wx * inverse, wy * inverse, wz * inverse
                d = -(wx * positions[i, 0] + wy * positions[i, 1] + wz * positions[i, 2])
                add_plane(quadrics, i, wx, wy, wz, d, border_weight * size)
                add_plane(quadrics, j, wx, wy, wz, d, border_weight * size)


@kernel
def place(positions, quadrics, locked, u, v, snap):
    """(cost, x, y, z) of the best place for the vertex that u and v become, on multiples of `snap`."""
    # Indexed, not sliced: a slice counts a reference, atomically.
    a, b, c = (
        quadrics[u, 0] + quadrics[v, 0],
        quadrics[u, 1] + quadrics[v, 1],
        quadrics[u, 2] + quadrics[v, 2],
    )
    d, e, f = (
        quadrics[u, 3] + quadrics[v, 3],
        quadrics[u, 4] + quadrics[v, 4],
        quadrics[u, 5] + quadrics[v, 5],
    )
    g, h, i = (
        quadrics[u, 6] + quadrics[v, 6],
        quadrics[u, 7] + quadrics[v, 7],
        quadrics[u, 8] + quadrics[v, 8],
    )
    ux, uy, uz = positions[u, 0], positions[u, 1], positions[u, 2]
    vx, vy, vz = positions[v, 0], positions[v, 1], positions[v, 2]
    ex, ey, ez = vx - ux, vy - uy, vz - uz
    squared = ex * ex + ey * ey + ez * ez
    if locked[u]:
        x, y, z = ux, uy, uz
    elif locked[v]:
        x, y, z = vx, vy, vz
    else:
        mx, my, mz = 0.5 * (ux + vx), 0.5 * (uy + vy), 0.5 * (uz + vz)
        # A little pull to the middle makes the system solvable on planes and along straight edges.
        pull = 1e-3 * (a + d + f) + 1e-300
        aa, dd, ff = a + pull, d + pull, f + pull
        gx = -g - (a * mx + b * my + c * mz)
        gy = -h - (b * mx + d * my + e * mz)
        gz = -i - (c * mx + e * my + f * mz)
        xx, xy, xz = dd * ff - e * e, c * e - b * ff, b * e - c * dd
        yy, yz, zz = aa * ff - c * c, b * c - aa * e, aa * dd - b * b
        inverse = 1.0 / (aa * xx + b * xy + c * xz)
        x = mx + (xx * gx + xy * gy + xz * gz) * inverse
        y = my + (xy * gx + yy * gy + yz * gz) * inverse
        z = mz + (xz * gx + yz * gy + zz * gz) * inverse
        far = (x - mx) * (x - mx) + (y - my) * (y - my) + (z - mz) * (z - mz)
        if not far <= 4.0 * squared:  # runs away along a needle, or is NaN
            x, y, z = mx, my, mz
        x = snap * math.floor(x / snap + 0.5)
        y = snap * math.floor(y / snap + 0.5)
        z = snap * math.floor(z / snap + 0.5)
    # Mean squared distance, not its integral: what counts is the worst place, not the volume. A trace of
    # the length lets short edges go first where all is flat.
    weight = quadrics[u, 10] + quadrics[v, 10]
    total = (
        x * (a * x + 2.0 * (b * y + c * z + g))
        + y * (d * y + 2.0 * (e * z + h))
        + z * (f * z + 2.0 * i)
        + quadrics[u, 9]
        + quadrics[v, 9]
    )
    cost = total / weight if weight > 0.0 else 0.0
    return max(cost, 0.0) + 1e-5 * squared, x, y, z


@kernel
def push(heap, size, key):
    """Put a key into the heap's array (least first) of `size` keys."""
    i = size
    while i > 0:
        parent = (i - 1) >> 1
        if heap[parent] <= key:
            break
        heap[i] = heap[parent]
        i = parent
    heap[i] = key


@kernel
def sift(heap, size, i, key):
    """Let `key` sink from place i of a heap of `size` keys."""
    while True:
        child = 2 * i + 1
        if child >= size:
            break
        if child + 1 < size and heap[child + 1] < heap[child]:
            child += 1
        if heap[child] >= key:
            break
        heap[i] = heap[child]
        i = child
    heap[i] = key


@kernel
def enqueue(heap, sizes, cost, slot):
    """Queue a slot by its cost."""
    # Bits of a float that is not negative are ordered as the float is; the slot breaks ties.
    bits = np.int64(np.float32(min(cost, 3e38)).view(np.int32))
    push(heap, sizes[0], (bits << 32) | slot)
    sizes[0] += 1


@kernel
def offer(positions, quadrics, locked, u, v, snap, versions, slots, heap, sizes):
    """Put the edge u, v into the queue. sizes: keys in the heap, slots used.

    A slot is (u, v, sum of their versions); (-1 - u, v, sum) once `collapse` has measured it.
    """
    if locked[u] and locked[v]:
        return
    cost, _, _, _ = place(positions, quadrics, locked, u, v, snap)
    slot = sizes[1]
    slots[slot, 0] = u
    slots[slot, 1] = v
    slots[slot, 2] = versions[u] + versions[v]
    sizes[1] = slot + 1
    enqueue(heap, sizes, cost, slot)


@kernel
def offer_all(
    positions, faces, alive, across, quadrics, locked, snap, versions, slots, heap, sizes, is_strict
):
    """Fill the empty queue with every edge, once where the surface is a proper one."""
    sizes[:] = 0
    for f in range(len(faces)):
        if not alive[f]:
            continue
        for k in range(3):
            # int64 here and below: one signature of `place` and `offer` to compile, not three.
            u, v = np.int64(faces[f, k]), np.int64(faces[f, (k + 1) % 3])
            if u < v or across[f, k] < 0 or not is_strict:
                offer(positions, quadrics, locked, u, v, snap, versions, slots, heap, sizes)


@kernel
def turns_over(positions, faces, alive, starts, counts, refs, u, v, x, y, z):
    """Whether a face of u that does not hold v would turn over, or vanish, with u at (x, y, z)."""
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if not alive[f]:
            continue
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        if a == v or b == v or c == v:
            continue
        if a == u:
            b, c = b, c
        elif b == u:
            b, c = c, a
        else:
            b, c = a, b
        ox, oy, oz = positions[b, 0], positions[b, 1], positions[b, 2]
        ex, ey, ez = positions[c, 0] - ox, positions[c, 1] - oy, positions[c, 2] - oz
        px, py, pz = positions[u, 0] - ox, positions[u, 1] - oy, positions[u, 2] - oz
        qx, qy, qz = x - ox, y - oy, z - oz
        nx, ny, nz = ey * pz - ez * py, ez * px - ex * pz, ex * py - ey * px
        mx, my, mz = ey * qz - ez * qy, ez * qx - ex * qz, ex * qy - ey * qx
        old = nx * nx + ny * ny + nz * nz
        new = mx * mx + my * my + mz * mz
        dot = nx * mx + ny * my + nz * mz
        if old > 0.0 and (dot <= 0.0 or dot * dot < 0.04 * old * new):
            return True
        # A needle hides its error in a tiny area and makes the next collapse worse.
        longest = max(ex * ex + ey * ey + ez * ez, qx * qx + qy * qy + qz * qz)
        if new < 1e-4 * longest * longest and new < old:
            return True
    return False


@kernel
def breaks_link(faces, alive, starts, counts, refs, valence, is_border, marks, stamp, u, v):
    """Whether joining u and v would change the surface's topology. Uses marks `stamp` and `stamp + 1`."""
    shared = 0
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if alive[f]:
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            marks[a] = stamp
            marks[b] = stamp
            marks[c] = stamp
            if a == v or b == v or c == v:
                shared += 1
    marks[u] = 0
    marks[v] = 0
    common = 0
    for i in range(starts[v], starts[v] + counts[v]):
        f = refs[i]
        if not alive[f]:
            continue
        for k in range(3):
            w = faces[f, k]
            if marks[w] == stamp:
                marks[w] = stamp + 1
                common += 1
                if valence[w] <= (2 if not is_border[w] else 1) + (1 if shared > 1 else 0):
                    return True  # w would be left with two faces back to back, or none
    if common != shared or shared == 0:
        return True
    if is_border[u] and is_border[v] and shared != 1:
        return True  # two borders would touch in a point
    left = valence[u] + valence[v] - 2 * shared
    return left < (1 if shared == 1 else 3)


@kernel
def squared_to_triangle(px, py, pz, ax, ay, az, bx, by, bz, cx, cy, cz):
    """Squared distance from a point to a triangle."""
    abx, aby, abz = bx - ax, by - ay, bz - az
    acx, acy, acz = cx - ax, cy - ay, cz - az
    apx, apy, apz = px - ax, py - ay, pz - az
    aa = abx * abx + aby * aby + abz * abz
    bb = abx * acx + aby * acy + abz * acz
    cc = acx * acx + acy * acy + acz * acz
    d = abx * apx + aby * apy + abz * apz
    e = acx * apx + acy * apy + acz * apz
    det = aa * cc - bb * bb
    s, t = cc * d - bb * e, aa * e - bb * d
    if s >= 0.0 and t >= 0.0 and s + t <= det and det > 0.0:
        s, t = s / det, t / det
        x, y, z = apx - s * abx - t * acx, apy - s * aby - t * acy, apz - s * abz - t * acz
        return x * x + y * y + z * z
    # On an edge: the least of the three, which is right wherever the point is outside.
    pp = apx * apx + apy * apy + apz * apz
    best = pp
    if d > 0.0:
        s = d / aa if d < aa else 1.0
        best = min(best, pp - 2.0 * s * d + s * s * aa)
    if e > 0.0:
        s = e / cc if e < cc else 1.0
        best = min(best, pp - 2.0 * s * e + s * s * cc)
    g = d - e - bb + cc  # (p - c) . (b - c)
    h = aa - 2.0 * bb + cc
    if g > 0.0:
        s = g / h if g < h else 1.0
        best = min(best, pp - 2.0 * e + cc - 2.0 * s * g + s * s * h)
    return max(best, 0.0)


@kernel
def vanished(positions, faces, alive, starts, counts, refs, u, v, x, y, z):
    """The larger squared distance of u and v from the faces that their collapse to (x, y, z) leaves."""
    best_u, best_v = math.inf, math.inf
    for side in range(2):
        here, other = (u, v) if side == 0 else (v, u)
        for i in range(starts[here], starts[here] + counts[here]):
            f = refs[i]
            if not alive[f]:
                continue
            a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
            if a == other or b == other or c == other:
                continue
            if b == here:
                b, c = c, a
            elif c == here:
                b, c = a, b
            bx, by, bz = positions[b, 0], positions[b, 1], positions[b, 2]
            cx, cy, cz = positions[c, 0], positions[c, 1], positions[c, 2]
            best_u = min(
                best_u,
                squared_to_triangle(
                    positions[u, 0], positions[u, 1], positions[u, 2], x, y, z, bx, by, bz, cx, cy, cz
                ),
            )
            best_v = min(
                best_v,
                squared_to_triangle(
                    positions[v, 0], positions[v, 1], positions[v, 2], x, y, z, bx, by, bz, cx, cy, cz
                ),
            )
    return max(best_u, best_v)


@kernel
def shared_faces(faces, alive, starts, counts, refs, u, v):
    """How many faces hold both u and v."""
    shared = 0
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if alive[f] and (faces[f, 0] == v or faces[f, 1] == v or faces[f, 2] == v):
            shared += 1
    return shared


@kernel
def blend(attributes, positions, u, v, x, y, z):
    """Attributes of the new vertex, by where it lies along the edge."""
    ex, ey, ez = (
        positions[v, 0] - positions[u, 0],
        positions[v, 1] - positions[u, 1],
        positions[v, 2] - positions[u, 2],
    )
    squared = ex * ex + ey * ey + ez * ez
    s = 0.5
    if squared > 0.0:
        dx, dy, dz = x - positions[u, 0], y - positions[u, 1], z - positions[u, 2]
        s = min(1.0, max(0.0, (dx * ex + dy * ey + dz * ez) / squared))
    for k in range(attributes.shape[1]):
        attributes[u, k] += np.float32(s) * (attributes[v, k] - attributes[u, k])


@kernel
def merge(faces, alive, starts, counts, refs, end, valence, u, v):
    """Rename v to u in all faces; what has both dies. u's list moves to `end`. Returns (died, end)."""
    died = 0
    begin = end
    for i in range(starts[u], starts[u] + counts[u]):
        f = refs[i]
        if not alive[f]:
            continue
        if faces[f, 0] == v or faces[f, 1] == v or faces[f, 2] == v:
            alive[f] = False
            died += 1
            for k in range(3):
                valence[faces[f, k]] -= 1
        else:
            refs[end] = f
            end += 1
    for i in range(starts[v], starts[v] + counts[v]):
        f = refs[i]
        if not alive[f]:
            continue
        for k in range(3):
            if faces[f, k] == v:
                faces[f, k] = u
        refs[end] = f
        end += 1
    starts[u] = begin
    counts[u] = end - begin
    valence[u] = end - begin
    valence[v] = 0
    counts[v] = 0
    return died, end


@kernel
def compact(alive, starts, counts, refs, fresh):
    """Copy the lists without dead faces into `fresh`; returns how much of it is used."""
    end = 0
    for v in range(len(starts)):
        begin = end
        for i in range(starts[v], starts[v] + counts[v]):
            if alive[refs[i]]:
                fresh[end] = refs[i]
                end += 1
        starts[v] = begin
        counts[v] = end - begin
    for i in range(end):  # a slice would take two seconds to compile
        refs[i] = fresh[i]
    return end


@kernel
def collapse(
    positions,
    faces,
    alive,
    starts,
    counts,
    refs,
    fresh,
    end,
    valence,
    is_border,
    quadrics,
    attributes,
    locked,
    snap,
    versions,
    slots,
    heap,
    sizes,
    marks,
    worst,
    stamp,
    live,
    target,
    is_strict,
):
    """Collapse cheapest edges until `target` faces live or the queue is empty: (live, end, stamp).

    Strict: no face turns over and the topology stays. Not strict: anything goes that keeps locked
    vertices; each edge of a closed surface still has an even number of faces, since renaming one vertex
    maps cycles to cycles.
    """
    while live > target and sizes[0] > 0:
        slot = heap[0] & 0xFFFFFFFF
        sizes[0] -= 1
        if sizes[0] > 0:
            sift(heap, sizes[0], 0, heap[sizes[0]])
        u, v = np.int64(slots[slot, 0]), np.int64(slots[slot, 1])
        is_measured = u < 0
        if is_measured:
            u = -1 - u
        if valence[u] == 0 or valence[v] == 0 or versions[u] + versions[v] != slots[slot, 2]:
            continue
        if locked[v]:
            u, v = v, u
        cost, x, y, z = place(positions, quadrics, locked, u, v, snap)
        if is_strict:
            stamp += 2
            if breaks_link(faces, alive, starts, counts, refs, valence, is_border, marks, stamp, u, v):
                continue
            if turns_over(positions, faces, alive, starts, counts, refs, u, v, x, y, z):
                continue
            if turns_over(positions, faces, alive, starts, counts, refs, v, u, x, y, z):
                continue
            if not is_measured:
                lost = VANISHED * vanished(positions, faces, alive, starts, counts, refs, u, v, x, y, z)
                if lost > cost:
                    slots[slot, 0] = -1 - slots[slot, 0]
                    enqueue(heap, sizes, lost, slot)
                    continue
        elif shared_faces(faces, alive, starts, counts, refs, u, v) >= live:
            continue  # a cell never becomes empty
        if end + counts[u] + counts[v] > len(refs):
            end = compact(alive, starts, counts, refs, fresh)
        if not locked[u]:
            blend(attributes, positions, u, v, x, y, z)
        died, end = merge(faces, alive, starts, counts, refs, end, valence, u, v)
        live -= died
        worst[0] = max(worst[0], cost)
        positions[u, 0] = x
        positions[u, 1] = y
        positions[u, 2] = z
        for k in range(11):
            quadrics[u, k] += quadrics[v, k]
        is_border[u] |= is_border[v]
        versions[u] += 1
        stamp += 2
        if sizes[1] + 3 * counts[u] > len(slots):
            break  # the caller fills the queue anew
        for i in range(starts[u], starts[u] + counts[u]):
            for k in range(3):
                w = np.int64(faces[refs[i], k])
                if w != u and marks[w] != stamp:
                    marks[w] = stamp
                    offer(positions, quadrics, locked, u, w, snap, versions, slots, heap, sizes)
    return live, end, stamp
