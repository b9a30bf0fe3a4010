"""The `.fov` container: round trips, refusals in sentences, and no byte that can do harm."""

import json
import struct
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.container import create, layout, open_container


def write(path, chunks, first=b"graph", header=None):
    with create(path, kind="multires", version=1) as writer:
        for chunk in chunks:
            writer.add_chunk(chunk)
        writer.finish(header or {"generator": "test"}, first)
    return path.read_bytes()


@given(chunks=st.lists(st.binary(max_size=50), max_size=6), first=st.binary(max_size=20))
def test_what_goes_in_comes_out(tmp_path_factory, chunks, first):
    path = tmp_path_factory.mktemp("fov") / "a.fov"
    data = write(path, chunks, first, {"name": "Nike von Samothrake – Νίκη"})
    for source in (path, data):
        with open_container(source) as file:
            assert [file.chunk(i) for i in range(len(file))] == [first, *chunks]
            assert file.header["name"] == "Nike von Samothrake – Νίκη"
            assert (file.kind, file.version) == ("multires", 1)


def test_the_bytes_are_those_of_the_spec(tmp_path):
    data = write(tmp_path / "a.fov", [b"12345"], b"graph", {})
    header_bytes = struct.unpack_from("<I", data, 8)[0]
    assert data[:8] == b"FOV\x1a\x01\x00\x00\x00"
    assert struct.unpack_from("<I", data, 12)[0] == 2
    index_at = 20 + header_bytes
    assert index_at % 4 == 0
    assert struct.unpack_from("<IIII", data, index_at) == (5, zlib.crc32(b"graph"), 5, zlib.crc32(b"12345"))
    assert data[index_at + 16 :] == b"graph\0\0\x0012345\0\0\0"
    assert struct.unpack_from("<I", data, 16)[0] == zlib.crc32(data[20 : index_at + 16])


def test_first_bytes_reach_to_the_end_of_chunk_0(tmp_path):
    for size in range(90, 130):  # so that the digits of first_bytes change on the way
        data = write(tmp_path / "a.fov", [b"patch"], b"g" * size)
        with open_container(data) as file:
            assert file.header["first_bytes"] == file.offsets[0] + size


def test_every_truncated_prefix_and_every_extra_byte_is_refused(tmp_path):
    data = write(tmp_path / "a.fov", [b"first patch", b""])
    for end in range(len(data)):
        with pytest.raises(FovealError):
            open_container(data[:end])
    with pytest.raises(FovealError, match="bytes where its index tells"):
        open_container(data + b"\0")


def test_every_flipped_bit_is_refused_or_harmless(tmp_path):
    chunks = [b"first patch", b"second"]
    data = write(tmp_path / "a.fov", chunks)
    for bit in range(8 * len(data)):
        damaged = bytearray(data)
        damaged[bit // 8] ^= 1 << bit % 8
        try:
            with open_container(bytes(damaged)) as file:
                read = [file.chunk(i) for i in range(len(file))]
        except FovealError:
            continue
        assert read == [b"graph", *chunks]  # a reserved or padding byte


@pytest.mark.parametrize(
    ("position", "value", "sentence"),
    [(4, 2, "container version 2 is not known"), (8, 0xFFFFFFFF, "damaged"), (12, 0, "damaged")],
)
def test_impossible_prefixes_are_refused_with_a_sentence(tmp_path, position, value, sentence):
    data = bytearray(write(tmp_path / "a.fov", [b"x"]))
    struct.pack_into("<H" if position == 4 else "<I", data, position, value)
    with pytest.raises(FovealError, match=sentence):
        open_container(bytes(data))


@pytest.mark.parametrize(
    "text", [b"[]", b"{}", b"{", b"[" * 200000, b'{"kind": "multires", "version": true}', b"\xff"]
)
def test_a_header_that_tells_nothing_is_refused(text):
    text += b" " * layout.padding(len(text))
    entry = struct.pack("<II", 0, 0)
    data = layout.PREFIX.pack(layout.MAGIC, 1, 0, len(text), 1, zlib.crc32(text + entry)) + text + entry
    with pytest.raises(FovealError, match="header"):
        open_container(data)


def test_wrong_files_get_a_sentence(tmp_path):
    (tmp_path / "mesh.ply").write_text("ply\n")
    for path, sentence in [
        (tmp_path / "none.fov", "no such file"),
        (tmp_path, "folder"),
        (tmp_path / "mesh.ply", "not a .fov"),
    ]:
        with pytest.raises(FovealError, match=sentence):
            open_container(path)


def test_an_unknown_kind_and_an_unknown_version_are_refused(tmp_path):
    write(tmp_path / "a.fov", [])
    with open_container(tmp_path / "a.fov") as file:
        file.expect("multires", 1)
        with pytest.raises(FovealError, match="'multires', where 'points'"):
            file.expect("points", 1)
        with pytest.raises(FovealError, match="version 1 is not known to this foveal, which reads version 2"):
            file.expect("multires", 2)


def test_a_writer_that_fails_leaves_what_was_there(tmp_path):
    path = tmp_path / "a.fov"
    before = write(path, [b"old"])
    with pytest.raises(KeyboardInterrupt), create(path, kind="multires", version=1) as writer:
        writer.add_chunk(b"new")
        raise KeyboardInterrupt
    with pytest.raises(RuntimeError, match="finish"), create(path, kind="multires", version=1):
        pass
    assert path.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.fov"]


def test_the_header_is_json_without_nan(tmp_path):
    with pytest.raises(ValueError, match="JSON compliant"):
        write(tmp_path / "a.fov", [], header={"error": float("nan")})
    assert json.loads(b"1") == 1
