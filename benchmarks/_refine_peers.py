"""Other people's subdivision, as small C++ programs (benchmarks/refine_peers) and Python packages."""

import hashlib
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
from _refine_models import CACHE

from foveal.mesh import TriMesh
from foveal.view.camera import Camera

SOURCES = Path(__file__).parent / "refine_peers"
LIBRARIES = {
    "far_loop": ("-losdCPU",),
    "bfr_loop": ("-losdCPU",),
    "bfr_catmark": ("-losdCPU",),
    "openmesh_sqrt3": ("-lOpenMeshTools", "-lOpenMeshCore"),
}
HEADERS = {
    "far_loop": ("OpenSubdiv", "opensubdiv/far/primvarRefiner.h"),
    "bfr_loop": ("OpenSubdiv 3.5", "opensubdiv/bfr/tessellation.h"),
    "bfr_catmark": ("OpenSubdiv 3.5", "opensubdiv/bfr/tessellation.h"),
    "openmesh_sqrt3": ("OpenMesh", "OpenMesh/Tools/Subdivider/Adaptive/Composite/RulesT.hh"),
}


class Missing(Exception):
    """Why a peer cannot be had on this machine."""


def program(name: str) -> Path:
    """The program `name`, compiled once and kept in the user's cache; raises `Missing`."""
    compiler = shutil.which("g++")
    if compiler is None:
        raise Missing("no g++ to build it with")
    library, header = HEADERS[name]
    probe = subprocess.run(
        [compiler, "-E", "-x", "c++", "-", "-o", "-"],
        input=f"#include <{header}>\n",
        capture_output=True,
        text=True,
    )
    if probe.returncode:
        raise Missing(f"{library} is not installed")
    source = SOURCES / f"{name}.cpp"
    version = subprocess.run([compiler, "--version"], capture_output=True, check=True).stdout
    content = version + source.read_bytes() + (SOURCES / "peer.h").read_bytes()
    made = CACHE / f"{name}-{hashlib.sha256(content).hexdigest()[:12]}"
    if not made.is_file():
        CACHE.mkdir(parents=True, exist_ok=True)
        part = made.with_suffix(".part")
        command = [compiler, "-O3", "-DNDEBUG", "-std=c++17", str(source), "-o", str(part), *LIBRARIES[name]]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise Missing(f"{library} does not build: {done.stderr.splitlines()[-1]}")
        part.rename(made)
    return made


def write(mesh: TriMesh, path: Path) -> Path:
    """The mesh as the programs read it."""
    counts = np.array([len(mesh.positions), len(mesh.faces)], np.int32)
    path.write_bytes(counts.tobytes() + mesh.positions.tobytes() + mesh.faces.tobytes())
    return path


def run(name: str, mesh: Path, *words: object) -> tuple[int, float]:
    """(triangles, milliseconds) of a warm run."""
    command = [program(name), mesh, *words]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True)
    triangles, ms = done.stdout.split()
    return int(triangles), float(ms)


def by_view(name: str, mesh: Path, camera: Camera, edge_px: float) -> tuple[int, float]:
    """(triangles, milliseconds) of a program that refines what faces the eye to edges of so many pixels."""
    words = [repr(float(x)) for x in (*camera.position, camera.pixels_per_radian(), edge_px)]
    return run(name, mesh, *words)


def python_loops(mesh: TriMesh, levels: int) -> dict[str, Callable[[], object]]:
    """Uniform Loop by the Python packages that are there."""
    loops: dict[str, Callable[[], object]] = {}
    try:
        import igl

        loops["libigl"] = lambda: igl.loop(mesh.positions, mesh.faces.astype(np.int64), levels)
    except ImportError:
        pass
    from trimesh.remesh import subdivide_loop

    loops["trimesh"] = lambda: subdivide_loop(mesh.positions, mesh.faces, iterations=levels)
    return loops
