"""OpenSubdiv's Bfr over polygons, as a small C++ program that is built where the library is."""

from pathlib import Path

import numpy as np
from _refine_peers import Missing, run

from foveal.mesh import PolyMesh

__all__ = ["Missing", "bfr_catmark", "write"]


def write(mesh: PolyMesh, path: Path) -> Path:
    """The mesh as the program reads it."""
    counts = np.array([len(mesh.positions), mesh.faces, len(mesh.corners)], np.int32)
    sizes = np.diff(mesh.starts).astype(np.int32)
    parts = counts, mesh.positions, sizes, mesh.corners.astype(np.int32)
    path.write_bytes(b"".join(part.tobytes() for part in parts))
    return path


def bfr_catmark(mesh: Path, rate: int, runs: int) -> tuple[int, float]:
    """(triangles, milliseconds of the processor in the fastest of the runs)."""
    return run("bfr_catmark", mesh, rate, runs)
