# mypy: allow-untyped-defs, allow-untyped-calls
"""The cut's inner loops. Mirrored, operation by operation, in `viewer/src/select/cut.ts`.

Scratch of the heap: `heap[:size]` holds nodes, `keys[node]` their screen errors; the largest error is
at the top, of equals the lowest node.
"""

import numpy as np

from foveal.base.jit import lean


@lean
def _comes_first(keys, a, b):
    return keys[a] > keys[b] or (keys[a] == keys[b] and a < b)


@lean
def _push(heap, size, keys, node):
    at = size
    while at > 0:
        above = (at - 1) >> 1
        if not _comes_first(keys, node, heap[above]):
            break
        heap[at] = heap[above]
        at = above
    heap[at] = node
    return size + 1


@lean
def _pop(heap, size, keys):
    """Take the top away; the heap is one shorter."""
    size -= 1
    node = heap[size]
    at = 0
    while True:
        below = 2 * at + 1
        if below >= size:
            break
        if below + 1 < size and _comes_first(keys, heap[below + 1], heap[below]):
            below += 1
        if not _comes_first(keys, heap[below], node):
            break
        heap[at] = heap[below]
        at = below
    heap[at] = node
    return size


@lean
def screen_error(error, x, y, z, radius, eye, pixels_per_radian, near):
    """As `view.project.screen_error`, for one sphere."""
    if error <= 0.0:
        return 0.0
    dx = x - eye[0]
    dy = y - eye[1]
    dz = z - eye[2]
    distance = np.sqrt(dx * dx + dy * dy + dz * dz) - radius
    if distance <= 0.0:
        return np.inf
    return pixels_per_radian * error / max(distance, near)


@lean
def find_seen(centres, radii, errors, planes, seen):
    """Mark the nodes that may show, expanded or not: what stands for a node is within its error of it."""
    for node in range(len(radii)):
        reach = radii[node] + (errors[node] if errors[node] < np.inf else 0.0)
        inside = True
        for k in range(len(planes)):
            side = planes[k, 0] * centres[node, 0] + planes[k, 1] * centres[node, 1]
            if side + planes[k, 2] * centres[node, 2] + planes[k, 3] < -reach:
                inside = False
        seen[node] = inside


@lean
def shown_triangles(node, first_patch, finer, triangles, seen):
    """How many triangles a node adds when it is expanded and none of its children is."""
    total = 0
    for patch in range(first_patch[node], first_patch[node + 1]):
        if seen[finer[patch] if finer[patch] >= 0 else node]:
            total += triangles[patch]
    return total


@lean
def ideal_cut(
    bounds,
    view,
    patches,
    links,
    hidden,
    node_bytes,
    seen,
    error_px,
    triangle_budget,
    byte_budget,
    scratch,
    order,
):
    """Fill `order` with the nodes to expand were all of them at hand, falling in screen error.

    Returns their number and the largest screen error that is left. Stops at the first node that breaks
    a budget, so that a larger budget gives a longer run of the same sequence. `scratch` is the screen
    errors of the nodes that were looked at, the heap, and how many parents each node waits for.
    """
    centres, radii, errors = bounds
    keys, heap, pending = scratch
    eye, pixels_per_radian, near = view
    first_patch, finer, triangles = patches
    _, _, first_child, children = links
    size, count, worst = 0, 0, 0.0
    shown, held = 0, 0
    keys[0] = np.inf
    node = 0
    while True:
        order[count] = node
        count += 1
        shown += shown_triangles(node, first_patch, finer, triangles, seen) - hidden[node]
        held += node_bytes[node]
        for at in range(first_child[node], first_child[node + 1]):
            child = children[at]
            pending[child] -= 1
            if pending[child] > 0 or not seen[child]:
                continue
            x, y, z = centres[child, 0], centres[child, 1], centres[child, 2]
            keys[child] = screen_error(errors[child], x, y, z, radii[child], eye, pixels_per_radian, near)
            if keys[child] > error_px:
                size = _push(heap, size, keys, child)
            else:
                worst = max(worst, keys[child])
        if size == 0:
            return count, worst
        node = heap[0]
        more = shown_triangles(node, first_patch, finer, triangles, seen) - hidden[node]
        if shown + more > triangle_budget or held + node_bytes[node] > byte_budget:
            return count, max(worst, keys[node])
        size = _pop(heap, size, keys)


@lean
def real_cut(
    order, keys, worst, patches, links, hidden, node_bytes, seen, available, triangle_budget, expanded, wanted
):
    """Expand what is at hand of an ideal cut and list what is not.

    Returns (wanted nodes, triangles shown, bytes held, largest screen error left).
    """
    first_patch, finer, triangles = patches
    first_parent, parents, _, _ = links
    shown, held, missing = 0, 0, 0
    for node in order:
        is_ready = available[node]
        if not is_ready:
            wanted[missing] = node
            missing += 1
        for at in range(first_parent[node], first_parent[node + 1]):
            is_ready = is_ready and expanded[parents[at]]
        more = shown_triangles(node, first_patch, finer, triangles, seen) - hidden[node]
        # The root is shown whatever the budget. That a part of a cut within the budget is within it
        # too holds unless a patch is culled that its node's finer ones are not, so it is checked.
        if is_ready and (node == 0 or shown + more <= triangle_budget):
            expanded[node] = True
            shown += more
            held += node_bytes[node]
        else:
            worst = max(worst, keys[node])
    return missing, shown, held, worst


@lean
def drawn_patches(order, first_patch, finer, seen, expanded, drawn):
    """Fill `drawn` with the patches that stand in a cut, node by node; returns their number."""
    count = 0
    for node in order:
        if not expanded[node]:
            continue
        for patch in range(first_patch[node], first_patch[node + 1]):
            finer_node = finer[patch]
            if finer_node >= 0 and expanded[finer_node]:
                continue
            if seen[finer_node if finer_node >= 0 else node]:
                drawn[count] = patch
                count += 1
    return count
