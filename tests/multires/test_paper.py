"""The paper's codec: every triangle comes back, a plain twin reads the bytes, any bytes are safe."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import corpus
from foveal.base.errors import FovealError
from foveal.mesh.shapes import bumpy_sphere, grid_patch, icosphere, torus
from foveal.multires.codec import Patch, quantise_normals
from foveal.multires.paper import decode, encode, stream_sizes
from foveal.multires.paper.encode import _walk

from .paper_plain import decode as plain_decode

SPLIT = 4
OPTIONS = [{}, {"classes": "component", "word_bits": 8}, {"may_delay": False, "word_bits": 10}]


def patch_of(mesh, bits=11):
    """A mesh on a grid of 2^bits steps along its largest extent."""
    low = mesh.positions.min(axis=0)
    step = (mesh.positions.max(axis=0) - low).max() / (2**bits - 1) or 1.0
    positions = np.rint((mesh.positions - low) / step).astype(np.int32)
    normals = None if mesh.normals is None else quantise_normals(mesh.normals)
    return Patch(positions, mesh.faces, normals, mesh.colours)


def content(patch):
    """Triangles by what is at their corners, whatever the order of vertices, triangles and corners."""
    columns = [patch.positions, patch.normals, patch.colours]
    rows = np.concatenate([c.astype(np.int64) for c in columns if c is not None], axis=1)
    corners = [[tuple(row) for row in triangle] for triangle in rows[patch.faces].tolist()]
    turned = [min(t[k:] + t[:k] for k in range(3)) for t in corners]
    return sorted(turned), sorted(map(tuple, rows.tolist()))


def structure(patch):
    """Triangles as sets of vertex indices, with how many vertices there are; for one walk's order."""
    return len(patch.positions), len(patch.faces)


@pytest.mark.parametrize("options", OPTIONS, ids=lambda o: "-".join(map(str, o.values())) or "default")
@pytest.mark.parametrize("name", corpus.MESHES)
def test_every_triangle_and_vertex_comes_back(name, options):
    patch = patch_of(corpus.MESHES[name]())
    again = decode(encode(patch, **options))
    assert structure(again) == structure(patch)
    assert content(again) == content(patch)
    assert again.positions.dtype == again.faces.dtype == np.int32
    assert (again.normals is None) == (patch.normals is None)


@pytest.mark.parametrize("name", corpus.MESHES)
def test_indices_come_back_not_only_places(name):
    # Distinct "positions" tell the vertices apart even where they coincide in space.
    faces = corpus.MESHES[name]().faces
    n = int(faces.max()) + 1
    labels = np.random.default_rng(7).permutation(n).astype(np.int32)
    patch = Patch(np.stack([labels, labels * 0, -labels], axis=1), faces)
    assert content(decode(encode(patch))) == content(patch)


@pytest.mark.parametrize("name", [n for n in corpus.MESHES if n not in ("bumpy_sphere", "terrain")])
def test_a_plain_decoder_reads_the_same(name):
    mesh = corpus.MESHES[name]()
    patch = patch_of(mesh)
    data = encode(Patch(patch.positions, patch.faces), word_bits=8)
    positions, faces = plain_decode(data)
    fast = decode(data)
    assert fast.positions.tolist() == positions
    assert fast.faces.tolist() == [list(face) for face in faces]


triangles = st.integers(1, 12).flatmap(
    lambda n: st.lists(st.tuples(*[st.integers(0, n - 1)] * 3), max_size=30).map(lambda t: (n, t))
)


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")  # NumPy says so, kernels wrap
@given(triangles, st.booleans(), st.sampled_from(["vertex", "component"]), st.integers(0, 2**32))
@settings(deadline=None, max_examples=200)
def test_any_triangles_and_any_numbers_come_back(mesh, may_delay, classes, seed):
    n, faces = mesh
    rng = np.random.default_rng(seed)
    patch = Patch(
        rng.integers(-(2**31), 2**31, (n, 3)).astype(np.int32),
        np.array(faces, dtype=np.int32).reshape(-1, 3),
        rng.integers(-(2**15), 2**15, (n, 2)).astype(np.int16),
        rng.integers(0, 256, (n, 3)).astype(np.uint8),
    )
    data = encode(patch, classes=classes, may_delay=may_delay, word_bits=7)
    assert content(decode(data)) == content(patch)


def test_nothing_and_points_alone():
    for n in (0, 1, 5):
        patch = Patch(np.arange(3 * n, dtype=np.int32).reshape(n, 3), np.zeros((0, 3), np.int32))
        again = decode(encode(patch))
        np.testing.assert_array_equal(again.positions, patch.positions)
        assert again.faces.shape == (0, 3)


def test_a_quad_worked_by_hand():
    # The first triangle is three VERTEX (0); its first edge is a boundary (SKIP 3), as is the second,
    # and the third leads to the last vertex (VERTEX 0).
    _, corners, symbols, splits, _ = _walk(np.array([[0, 1, 2], [0, 2, 3]], np.int32), 4, True)
    assert symbols.tolist() == [0, 0, 0, 3, 3, 0]
    assert corners.tolist() == [[-1, -1, -1], [0, 0, 0], [1, 1, 1], [2, 0, 1]]
    assert len(splits) == 0


def test_spirals_with_delay_split_seldom():
    # One triangle in a hundred on large scans; a little more on small spheres, where the line along
    # which the front closes is long: the front is a disk, so each triangle of that line is a split.
    for mesh in (icosphere(4), torus(60, 40), bumpy_sphere(4)):
        _, _, symbols, _, _ = _walk(mesh.faces, len(mesh.positions), True)
        assert (symbols == SPLIT).mean() < 0.025
        assert len(symbols) < 1.2 * len(mesh.faces)


def test_a_flat_grid_costs_little_beyond_connectivity():
    mesh = grid_patch(40, 40)
    sizes = stream_sizes(Patch(np.rint(mesh.positions * 40).astype(np.int32), mesh.faces), word_bits=8)
    assert sizes["position raw bits"] + sizes["position classes"] < 0.1 * len(mesh.positions)


def test_stream_sizes_add_up():
    patch = patch_of(corpus.MESHES["with_all_attributes"]())
    for options in OPTIONS:
        assert sum(stream_sizes(patch, **options).values()) == len(encode(patch, **options))


def test_estimated_normals_are_near_the_true_ones():
    ball = icosphere(4)
    right = patch_of(type(ball).of(ball.positions, ball.faces, normals=ball.positions), bits=14)
    shuffled = Patch(right.positions, right.faces, right.normals[::-1].copy())
    per_vertex = [
        sum(v for k, v in stream_sizes(p).items() if k.startswith("normal")) * 8 / len(p.positions)
        for p in (right, shuffled)
    ]
    assert per_vertex[0] < 0.5 * per_vertex[1]


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")  # NumPy says so, kernels wrap
@pytest.mark.parametrize("name", ["two_triangles", "with_all_attributes", "degenerate_and_duplicate"])
def test_every_prefix_and_every_flipped_bit_is_safe(name):
    patch = patch_of(corpus.MESHES[name]())
    data = encode(patch, word_bits=8)
    step = 1 if len(data) < 500 else 7
    for end in range(0, len(data), step):
        with pytest.raises(FovealError):
            decode(data[:end])
    with pytest.raises(FovealError):
        decode(data + b"\0")
    for bit in range(0, 8 * len(data), step):
        damaged = bytearray(data)
        damaged[bit // 8] ^= 1 << bit % 8
        try:
            again = decode(bytes(damaged), max_vertices=5000, max_triangles=5000)
        except FovealError:
            continue
        assert not again.faces.size or 0 <= again.faces.min() <= again.faces.max() < len(again.positions)


@pytest.mark.filterwarnings("ignore:overflow encountered:RuntimeWarning")  # NumPy says so, kernels wrap
@given(st.binary(max_size=80))
@settings(deadline=None)
def test_any_bytes_are_safe(tail):
    for head in (b"", bytes([0, 8, 10]), bytes([7, 6, 4, 9, 5, 20]), bytes([1, 12, 14, 3, 1, 3, 0, 0, 0])):
        try:
            decode(head + tail, max_vertices=5000, max_triangles=5000)
        except FovealError:
            continue


def test_what_claims_too_much_is_refused():
    data = encode(patch_of(icosphere(2)))
    with pytest.raises(FovealError):
        decode(data, max_vertices=161)
    with pytest.raises(FovealError):
        decode(data, max_triangles=319)
    with pytest.raises(ValueError, match="word_bits"):
        encode(patch_of(icosphere(1)), word_bits=5)
    with pytest.raises(ValueError, match="faces"):
        encode(Patch(np.zeros((2, 3), np.int32), np.array([[0, 1, 2]], np.int32)))
