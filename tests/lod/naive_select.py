"""Slow, obvious twin of `foveal.lod.select`. Read this first when a cut looks wrong."""

import numpy as np

from foveal.view.project import screen_error, sphere_in_frustum


def cut(graph, camera, *, error_px, triangle_budget=None, byte_budget=None, available=None, is_culling=True):
    """The same as the real one, by asking at each step which node of all comes next."""
    nodes = range(len(graph.errors))
    key = screen_error(graph.errors, graph.centres, graph.radii, camera)
    reach = graph.radii + np.where(np.isfinite(graph.errors), graph.errors, 0)
    seen = sphere_in_frustum(graph.centres, reach, camera.frustum()) | (not is_culling)
    seen[0] = True

    def parents(node):
        return {int(graph.owner[p]) for p in np.flatnonzero(graph.finer == node)}

    def drawn(expanded, in_order):
        return [
            p
            for node in in_order
            if node in expanded
            for p in range(graph.first_patch[node], graph.first_patch[node + 1])
            if graph.finer[p] not in expanded and seen[graph.finer[p] if graph.finer[p] >= 0 else node]
        ]

    def fits(expanded):
        triangles = graph.triangles[drawn(expanded, sorted(expanded))].sum()
        size = sum(graph.node_bytes[node] for node in expanded)
        return (triangle_budget is None or triangles <= triangle_budget) and (
            byte_budget is None or size <= byte_budget
        )

    ideal = [0]
    while True:
        ready = [n for n in nodes if n not in ideal and seen[n] and parents(n) and parents(n) <= set(ideal)]
        ready = [n for n in ready if key[n] > error_px]
        if not ready:
            break
        best = min(ready, key=lambda n: (-key[n], n))
        if not fits({*ideal, best}):
            break
        ideal.append(best)

    at_hand = set(nodes) if available is None else set(np.flatnonzero(available).tolist())
    expanded = set()
    for node in ideal:
        is_ready = node in at_hand and parents(node) <= expanded
        if is_ready and (node == 0 or fits({*expanded, node})):
            expanded.add(node)
    standing = drawn(expanded, ideal)
    left = [n for n in nodes if n not in expanded and seen[n] and (n == 0 or parents(n) <= expanded)]
    return {
        "expanded": sorted(expanded),
        "drawn": standing,
        "wanted": [node for node in ideal if node not in at_hand],
        "triangles": int(graph.triangles[standing].sum()),
        "held_bytes": int(sum(graph.node_bytes[node] for node in expanded)),
        "error_px": float(max((key[n] for n in left), default=0.0)),
    }
