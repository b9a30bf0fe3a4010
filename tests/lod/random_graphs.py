"""Graphs built as real ones are: a surface of atoms, partitioned anew at each level, halved each time.

An atom stands for a piece of the original surface. Whatever the cut, each atom must be shown by exactly
one patch: that is what "neither crack nor overlap" means here.
"""

from dataclasses import dataclass

import numpy as np

from foveal.lod.graph import Graph


@dataclass(frozen=True)
class Model:
    """A graph with the atoms (sets of indices) that each of its patches covers."""

    graph: Graph
    atoms: int
    covers: list[np.ndarray]


def _cells(points, wanted, rng):
    """Leaves of a kD-tree with random split ratios, as lists of points."""
    cells = [np.arange(len(points))]
    while len(cells) < wanted:
        largest = max(range(len(cells)), key=lambda i: len(cells[i]))
        cell = cells.pop(largest)
        if len(cell) < 2:
            return [*cells, cell]
        axis = int(np.ptp(points[cell], axis=0).argmax())
        cell = cell[np.argsort(points[cell, axis], kind="stable")]
        at = min(max(1, int(len(cell) * rng.uniform(0.4, 0.6))), len(cell) - 1)
        cells += [cell[:at], cell[at:]]
    return cells


def random_model(seed, *, atoms=120, leaves=16, zero_errors=False, error_scale=1.0):
    """Node (level, cell) shows the level's surface in its cell, in patches cut by the finer partition."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(atoms, 3)) * [3, 1, 2]
    partitions = [_cells(points, leaves, rng)]
    while len(partitions[-1]) > 1:
        partitions.append(_cells(points, (len(partitions[-1]) + 1) // 2, rng))
    levels = len(partitions)

    index, order = {}, []
    for level in reversed(range(levels)):
        for cell in range(len(partitions[level])):
            index[level, cell] = len(order)
            order.append((level, cell))
    nodes = [[] for _ in order]  # (finer, atoms, triangles) of each patch
    children = [set() for _ in order]
    for (level, cell), node in index.items():
        inside = partitions[level][cell]
        below = partitions[level - 1] if level else [inside]
        for finer_cell, finer_atoms in enumerate(below):
            shared = np.intersect1d(inside, finer_atoms)
            if len(shared):
                finer = index[level - 1, finer_cell] if level else -1
                nodes[node].append((finer, shared, max(1, int(len(shared) * 40 / 2**level))))
                children[node] |= {finer} - {-1}

    centres, radii = np.zeros((len(order), 3), np.float32), np.zeros(len(order), np.float32)
    errors = np.zeros(len(order), np.float32)
    for node in reversed(range(len(order))):
        own = points[partitions[order[node][0]][order[node][1]]]
        centres[node] = own.mean(axis=0)
        away = [np.linalg.norm(own - centres[node], axis=1).max()]
        away += [np.linalg.norm(centres[c] - centres[node]) + radii[c] for c in children[node]]
        radii[node] = np.nextafter(np.float32(max(away)), np.float32(np.inf)) * np.float32(1.000001)
        below = max((float(errors[c]) for c in children[node]), default=0.0)
        grown = 0.0 if zero_errors and rng.random() < 0.5 else rng.uniform(0.001, 0.01) * error_scale
        errors[node] = below * rng.uniform(1, 2.5) + grown
    errors[0] = np.inf
    patches = [patch for node in nodes for patch in node]
    triangles = np.array([p[2] for p in patches])
    graph = Graph(
        centres.astype(np.float64),
        radii.astype(np.float64),
        errors.astype(np.float64),
        np.cumsum([0] + [len(node) for node in nodes]),
        np.array([p[0] for p in patches], dtype=np.int32),
        triangles,
        triangles // 2 + 3,
        triangles * 3 + rng.integers(0, 9, len(triangles)),
    )
    return Model(graph, atoms, [p[1] for p in patches])


def random_view(rng, camera_class):
    """A camera somewhere in or about a model of this file."""
    eye = rng.normal(size=3) * rng.choice([0.5, 4.0, 20.0, 100.0])
    return camera_class.of(
        eye,
        eye + rng.normal(size=3) - rng.choice([0.0, 0.5]) * eye,
        up=rng.normal(size=3),
        field_of_view=rng.uniform(0.2, 1.8),
        width=int(rng.integers(100, 2000)),
        height=int(rng.integers(100, 2000)),
        near=rng.uniform(0.001, 0.1),
    )
