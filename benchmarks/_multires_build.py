"""Building: size, speed a core, two threads, memory of a large one, a cold start, the command line."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from _shape import ROOT, Row, in_turns, seconds

from foveal import multires
from foveal.base.tasks import threads
from foveal.mesh import TriMesh

# Run in a process of its own, so that its peak is its own; prints seconds and the peak in GB.
BIG = """
import json, resource, sys, time
from foveal import multires
from foveal.mesh.shapes import stream_terrain
begin = time.perf_counter()
multires.build(stream_terrain(int(sys.argv[1])), sys.argv[2], memory_bytes=int(sys.argv[3]))
seconds = time.perf_counter() - begin
print(json.dumps([seconds, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9]))
"""


def size(mesh: TriMesh, case: str, folder: Path) -> Iterator[Row]:
    """Bits of the whole file for each vertex of the original, at the 11-bit step, without normals."""
    path = folder / "size.fov"
    report = multires.build(mesh, path, bits=11, normals="none")
    bits = 8 * path.stat().st_size / report.repairs.vertices
    yield Row("multires_bpv", case, bits, "bit/vertex", "lower", 27, peers={"nxz (note)": 33.2})


def speed(mesh: TriMesh, case: str, folder: Path, *, is_quick: bool) -> Iterator[Row]:
    """Million input triangles a second on one thread, and what a second thread adds."""
    import fast_simplification
    import numpy as np

    path = folder / "speed.fov"
    points, faces = mesh.positions.astype(np.float32), mesh.faces

    def build(workers: int) -> None:
        with threads(workers) as pool:
            multires.build(mesh, path, executor=pool, workers=workers)

    functions = {
        "one": lambda: build(1),
        "two": lambda: build(2),
        "fast_simplification": lambda: fast_simplification.simplify(points, faces, 0.5),
    }
    times = in_turns(functions, 1 if is_quick else 3)
    mtris = len(faces) / 1e6
    peers = {"fast_simplification to a half only": mtris / sorted(times["fast_simplification"])[0]}
    rates = [mtris / t for t in times["one"]]
    yield Row.of("build_mtris_per_core", case, rates, "Mtri/s", "higher", bar=0.2, peers=peers)
    ratios = [a / b for a, b in zip(times["one"], times["two"], strict=True)]
    yield Row.of("build_scaling_2", case, ratios, "x", "higher", bar=1.7)


def large(triangles: int, memory: int, *, is_full: bool) -> Iterator[Row]:
    """A generated terrain, built under a limit of memory, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-c", BIG, str(triangles), str(Path(folder) / "big.fov"), str(memory)]
        output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    took, peak = json.loads(output)
    case = f"terrain of {triangles / 1e6:.0f} M triangles"
    if is_full:
        yield Row("build_100m_s", case, took, "s", "lower", peers={"peak GB": peak})
    else:
        yield Row("build_14m_peak_gb", case, peak, "GB", "lower", 1.3, peers={"seconds": took})


def cold_start(bunny: Path, folder: Path) -> Iterator[Row]:
    """The first command ever: every kernel is compiled on the way."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        command = [
            sys.executable,
            "-m",
            "foveal",
            "build",
            str(bunny),
            "-o",
            str(folder / "cold.fov"),
            "--force",
        ]
        begin = time.perf_counter()
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        took = time.perf_counter() - begin
    says = "ompil" in done.stderr
    case = f"{bunny.name}, {'says what it does' if says else 'SILENT'}"
    yield Row("cold_build_s", case, took, "s", "lower", 45)


def command_line(fov: Path, *, is_quick: bool) -> Iterator[Row]:
    """Warm `--help` and `info`."""
    program = Path(sys.executable).with_name("foveal")
    for key, words, bar in (("help_s", ["--help"], 0.4), ("info_s", ["info", str(fov)], 0.7)):

        def call(words: list[str] = words) -> None:
            subprocess.run([str(program), *words], capture_output=True, check=True, cwd=ROOT)

        call()
        values = [seconds(call) for _ in range(3 if is_quick else 9)]
        yield Row.of(key, "warm", values, "s", "lower", bar=bar)
