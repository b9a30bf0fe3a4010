# mypy: allow-untyped-defs, allow-untyped-calls
"""Connectivity: a region that grows triangle by triangle, the same walk when encoding and decoding.

The front is the boundary of the region: oriented edges in doubly linked lists held in an array, one
edge a row. An edge's number is its age, so the queue of active edges is a counter that runs through
the rows and passes by those that are done. The right edge of a VERTEX, and the new edge of a LEFT or
RIGHT, go before the queue: the region grows in spirals. Delayed edges come when the queue is empty.

`encode` and `decode` are one loop each, somewhat long, so that the two can be read side by side.
"""

import numpy as np

from foveal.base.jit import kernel

VERTEX = 0
"""The triangle beyond the edge has a vertex that is met for the first time."""
LEFT = 1
"""It also has the edge before this one."""
RIGHT = 2
"""It also has the edge after this one."""
SKIP = 3
"""There is no triangle, or it is in the region already."""
SPLIT = 4
"""VERTEX with a vertex met before, whose number follows in a stream of bits."""
DELAY = 5
"""It would be SPLIT: leave the edge until the queue is empty, by when it mostly is something else."""

# Columns of the front.
START, END, APEX, PREV, NEXT, DONE, HALF = range(7)


@kernel
def _add(front, e, start, end, apex, before, after, half):
    """Row `e` becomes an active edge between its neighbours `before` and `after`."""
    front[e, START] = start
    front[e, END] = end
    front[e, APEX] = apex
    front[e, PREV] = before
    front[e, NEXT] = after
    front[e, DONE] = 0
    front[e, HALF] = half
    front[before, NEXT] = e
    front[after, PREV] = e


@kernel
def _add_first(front, edges, a, b, c, half):
    """The three edges of a component's first triangle."""
    front[edges + 2, NEXT] = edges  # _add looks at neighbours, which here do not exist yet
    _add(front, edges, a, b, c, edges + 2, edges + 1, half)
    _add(front, edges + 1, b, c, a, edges, edges + 2, half + 1)
    _add(front, edges + 2, c, a, b, edges + 1, edges, half + 2)


@kernel
def _bits_for(count):
    """Bits that tell `count` things apart."""
    bits = 0
    while count > 1 << bits:
        bits += 1
    return bits


@kernel
def _meet(v, a, b, apex, ids, order, corners, symbols, splits, split_bits, counts):
    """Emit VERTEX or SPLIT for vertex `v`; returns its number. counts = vertices, symbols, splits."""
    if ids[v] >= 0:
        symbols[counts[1]] = SPLIT
        splits[counts[2]] = ids[v]
        split_bits[counts[2]] = _bits_for(counts[0])
        counts[2] += 1
    else:
        symbols[counts[1]] = VERTEX
        ids[v] = counts[0]
        order[counts[0]] = v
        corners[counts[0], 0] = a
        corners[counts[0], 1] = b
        corners[counts[0], 2] = apex
        counts[0] += 1
    counts[1] += 1
    return ids[v]


@kernel
def encode(
    faces, twins, front, visited, ids, order, corners, symbols, splits, split_bits, counts, delayed, may_delay
):
    """Walk over all triangles and write down the walk.

    faces (m, 3), twins (3 m); front (3 m, 7) and visited (m, zero) are scratch; ids (n, -1) gets each
    vertex's new number and order (n) the inverse; corners (n, 3) the three known vertices a, b, apex by
    which a new one is predicted as a + b - apex (a, a, a where a triangle is the first, -1 for the
    first of all); symbols (6 m), splits and split_bits (3 m), counts (3, zero).
    """
    edges = 0
    head = 0
    late = 0
    urgent = -1
    seed = 0
    done = 0
    while done < len(faces):
        if urgent >= 0:
            e = urgent
            urgent = -1
        else:
            while head < edges and front[head, DONE]:
                head += 1
            while head == edges and late < counts[3] and front[delayed[late], DONE] != 2:
                late += 1
            if head == edges and late == counts[3]:  # a new component
                while visited[seed]:
                    seed += 1
                visited[seed] = 1
                last = counts[0] - 1
                a = _meet(
                    faces[seed, 0], last, last, last, ids, order, corners, symbols, splits, split_bits, counts
                )
                b = _meet(faces[seed, 1], a, a, a, ids, order, corners, symbols, splits, split_bits, counts)
                c = _meet(faces[seed, 2], b, b, b, ids, order, corners, symbols, splits, split_bits, counts)
                _add_first(front, edges, a, b, c, 3 * seed)
                edges += 3
                done += 1
                continue
            e = head if head < edges else delayed[late]
        is_late = front[e, DONE] == 2
        front[e, DONE] = 1
        twin = twins[front[e, HALF]]
        if twin < 0 or visited[twin // 3]:
            symbols[counts[1]] = SKIP
            counts[1] += 1
            continue
        f = twin // 3
        visited[f] = 1
        done += 1
        a = front[e, START]
        b = front[e, END]
        before = front[e, PREV]
        after = front[e, NEXT]
        left_half = 3 * f + (twin + 1) % 3  # from a to the far vertex
        right_half = 3 * f + (twin + 2) % 3  # from the far vertex to b
        if twins[right_half] == front[after, HALF] and twins[right_half] >= 0:
            symbols[counts[1]] = RIGHT
            counts[1] += 1
            front[after, DONE] = 1
            _add(front, edges, a, front[after, END], b, before, front[after, NEXT], left_half)
            urgent = edges
            edges += 1
        elif twins[left_half] == front[before, HALF] and twins[left_half] >= 0:
            symbols[counts[1]] = LEFT
            counts[1] += 1
            front[before, DONE] = 1
            _add(front, edges, front[before, START], b, a, front[before, PREV], after, right_half)
            urgent = edges
            edges += 1
        else:
            far = faces[f, (twin + 2) % 3]
            if ids[far] >= 0 and may_delay and not is_late:
                visited[f] = 0
                done -= 1
                front[e, DONE] = 2
                delayed[counts[3]] = e
                counts[3] += 1
                symbols[counts[1]] = DELAY
                counts[1] += 1
                continue
            c = _meet(far, a, b, front[e, APEX], ids, order, corners, symbols, splits, split_bits, counts)
            _add(front, edges, a, c, b, before, e, left_half)
            _add(front, edges + 1, c, b, a, edges, after, right_half)
            urgent = edges + 1
            edges += 2


@kernel
def decode(symbols, splits, vertices, front, delayed, faces, corners):
    """Repeat the walk. Fills faces (m, 3) and corners (vertices, 3); front (3 m, 7) is scratch.

    Returns the number of vertices met and of splits used; -1 and 0 if the stream cannot be a walk.
    """
    edges = 0
    head = 0
    late = 0
    waiting = 0
    urgent = -1
    done = 0
    at = 0
    split = 0
    met = 0
    first = np.empty(3, np.int32)
    while done < len(faces):
        if urgent >= 0:
            e = urgent
            urgent = -1
        else:
            while head < edges and front[head, DONE]:
                head += 1
            while head == edges and late < waiting and front[delayed[late], DONE] != 2:
                late += 1
            if head == edges and late == waiting:  # a new component
                last = met - 1
                for k in range(3):
                    if at >= len(symbols):
                        return -1, 0
                    symbol = symbols[at]
                    at += 1
                    if symbol == VERTEX and met < vertices:
                        first[k] = met
                        corners[met, 0] = last
                        corners[met, 1] = last
                        corners[met, 2] = last
                        met += 1
                    elif symbol == SPLIT and split < len(splits) and splits[split] < met:
                        first[k] = splits[split]
                        split += 1
                    else:
                        return -1, 0
                    last = first[k]
                    faces[done, k] = last
                _add_first(front, edges, first[0], first[1], first[2], 0)
                edges += 3
                done += 1
                continue
            e = head if head < edges else delayed[late]
        if at >= len(symbols):
            return -1, 0
        symbol = symbols[at]
        at += 1
        front[e, DONE] = 1
        if symbol == SKIP:
            continue
        if symbol == DELAY:
            if waiting == len(delayed):
                return -1, 0
            front[e, DONE] = 2
            delayed[waiting] = e
            waiting += 1
            continue
        a = front[e, START]
        b = front[e, END]
        before = front[e, PREV]
        after = front[e, NEXT]
        faces[done, 0] = b
        faces[done, 1] = a
        if symbol == RIGHT:
            c = front[after, END]
            front[after, DONE] = 1
            _add(front, edges, a, c, b, before, front[after, NEXT], 0)
            urgent = edges
            edges += 1
        elif symbol == LEFT:
            c = front[before, START]
            front[before, DONE] = 1
            _add(front, edges, c, b, a, front[before, PREV], after, 0)
            urgent = edges
            edges += 1
        else:
            if symbol == VERTEX and met < vertices:
                c = met
                corners[met, 0] = a
                corners[met, 1] = b
                corners[met, 2] = front[e, APEX]
                met += 1
            elif symbol == SPLIT and split < len(splits) and splits[split] < met:
                c = splits[split]
                split += 1
            else:
                return -1, 0
            _add(front, edges, a, c, b, before, e, 0)
            _add(front, edges + 1, c, b, a, edges, after, 0)
            urgent = edges + 1
            edges += 2
        faces[done, 2] = c
        done += 1
    return (met, split) if at == len(symbols) else (-1, 0)
