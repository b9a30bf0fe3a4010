"""Whatever is in a file, reading it gives a mesh or one sentence: every prefix, many damaged bytes."""

import zlib

import numpy as np
import pytest

from foveal.base.errors import FovealError
from foveal.mesh.io.source import read_mesh
from mesh.io import samples


def read_or_refuse(path):
    """The mesh, checked, or None after a sentence that names the file."""
    try:
        mesh = read_mesh(path)
    except FovealError as error:
        text = str(error)
        assert path.name in text
        assert text.endswith(".")
        assert "\n" not in text
        return None
    assert np.isfinite(mesh.positions).all()
    assert 0 <= mesh.faces.min() <= mesh.faces.max() < len(mesh.positions)
    return mesh


@pytest.mark.parametrize("name", samples.FILES)
def test_every_prefix_is_read_or_refused(name, tmp_path):
    data = samples.FILES[name]()
    path = tmp_path / name
    path.write_bytes(data)
    assert read_or_refuse(path) is not None
    step = 7 if name.endswith(".glb") else 1  # through trimesh, which is slow
    for length in range(0, len(data), step):
        path.write_bytes(data[:length])
        mesh = read_or_refuse(path)
        text_may_end_early = name in ("ascii.ply", "solid.obj", "solid.off", "ascii.stl")
        assert mesh is None or text_may_end_early


@pytest.mark.parametrize("name", samples.FILES)
def test_damaged_bytes_are_read_or_refused(name, tmp_path):
    data = samples.FILES[name]()
    path = tmp_path / name
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    rounds = 60 if name.endswith(".glb") else 300
    for turn in range(rounds):
        damaged = bytearray(data)
        for _ in range(1 + turn % 3):
            at = int(rng.integers(len(data)))
            damaged[at] = rng.integers(256) if turn % 2 else damaged[at] ^ (1 << int(rng.integers(8)))
        path.write_bytes(damaged)
        read_or_refuse(path)


@pytest.mark.parametrize("suffix", ["ply", "stl", "obj", "off", "glb", "gltf", "xyz", "gz", "dae", "3mf"])
def test_garbage_is_refused(suffix, tmp_path):
    rng = np.random.default_rng(0)
    path = tmp_path / f"garbage.{suffix}"
    for data in (
        rng.bytes(5000),
        b"\0" * 300,
        b"hello world, this is a letter\n" * 30,
        b"\xff\xfe" + b"a\0" * 80,
    ):
        path.write_bytes(data)
        assert read_or_refuse(path) is None
