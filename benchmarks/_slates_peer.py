"""Others that subdivide polygons, where they are there.

OpenSubdiv's Bfr is a small C++ program; Python packages have a process of their own.
"""

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from _refine_peers import Missing, run

from foveal.mesh import PolyMesh

__all__ = ["PACKAGES", "Missing", "bfr_catmark", "package_catmark", "write"]

PACKAGES = {"bpy": "Blender", "pymeshlab": "pymeshlab"}


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


def package_catmark(name: str, mesh: Path, steps: int) -> tuple[int, float]:
    """(triangles, milliseconds of the processor in the second of two runs) of a Python package."""
    if find_spec(name) is None:
        raise Missing(f"{name} is not installed")
    command = [sys.executable, Path(__file__).parent / "refine_peers/catmark.py", name, mesh, steps]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True)
    triangles, ms = done.stdout.splitlines()[-1].split()
    return int(triangles), float(ms)
