"""RGB operators: every step is a conforming mesh, the one that the set of split edges means."""

import numpy as np
import pytest
from scipy.spatial import KDTree

import corpus
from foveal.mesh.shapes import bumpy_sphere, icosphere, terrain, tetrahedron, torus
from foveal.refine import Rgb, by_length, rgb
from foveal.refine import _kernels_rgb_merge as merging
from foveal.refine import _kernels_rgb_update as kernels
from foveal.refine._kernels_rgb_address import BASE_KEY, MASK
from foveal.refine._kernels_rgb_layout import FREE_CODE, NONE, PRESENT, edge_level, find_edge
from refine.naive_rgb import Hierarchy

SURFACES = {
    "tetrahedron": tetrahedron,
    "octahedron_like": lambda: icosphere(0),
    "torus": lambda: torus(4, 3),
    "bumpy": lambda: bumpy_sphere(1, seed=3),
    "terrain": lambda: terrain(2),
    "single_triangle": corpus.MESHES["single_triangle"],
    "two_triangles": corpus.MESHES["two_triangles"],
}
COLOURS = ("green", "red", "red", "blue")
DEPTH = 4
NOTHING = 0, np.zeros(24), np.zeros((3, 3)), (0, 1.0)  # a view and limits for which no edge is wanted


class Walk:
    """A mesh that is split and merged at random, beside the set that it should show."""

    def __init__(self, mesh, seed, scheme="loop"):
        self.refined = Rgb(mesh, scheme=scheme)
        self.net = self.refined._state.net
        self.hierarchy = Hierarchy(mesh.positions, mesh.faces, DEPTH, scheme)
        self.names = {key: v for v, key in self.hierarchy.key.items()}
        self.rng = np.random.default_rng(seed)
        self.split = set()

    def name(self, v):
        key = int(self.net.vertices["key"][v])
        return self.names[(-1, key - BASE_KEY, 0) if key < 0 else (key >> 42, (key >> 21) & MASK, key & MASK)]

    def slots(self):
        used = self.net.vertices["flags"][: self.net.counts[1]] & PRESENT != 0
        return {self.name(v): int(v) for v in np.nonzero(used)[0]}

    def step(self, chance=0.6):
        if self.rng.random() < chance or not self.split:
            self.split_one()
        else:
            self.merge_one()

    def split_one(self):
        edges = [
            (f, k)
            for f in range(self.net.counts[0])
            if self.net.faces["code"][f] != FREE_CODE
            for k in range(3)
            if 0 <= edge_level(self.net.faces["code"][f], k) < DEPTH
        ]
        f, k = edges[self.rng.integers(len(edges))]
        corners = self.net.faces["corners"][f]
        edge = frozenset((self.name(corners[k]), self.name(corners[(k + 1) % 3])))
        kernels.force(self.net, f, k, *NOTHING)
        self.split |= self.hierarchy.closed([edge])

    def merge_one(self):
        slots = self.slots()
        removable = self.hierarchy.removable(self.split)
        for v in self.split:
            assert merging.is_mergeable(self.net, slots[v]) == (v in removable)
        v = sorted(removable, key=self.hierarchy.key.get)[self.rng.integers(len(removable))]
        kernels.merge_vertex(self.net, slots[v])
        self.split.remove(v)

    def triangles(self):
        faces = self.net.faces[: self.net.counts[0]]
        return [
            (*(self.name(v) for v in x["corners"]), COLOURS[x["code"] & 3], int(x["code"]) >> 2)
            for x in faces[faces["code"] != FREE_CODE]
        ]


def keyed(triangles, hierarchy):
    return {
        (min((a, b, c), (b, c, a), (c, a, b)), *rest)
        for a, b, c, *rest in ((*(hierarchy.key[v] for v in t[:3]), *t[3:]) for t in triangles)
    }


def assert_linked(net):
    """Each face's neighbours and each vertex's face say the same."""
    faces = net.faces[: net.counts[0]]
    for f in np.nonzero(faces["code"] != FREE_CODE)[0]:
        for k in range(3):
            n, a, b = faces["beside"][f, k], faces["corners"][f, k], faces["corners"][f, (k + 1) % 3]
            assert find_edge(net, a, b) == 3 * f + k
            back = find_edge(net, b, a)
            assert back == NONE if n == NONE else back // 3 == n and faces["beside"][n, back % 3] == f


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", SURFACES)
def test_every_step_shows_the_set_of_split_edges(name, seed):
    walk = Walk(SURFACES[name](), seed)
    for i in range(42):
        walk.step()
        if i % 3 == 0:
            assert_linked(walk.net)
            expected = walk.hierarchy.triangles(walk.split)
            assert keyed(walk.triangles(), walk.hierarchy) == keyed(expected, walk.hierarchy)


@pytest.mark.parametrize("scheme", ["loop", "butterfly"])
@pytest.mark.parametrize("name", SURFACES)
def test_vertices_stand_where_uniform_subdivision_has_them(name, scheme):
    walk = Walk(SURFACES[name](), 7, scheme)
    for _ in range(80):
        walk.step(0.75)
    found = walk.refined.slots().positions
    for v, p in walk.hierarchy.shown(walk.hierarchy.triangles(walk.split)).items():
        np.testing.assert_allclose(found[walk.slots()[v]], p, rtol=0, atol=1e-13)


@pytest.mark.parametrize("name", SURFACES)
def test_the_order_of_operations_does_not_show(name):
    walk = Walk(SURFACES[name](), 5)
    for _ in range(120):
        walk.step(0.7)
    slots, positions = walk.slots(), walk.refined.slots().positions
    for seed in range(3):
        other = Walk(SURFACES[name](), seed)
        wanted = sorted(walk.split, key=lambda v: (walk.hierarchy.born[v] * (seed == 0), other.rng.random()))
        for _ in range(seed * 40):  # another past
            other.step()
        while other.split - walk.split:
            v = min(other.hierarchy.removable(other.split) - walk.split, key=walk.hierarchy.key.get)
            kernels.merge_vertex(other.net, other.slots()[v])
            other.split.remove(v)
        for v in wanted:
            here = other.slots()
            if v not in here:
                split_by_name(other, v, here)
        assert keyed(other.triangles(), other.hierarchy) == keyed(walk.triangles(), walk.hierarchy)
        again, there = other.refined.slots().positions, other.slots()
        assert all((again[there[v]] == positions[slots[v]]).all() for v in slots)


def split_by_name(walk, v, slots):
    """Split the edge v, once its ends are there."""
    for end in v:
        if end not in slots:
            split_by_name(walk, end, walk.slots())
    slots = walk.slots()
    if v in slots:
        return
    a, b = (slots[end] for end in v)
    h = find_edge(walk.net, a, b)
    h = find_edge(walk.net, b, a) if h == NONE else h
    if h == NONE:  # an inner edge whose triangle is not whole yet
        for w in sorted(walk.hierarchy.required(v), key=walk.hierarchy.key.get):
            if w not in walk.slots():
                split_by_name(walk, w, walk.slots())
        split_by_name(walk, v, walk.slots())
        return
    kernels.force(walk.net, h // 3, h % 3, *NOTHING)
    walk.split |= walk.hierarchy.closed([v])


@pytest.mark.parametrize("name", SURFACES)
def test_merged_all_the_way_it_is_the_control_mesh_bit_for_bit(name):
    mesh = SURFACES[name]()
    walk = Walk(mesh, 11)
    for _ in range(60):
        walk.split_one()
    while walk.split:
        walk.merge_one()
    back = walk.refined.mesh()
    assert (back.positions == mesh.positions).all()
    assert sorted(map(tuple, np.sort(back.faces, axis=1))) == sorted(map(tuple, np.sort(mesh.faces, axis=1)))


@pytest.mark.parametrize("scheme", ["loop", "butterfly"])
@pytest.mark.parametrize("name", [n for n in SURFACES if n != "bumpy"])  # too slow for the twin
def test_what_is_split_is_what_is_wanted_and_what_that_takes(name, scheme):
    mesh = SURFACES[name]()
    naive = Hierarchy(mesh.positions, mesh.faces, DEPTH - 1, scheme)
    length = 0.4 * max(np.linalg.norm(mesh.positions[a] - mesh.positions[b]) for a, b in naive.apexes[0])

    def is_long(level, a, b):
        at = naive.positions[level]
        return np.linalg.norm(at[b] - at[a]) > length

    wanted = naive.wanted(is_long)
    assert 0 < max(naive.born[v] for v in wanted) < DEPTH - 1
    expected = naive.triangles(naive.closed(wanted))
    found = rgb(mesh, criteria=by_length(length), scheme=scheme)
    assert len(found.faces) == len(expected)
    distance, _ = KDTree(list(naive.shown(expected).values())).query(found.positions)
    assert distance.max() <= 1e-13 * np.linalg.norm(np.ptp(mesh.positions, axis=0))
