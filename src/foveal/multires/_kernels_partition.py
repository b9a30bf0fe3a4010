# mypy: allow-untyped-defs, allow-untyped-calls
"""Inner loops of the kD-trees that part a level into cells."""

import numpy as np

from foveal.base.jit import lean


@lean
def select(points, order, begin, end, axis, rank):
    """Reorder `order[begin:end]` such that the place `rank` holds what sorting by `axis` would put there.

    Equal coordinates are ordered by index, so that the result depends on nothing else.
    """
    while end - begin > 1:
        middle = order[(begin + end) // 2]
        pivot = points[middle, axis]
        i, j = begin, end - 1
        while i <= j:
            a = order[i]
            while points[a, axis] < pivot or (points[a, axis] == pivot and a < middle):
                i += 1
                a = order[i]
            b = order[j]
            while points[b, axis] > pivot or (points[b, axis] == pivot and b > middle):
                j -= 1
                b = order[j]
            if i <= j:
                order[i], order[j] = b, a
                i += 1
                j -= 1
        if rank <= j:
            end = j + 1
        elif rank >= i:
            begin = i
        else:
            return


@lean
def grow(points, order, limit, parity, low, high, nodes, planes, stack, boxes):
    """Split `points` by planes until no cell has more than `limit`: (nodes, cells).

    nodes[i] = (axis, left, right): a child below 0 is the cell -1 - child. planes[i] is where it is split.
    The share below a plane is 0.4 and 0.6 in turn with depth, beginning with 0.6 if `parity`
    (Ponchio 2015, section 3.2), on the longest side of the cell.
    """
    used, cells, top = 0, 0, 1
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = 0, len(order), 0, -1
    # Element by element: copies of slices took half of ten seconds to compile.
    for k in range(3):
        boxes[0, 0, k], boxes[0, 1, k] = low[k], high[k]
    while top > 0:
        top -= 1
        begin, end, depth, link = stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3]
        lx, ly, lz = boxes[top, 0, 0], boxes[top, 0, 1], boxes[top, 0, 2]
        hx, hy, hz = boxes[top, 1, 0], boxes[top, 1, 1], boxes[top, 1, 2]
        axis = np.int64(0)
        if hy - ly > hx - lx:
            axis = np.int64(1)
        if hz - lz > max(hx - lx, hy - ly):
            axis = np.int64(2)
        is_leaf = end - begin <= limit or len(stack) - top < 4 or used >= len(nodes)
        cut = begin
        if not is_leaf:
            share = 4 if (depth + parity) % 2 == 0 else 6
            rank = begin + (end - begin) * share // 10
            for _ in range(3):  # a side on which all coordinates are one cannot be split
                select(points, order, begin, end, axis, rank)
                plane = points[order[rank], axis]
                i, j = begin, end - 1
                while i <= j:
                    if points[order[i], axis] < plane:
                        i += 1
                    else:
                        order[i], order[j] = order[j], order[i]
                        j -= 1
                cut = i
                if cut > begin:
                    break
                axis = (axis + 1) % 3
            is_leaf = cut == begin
        index = -1 - cells if is_leaf else used
        if link >= 0:
            nodes[link // 2, 1 + link % 2] = index
        if is_leaf:
            cells += 1
            continue
        plane = points[order[cut], axis]
        for i in range(cut, end):
            plane = min(plane, points[order[i], axis])
        nodes[used, 0] = axis
        planes[used] = plane
        for side in (1, 0):  # the lower side is popped first
            stack[top, 0] = begin if side == 0 else cut
            stack[top, 1] = cut if side == 0 else end
            stack[top, 2] = depth + 1
            stack[top, 3] = 2 * used + side
            boxes[top, 0, 0], boxes[top, 0, 1], boxes[top, 0, 2] = lx, ly, lz
            boxes[top, 1, 0], boxes[top, 1, 1], boxes[top, 1, 2] = hx, hy, hz
            boxes[top, 1 - side, axis] = plane
            top += 1
        used += 1
    return used, cells


@lean
def box(positions, low, high):
    """Least and greatest coordinates. NumPy's min over rows of three takes ten times as long."""
    for axis in range(3):
        low[axis] = positions[0, axis]
        high[axis] = positions[0, axis]
    for v in range(1, len(positions)):
        for axis in range(3):
            low[axis] = min(low[axis], positions[v, axis])
            high[axis] = max(high[axis], positions[v, axis])


@lean
def corner_sums(positions, faces, first, stride, out):
    """out[i] = sum of the corners of face first + i stride: three times its centroid."""
    for i in range(len(out)):
        f = first + i * stride
        for axis in range(3):
            s = 0.0
            for k in range(3):
                s += positions[faces[f, k], axis]
            out[i, axis] = s


@lean
def assign(positions, faces, nodes, planes, out):
    """The cell of each face, by its centroid (times three, as the tree's points are)."""
    for f in range(len(faces)):
        if len(nodes) == 0:
            out[f] = 0
            continue
        node = 0
        while node >= 0:
            axis = nodes[node, 0]
            s = 0.0
            for k in range(3):
                s += positions[faces[f, k], axis]
            node = nodes[node, 1] if s < planes[node] else nodes[node, 2]
        out[f] = -1 - node
