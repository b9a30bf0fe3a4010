"""Patch codec: round trips bit for bit, the plain twin, golden bytes, and every kind of damage."""

import json
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foveal.base.errors import FovealError
from foveal.multires.codec import Patch, Tables, decode, encode, train
from multires import naive_codec
from multires.codec_golden import FOLDER, expectation
from multires.codec_meshes import grid, meshes, patch, torus, unique_colours

MESHES = meshes()
TABLES = train(MESHES.values())


def decoded(data, like, tables=TABLES, **limits):
    return decode(
        data, tables, has_normals=like.normals is not None, has_colours=like.colours is not None, **limits
    )


def vertices(patch):
    """One tuple a vertex of all that it has."""
    columns = [patch.positions] + [c for c in (patch.normals, patch.colours) if c is not None]
    return list(map(tuple, np.concatenate([c.astype(np.int64) for c in columns], axis=1).tolist()))


def triangles(patch):
    """Each triangle as its vertices' tuples, rotated to begin with the least, sorted."""
    of = vertices(patch)
    corners = [[of[v] for v in face] for face in patch.faces.tolist()]
    return sorted(min(c[i:] + c[:i] for i in range(3)) for c in corners)


def assert_same(before, after):
    assert sorted(vertices(before)) == sorted(vertices(after))
    assert triangles(before) == triangles(after)
    assert (before.normals is None) == (after.normals is None)
    assert (before.colours is None) == (after.colours is None)


def assert_valid(patch):
    assert patch.faces.size == 0 or 0 <= patch.faces.min() <= patch.faces.max() < len(patch.positions)


@pytest.mark.parametrize("name", MESHES)
def test_what_goes_in_comes_out(name):
    before = MESHES[name]
    after = decoded(encode(before, TABLES), before)
    assert_same(before, after)
    assert after.positions.dtype == np.int32
    assert after.faces.dtype == np.int32


@pytest.mark.parametrize("name", MESHES)
def test_tables_of_other_patches_only_cost_bytes(name):
    tables = train([MESHES["tetrahedron"]])
    assert_same(MESHES[name], decoded(encode(MESHES[name], tables), MESHES[name], tables))


@pytest.mark.parametrize("name", MESHES)
def test_the_plain_decoder_agrees_number_by_number(name):
    before = MESHES[name]
    data = encode(before, TABLES)
    plain = naive_codec.decode(
        data,
        TABLES.to_bytes(),
        has_normals=before.normals is not None,
        has_colours=before.colours is not None,
    )
    fast = expectation(decoded(data, before))
    assert [list(map(list, part)) if part is not None else None for part in plain] == list(fast.values())


@given(
    st.integers(1, 30).flatmap(
        lambda n: st.lists(st.tuples(*[st.integers(0, n - 1)] * 3), max_size=60).map(lambda f: (n, f))
    ),
    st.integers(0, 2**32 - 1),
    st.integers(1, 31),
)
@settings(max_examples=60, deadline=None)
def test_any_soup_survives(soup, seed, bits):
    n, faces = soup
    rng = np.random.default_rng(seed)
    low = -(1 << (bits - 1)) if bits > 1 else 0
    positions = rng.integers(low, 1 << (bits - 1), (n, 3))
    before = patch(positions, faces, rng.integers(-512, 512, (n, 2)), unique_colours(n))
    data = encode(before, TABLES)
    after = decoded(data, before)
    assert_same(before, after)
    plain = naive_codec.decode(data, TABLES.to_bytes(), has_normals=True, has_colours=True)
    assert plain[0] == after.positions.tolist()


def test_golden_bytes_still_decode_to_the_same():
    tables = Tables.from_bytes((FOLDER / "patch_tables.bin").read_bytes())
    for name in MESHES:
        wanted = json.loads((FOLDER / f"patch_{name}.json").read_text())
        found = decode(
            (FOLDER / f"patch_{name}.bin").read_bytes(),
            tables,
            has_normals=wanted["normals"] is not None,
            has_colours=wanted["colours"] is not None,
        )
        assert expectation(found) == wanted, name


def test_tables_survive_their_bytes():
    again = Tables.from_bytes(TABLES.to_bytes())
    assert again.to_bytes() == TABLES.to_bytes()
    np.testing.assert_array_equal(again.slots, TABLES.slots)
    np.testing.assert_array_equal(again.all_weights, TABLES.all_weights)


def test_the_same_patches_give_the_same_bytes():
    assert train(MESHES.values()).to_bytes() == TABLES.to_bytes()
    assert encode(MESHES["torus"], TABLES) == encode(MESHES["torus"], TABLES)


@pytest.mark.parametrize("name", ["all", "non_manifold", "coarse"])
def test_every_prefix_is_refused(name):
    data = encode(MESHES[name], TABLES)
    for end in range(len(data)):
        with pytest.raises(FovealError, match="again"):
            decoded(data[:end], MESHES[name])


@pytest.mark.parametrize("name", ["holes", "non_manifold", "triangle", "coarse", "normals"])
def test_every_flipped_bit_is_refused_or_gives_a_valid_patch(name):
    data = encode(MESHES[name], TABLES)
    for bit in range(8 * len(data)):
        broken = bytearray(data)
        broken[bit >> 3] ^= 1 << (bit & 7)
        with suppress(FovealError):
            assert_valid(decoded(bytes(broken), MESHES[name], max_vertices=2000, max_triangles=2000))


@given(st.binary(max_size=200), st.integers(0, 127), st.integers(0, 127))
@settings(max_examples=300, deadline=None)
def test_any_bytes_are_refused_or_give_a_valid_patch(noise, n, m):
    data = bytes([n, m, 0]) + noise
    with suppress(FovealError):
        assert_valid(decode(data, TABLES, has_normals=True, has_colours=True))


def test_every_flipped_bit_of_the_tables_is_refused_or_harmless():
    before = MESHES["all"]
    good = TABLES.to_bytes()
    data = encode(before, TABLES)
    for bit in range(0, 8 * len(good), 5):
        broken = bytearray(good)
        broken[bit >> 3] ^= 1 << (bit & 7)
        with suppress(FovealError):
            assert_valid(decoded(data, before, Tables.from_bytes(bytes(broken))))


@pytest.mark.parametrize("end", [0, 1, 2, 100, 400, -1])
def test_tables_that_end_early_are_refused(end):
    with pytest.raises(FovealError, match="tables are damaged"):
        Tables.from_bytes(TABLES.to_bytes()[:end])
    with pytest.raises(FovealError, match="tables are damaged"):
        Tables.from_bytes(TABLES.to_bytes() + b"\0")


def test_a_patch_larger_than_allowed_is_refused_before_memory_is_taken():
    huge = b"\xff\xff\xff\xff\x07" * 2 + bytes(40)
    with pytest.raises(FovealError, match="larger than a file may hold"):
        decode(huge, TABLES, has_normals=False, has_colours=False)
    with pytest.raises(FovealError, match="larger than a file may hold"):
        decoded(encode(MESHES["torus"], TABLES), MESHES["torus"], max_triangles=575)


def large_torus(noise=1):
    points, _ = torus(240, 120, 20_000, seed=3)
    points = points + np.random.default_rng(4).normal(0, noise, points.shape)
    faces = grid(240, 120, around=True, along=True, flip=True)
    return Patch(np.rint(points).astype(np.int32), faces.astype(np.int32))


def bits_per_vertex(patch, tables):
    return 8 * len(encode(patch, tables)) / len(patch.positions)


def test_expected_normals_cost_next_to_nothing():
    before = MESHES["expected_normals"]
    tables = train([before])
    bare = Patch(before.positions, before.faces)
    assert len(encode(before, tables)) <= len(encode(bare, tables)) + 4


def test_a_coarse_grid_saves_its_bits():
    fine = large_torus()
    snapped = Patch((fine.positions + 8) >> 4 << 4, fine.faces)
    saved = bits_per_vertex(fine, train([fine])) - bits_per_vertex(snapped, train([snapped]))
    assert saved > 3 * 4 - 1


def test_regular_connectivity_is_nearly_free():
    flat = large_torus(0)
    positions = np.zeros_like(flat.positions)
    assert bits_per_vertex(Patch(positions, flat.faces), train([Patch(positions, flat.faces)])) < 2.5
