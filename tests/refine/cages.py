"""Control meshes by what is particular about them: `CAGES[name]()`. Those in `CLOSED` have no border."""

import numpy as np

from foveal.mesh.poly_shapes import cube, prism, quad_grid, quad_torus
from foveal.mesh.polymesh import PolyMesh
from refine import naive_catmull_clark as twin


def edges_of(mesh):
    return twin.start(mesh).edges


def wavy(mesh, seed=0):
    rng = np.random.default_rng(seed)
    return mesh.positions + rng.normal(scale=0.1, size=mesh.positions.shape)


def creased(mesh, seed, boundary="edge_only"):
    """The mesh jolted, with tags of all kinds on about a third of its edges and some vertices."""
    rng = np.random.default_rng(seed)
    levels = [0.3, 1, 1.4, 2, np.inf, 10]
    edges = [e for e in edges_of(mesh) if rng.random() < 0.35]
    corners = np.flatnonzero(rng.random(len(mesh.positions)) < 0.15)
    faces = [ring.tolist() for ring in np.split(mesh.corners, mesh.starts[1:-1])]
    return PolyMesh.of(
        wavy(mesh, seed),
        faces,
        creases={e: rng.choice(levels) for e in edges},
        sharp_corners={int(v): rng.choice(levels) for v in corners},
        boundary=boundary,
    )


def valence_two():
    """A grid whose middle quadrangle is two, which share two edges and the vertex between."""
    mesh = quad_grid(3)
    faces = mesh.corners.reshape(-1, 4).tolist()
    a, b, c, d = faces.pop(4)
    faces += [[a, b, c, 16], [a, 16, c, d]]
    return PolyMesh.of(np.vstack([wavy(mesh), [0.5, 0.5, 0.1]]), faces)


CAGES = {
    "cube": cube,
    "prism": lambda: prism(5),
    "torus": lambda: quad_torus(5, 4),
    "grid": lambda: quad_grid(4, 3),
    "valence_two": valence_two,
    "one_triangle": lambda: PolyMesh.of([[9, 9, 9], *np.eye(3)], [[1, 2, 3]]),
    **{f"creased_cube_{seed}": lambda seed=seed: creased(cube(), seed) for seed in range(3)},
    "creased_prism": lambda: creased(prism(7), 3),
    "creased_grid": lambda: creased(quad_grid(4, 4), 4, "edge_and_corner"),
    "creased_torus": lambda: creased(quad_torus(4, 4), 5, "none"),
    "holes": lambda: creased(quad_grid(5, 4), 6, "none"),
}
CLOSED = [name for name in CAGES if not any(w in name for w in ("grid", "valence", "triangle", "holes"))]
