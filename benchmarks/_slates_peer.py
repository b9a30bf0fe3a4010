"""OpenSubdiv's Bfr, as a small C++ program that is built where the library is."""

import hashlib
import shutil
import subprocess
from pathlib import Path

import numpy as np
from _refine_models import CACHE
from _refine_peers import Missing

from foveal.mesh import PolyMesh

__all__ = ["Missing", "bfr_catmark", "write"]

SOURCE = Path(__file__).parent / "slates_peers" / "bfr_catmark.cpp"


def _program() -> Path:
    """Compiled once and kept in the user's cache; raises `Missing`."""
    compiler = shutil.which("g++")
    if compiler is None:
        raise Missing("no g++ to build it with")
    version = subprocess.run([compiler, "--version"], capture_output=True, check=True).stdout
    made = CACHE / f"bfr_catmark-{hashlib.sha256(version + SOURCE.read_bytes()).hexdigest()[:12]}"
    if not made.is_file():
        CACHE.mkdir(parents=True, exist_ok=True)
        part = made.with_suffix(".part")
        command = [compiler, "-O3", "-DNDEBUG", "-std=c++17", str(SOURCE), "-o", str(part), "-losdCPU"]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise Missing("OpenSubdiv 3.5 or newer is not installed, or does not build")
        part.rename(made)
    return made


def write(mesh: PolyMesh, path: Path) -> Path:
    """The mesh as the program reads it."""
    counts = np.array([len(mesh.positions), mesh.faces, len(mesh.corners)], np.int32)
    sizes = np.diff(mesh.starts).astype(np.int32)
    parts = counts, mesh.positions, sizes, mesh.corners.astype(np.int32)
    path.write_bytes(b"".join(part.tobytes() for part in parts))
    return path


def bfr_catmark(mesh: Path, rate: int, runs: int) -> tuple[int, float]:
    """(triangles, milliseconds of the processor in the fastest of the runs)."""
    command = [_program(), mesh, rate, runs]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True)
    triangles, ms = done.stdout.split()
    return int(triangles), float(ms)
