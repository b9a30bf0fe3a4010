"""One whole build in a process of its own: _shadows_fresh.py SCENE RESOLUTION, a line of JSON out.

From meshes in memory to the tree with its packed form, two threads, kernels warm; the file is written apart.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from _shadows_forms import file_bytes, nodes
from _shadows_scenes import scene

from foveal.base.tasks import threads
from foveal.mesh.shapes import icosphere
from foveal.shadows import build

__all__ = ["in_a_process"]


def in_a_process(name: str, resolution: int) -> dict[str, Any]:
    """Run this file: seconds, of phases too, peak_gb, bytes and nodes."""
    command = [sys.executable, __file__, name, str(resolution)]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def peak_gb() -> float:
    """The most that this process ever held.

    Linux counts in `ru_maxrss` what the parent held when it started this one; its own status does not.
    """
    status = Path("/proc/self/status")
    if status.is_file():
        lines = [line for line in status.read_text().splitlines() if line.startswith("VmHWM")]
        return int(lines[0].split()[1]) * 1024 / 1e9
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9


def main(name: str, resolution: int) -> None:
    """Build something small, which loads the kernels, then what was asked for."""
    found = scene(name)
    if found is None:
        raise SystemExit(f"{name} is not there")
    meshes, light = found
    with threads(2) as executor:
        _ = build(icosphere(3), light, resolution=1024, executor=executor).packed
        begin = time.perf_counter()
        shadow = build(meshes, light, resolution=resolution, executor=executor)
        packed = shadow.packed[0]
        seconds = time.perf_counter() - begin
    peak = peak_gb()
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        on_disk = file_bytes(shadow, Path(folder))
    result = {
        "seconds": seconds,
        "phases": shadow.times,
        "peak_gb": peak,
        "packed_bytes": packed.words.nbytes,
        "file_bytes": on_disk,
        "writing_seconds": time.perf_counter() - begin,
        "nodes": nodes(shadow.trees[0]),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
