"""The door of polygon meshes: what it takes, how it puts tags in order, what it refuses."""

import numpy as np
import pytest

import corpus
from foveal.base.errors import FovealError
from foveal.mesh.poly_shapes import cube, prism, quad_grid, quad_torus
from foveal.mesh.polymesh import PolyMesh

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
HOUSE = [*SQUARE, [0.5, 2, 0]]
ROOF = [[0, 1, 2, 3], [3, 2, 4]]
SHAPES = {
    "cube": (cube, 8, 12, 6, 2),
    "prism": (lambda: prism(5), 10, 15, 7, 2),
    "quad_torus": (lambda: quad_torus(7, 4), 28, 56, 28, 0),
    "quad_grid": (lambda: quad_grid(4, 3), 20, 31, 12, 1),
}


def faces_of(mesh):
    return [ring.tolist() for ring in np.split(mesh.corners, mesh.starts[1:-1])]


def edges_of(mesh):
    halves = [half for ring in faces_of(mesh) for half in zip(ring, ring[1:] + ring[:1], strict=True)]
    assert len(set(halves)) == len(halves)
    return {tuple(sorted(half)) for half in halves}


def is_surface(faces):
    """Each half-edge once, each vertex once a face, and around each vertex one chain or one ring of faces."""
    following = [dict(zip(ring, ring[1:] + ring[:1], strict=True)) for ring in faces]
    halves = [half for face in following for half in face.items()]
    if len(set(halves)) < len(halves) or any(
        len(face) < len(ring) for face, ring in zip(following, faces, strict=True)
    ):
        return False
    before = {(f, v): u for f, face in enumerate(following) for u, v in face.items()}
    side = {half: f for f, face in enumerate(following) for half in face.items()}
    for v in {v for ring in faces for v in ring}:
        here = {f for f, face in enumerate(following) if v in face}
        first = next(
            (f for f in here if (following[f][v], v) not in side), min(here)
        )  # at the border, or any
        seen, f = set(), first
        while f is not None and f not in seen:
            seen.add(f)
            f = side.get((v, before[f, v]))
        if seen != here:
            return False
    return True


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_are_surfaces_of_the_counts_they_tell(name):
    make, vertices, edges, faces, euler = SHAPES[name]
    mesh = make()
    assert (len(mesh.positions), len(edges_of(mesh)), mesh.faces) == (vertices, edges, faces)
    assert vertices - edges + faces == euler


@pytest.mark.parametrize("name", ["cube", "prism", "quad_torus"])
def test_closed_shapes_have_their_volume_inside(name):
    corners = SHAPES[name][0]().triangulated()
    a, b, c = corners.positions[corners.faces].transpose(1, 0, 2)
    volume = (a * np.cross(b, c)).sum() / 6
    assert volume > 0
    if name == "cube":
        assert volume == pytest.approx(8)


def test_triangles_come_in_and_go_out_as_they_were():
    mesh = corpus.MESHES["coloured"]()
    back = PolyMesh.of_triangles(mesh).checked().triangulated()
    np.testing.assert_array_equal(back.positions, mesh.positions)
    np.testing.assert_array_equal(back.faces, mesh.faces)
    np.testing.assert_array_equal(back.colours, mesh.colours)
    assert back.colours.dtype == np.uint8


def test_a_polygon_becomes_a_fan_around_its_first_corner():
    mesh = PolyMesh.of([*SQUARE, [-1, 0.5, 0]], [[4, 0, 1, 2, 3]])
    assert mesh.triangulated().faces.tolist() == [[4, 0, 1], [4, 1, 2], [4, 2, 3]]


def test_arrays_become_contiguous_and_of_the_right_types():
    mesh = PolyMesh(
        np.asfortranarray(np.array(HOUSE, np.float32)),
        np.array([0, 4, 7], np.uint64),
        np.array([0, 1, 2, 3, 3, 2, 4], np.int16),
        [[3, 2]],
        [2],
        (4, 0),
        [np.inf, 0.5],
        "none",
        np.eye(5)[:, :3] * 255,
        np.array(HOUSE)[:, :2],
    ).checked()
    kinds = [getattr(mesh, name).dtype for name in mesh.__slots__ if name != "boundary"]
    real, small, index = np.float64, np.float32, np.int32
    assert kinds == [real, index, index, index, small, index, small, small, small, index]
    assert mesh.positions.flags.c_contiguous
    assert (mesh.crease_edges.tolist(), mesh.crease_sharpness.tolist()) == ([[2, 3]], [2])
    assert (mesh.corner_vertices.tolist(), mesh.corner_sharpness.tolist()) == ([0, 4], [0.5, np.inf])


def test_the_last_tag_of_an_edge_holds_whichever_way_it_runs():
    mesh = PolyMesh.of(HOUSE, ROOF, creases={(3, 2): 1, (0, 1): 3, (2, 3): 2.5}, sharp_corners={4: 1e300})
    assert mesh.crease_edges.tolist() == [[0, 1], [2, 3]]
    assert mesh.crease_sharpness.tolist() == [3, 2.5]
    assert mesh.corner_sharpness.tolist() == [np.inf]


def test_checking_again_changes_nothing():
    mesh = PolyMesh.of(HOUSE, ROOF, creases={(3, 2): 1}, boundary="edge_and_corner", uvs=np.eye(5)[:, :2])
    again = mesh.checked()
    for name in mesh.__slots__:
        np.testing.assert_array_equal(getattr(again, name), getattr(mesh, name))


def test_unused_vertices_and_back_to_back_faces_are_no_fault():
    assert PolyMesh.of([[9, 9, 9], *SQUARE], [[1, 2, 3, 4]]).faces == 1
    assert PolyMesh.of(SQUARE, [[0, 1, 2, 3], [3, 2, 1, 0]]).faces == 2


def mutant(faces, count, rng):
    """The faces with some corners renamed, faces left out, turned over or given twice."""
    faces = [list(ring) for ring in faces]
    for _ in range(int(rng.integers(1, 4))):
        at = int(rng.integers(len(faces)))
        kind = rng.choice(["rename", "leave", "turn", "twice", "merge"], p=[0.2, 0.4, 0.1, 0.1, 0.2])
        if kind == "leave" and len(faces) > 1:
            del faces[at]
        elif kind == "turn":
            faces[at].reverse()
        elif kind == "twice":
            faces.append(faces[at][::-1])
        elif kind == "rename":
            faces[at][0] = int(rng.integers(count))
        elif kind == "merge":
            a, b = rng.integers(count, size=2).tolist()
            faces = [[a if v == b else v for v in ring] for ring in faces]
    return faces


@pytest.mark.parametrize("name", SHAPES)
def test_the_door_lets_in_what_a_slow_look_finds_to_be_a_surface(name):
    mesh = SHAPES[name][0]()
    rng = np.random.default_rng(7)
    verdicts = []
    for _ in range(400):
        faces = mutant(faces_of(mesh), len(mesh.positions), rng)
        try:
            assert faces_of(PolyMesh.of(mesh.positions, faces)) == faces
            verdicts.append(True)
        except FovealError:
            verdicts.append(False)
        assert verdicts[-1] == is_surface(faces), faces
    assert 40 < sum(verdicts) < 360


NAN = [[0, 0, 0], [1, 0, 0], [np.nan, 1, 0], [0, 1, 0]]
BOOK = [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
BOW_TIE = [[0, 1, 2], [0, 3, 4]]


@pytest.mark.parametrize(
    ("positions", "faces", "tags", "sentence"),
    [
        (HOUSE, BOOK, {}, "the edge between vertices 0 and 1 has more than two faces"),
        (HOUSE, [[0, 1, 2, 3], [2, 3, 4]], {}, "at the edge between vertices 2 and 3 face opposite sides"),
        (HOUSE, BOW_TIE, {}, "at vertex 0 several fans of faces touch"),
        (SQUARE, [[0, 1, 2, 3], [3, 1, 3, 0]], {}, "face 1 has vertex 3 twice"),
        (SQUARE, [[0, 1, 2, 3], [0, 1]], {}, "face 1 has 2 corners"),
        (SQUARE, [[0, 1, 2], []], {}, "face 1 has 0 corners"),
        (NAN, [[0, 1, 3]], {}, "vertex 2 has a coordinate that is NaN or infinite"),
        (SQUARE, [[0, 1, 2, 3], [0, 3, 4]], {}, "face 1 names vertex 4, but vertices go from 0 to 3"),
        (SQUARE, [[0, 1, -1]], {}, "face 0 names vertex -1"),
        (SQUARE, [[0, 1, 2**40]], {}, "face 0 names vertex 1099511627776"),
        (SQUARE, [[0, 1, 0.5]], {}, "face 0 must be integers"),
        (SQUARE, np.array([0, 1, 2]), {}, "faces must be integers of shape"),
        (SQUARE, [], {}, "there is no face in it"),
        ([[0, 0]], [[0, 1, 2]], {}, "positions must be real numbers of shape"),
        (SQUARE, [[0, 1, 2, 3]], {"creases": {(2, 0): 1}}, "no edge between vertices 2 and 0 that could be"),
        (SQUARE, [[0, 1, 2, 3]], {"creases": {(-1, 3): 1}}, "no edge between vertices -1 and 3"),
        (
            SQUARE,
            [[0, 1, 2, 3]],
            {"creases": {(0, 1): -1}},
            "between vertices 0 and 1 has the sharpness -1.0",
        ),
        (SQUARE, [[0, 1, 2, 3]], {"creases": {(0, 1): np.nan}}, "0 and 1 has the sharpness nan"),
        (SQUARE, [[0, 1, 2, 3]], {"sharp_corners": {4: 1}}, "no vertex 4 that could be a sharp corner"),
        (SQUARE, [[0, 1, 2, 3]], {"sharp_corners": {1: -2}}, "the corner at vertex 1 has the sharpness -2.0"),
        (SQUARE, [[0, 1, 2, 3]], {"boundary": "edges"}, "the boundary must be .* got 'edges'"),
        (SQUARE, [[0, 1, 2, 3]], {"uvs": [[0, 0]]}, r"uvs must be real numbers of shape \(4, 2\)"),
        (SQUARE, [[0, 1, 2, 3]], {"uvs": [[0, np.inf]] * 4}, "the uvs of vertex 0 are NaN or infinite"),
        (SQUARE, [[0, 1, 2, 3]], {"colours": [[0, 0, 256]] * 4}, "colours must be from 0 to 255"),
    ],
)
def test_faults_are_told_in_a_sentence(positions, faces, tags, sentence):
    with pytest.raises(FovealError, match=f"^house.obj: .*{sentence}"):
        PolyMesh.of(positions, faces, **tags, name="house.obj")


@pytest.mark.parametrize("starts", [[], [0], [1, 4], [0, 3], [0, 5]])
def test_starts_must_hold_all_corners(starts):
    with pytest.raises(FovealError, match=r"starts must go|no face"):
        PolyMesh(np.array(SQUARE), np.array(starts), np.arange(len(starts) > 1 and 4)).checked()


@pytest.mark.parametrize("name", sorted(corpus.MANIFOLD - {"flipped", "moebius"}))
def test_surfaces_are_taken(name):
    mesh = corpus.MESHES[name]()
    assert PolyMesh.of_triangles(mesh).checked().faces == len(mesh.faces)


@pytest.mark.parametrize(
    "name", ["nonmanifold_edge", "nonmanifold_vertex", "many_wings", "flipped", "moebius"]
)
def test_what_is_no_surface_is_not_taken(name):
    with pytest.raises(FovealError, match=r"edge between vertices|several fans"):
        PolyMesh.of_triangles(corpus.MESHES[name]()).checked()
