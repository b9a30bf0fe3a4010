"""The figures and tables of docs/slates.md: python benchmarks/slates_figures.py [docs]

Repeats figures 5 to 8 and 10 to 12 of the paper (Settgast, Müller, Fünfzig, Fellner) with a scene of its own,
as large as theirs. Takes half a minute; writes what is between the page's markers anew. Needs matplotlib.
"""

import math
import sys
import time
from itertools import pairwise
from pathlib import Path

import matplotlib
import numpy as np
from _shape import ROOT
from numpy.typing import NDArray
from refine_compare import fill, save

from foveal import raster
from foveal.mesh import PolyMesh, TriMesh
from foveal.mesh.poly_shapes import quad_grid
from foveal.refine import Depths, FrameRate, Slates
from foveal.view.camera import Camera

matplotlib.use("svg")
from matplotlib import pyplot as plot

RULES = Depths(most=4, size_px=(2.0, 12.0))
DEPTHS = range(5)
SHADES = [tuple(int(255 * c) for c in plot.get_cmap("YlGnBu")(0.1 + 0.15 * d)[:3]) for d in DEPTHS]
UNIFORM = {2: "#b7b76d", 3: "#c0504d", 4: "#8c8c8c"}
ADAPTIVE = "#4477aa"
SIZE = 9.0
"""The ship's length."""

Floats = NDArray[np.float64]


def ship() -> PolyMesh:
    """68 quadrangles: the surface of eighteen cubes, a hull with wings and a fin."""
    hull = [(x, 0, 0) for x in range(9)]
    wings = [(x, 0, z) for x, z in ((3, -2), (3, -1), (3, 1), (3, 2), (4, -1), (4, 1))]
    cubes = {*hull, *wings, (0, 1, 0), (0, 2, 0), (1, 1, 0)}
    faces: list[list[tuple[int, ...]]] = []
    for cube in cubes:
        for axis in range(3):
            for side in (0, 1):
                beyond = np.array(cube)
                beyond[axis] += 2 * side - 1
                if tuple(beyond.tolist()) not in cubes:
                    faces.append(_square(cube, axis, side))
    places = sorted({corner for face in faces for corner in face})
    index = {place: i for i, place in enumerate(places)}
    corners = np.array([index[corner] for face in faces for corner in face], np.int32)
    middle = np.array([SIZE / 2, 0.5, 0.5])
    return PolyMesh(np.array(places) - middle, np.arange(0, len(corners) + 1, 4), corners).checked("ship")


def _square(cube: tuple[int, int, int], axis: int, side: int) -> list[tuple[int, ...]]:
    """The corners of a cube's face, counter-clockwise seen from outside."""
    square = []
    for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)) if side else ((0, 0), (0, 1), (1, 1), (1, 0)):
        corner = list(cube)
        corner[axis] += side
        corner[(axis + 1) % 3] += u
        corner[(axis + 2) % 3] += v
        square.append(tuple(corner))
    return square


def fleet() -> Slates:
    """Forty ships on a plane, each turned another way."""
    rng, placements = np.random.default_rng(1), np.tile(np.eye(4), (40, 1, 1))
    for i, matrix in enumerate(placements):
        angle = rng.uniform(0, 2 * math.pi)
        c, s = math.cos(angle), math.sin(angle)
        matrix[0, 0], matrix[0, 2], matrix[2, 0], matrix[2, 2] = c, s, -s, c
        matrix[:3, 3] = (i % 8 - 3.5) * 1.2 * SIZE, 0, (i // 8 - 2) * 1.2 * SIZE
    return Slates(ship(), placements=placements)


def turning(degrees: float, *, width: int = 1024, height: int = 768) -> Camera:
    """From aside, aimed at the middle of the scene, which it goes around."""
    angle = math.radians(degrees)
    eye = [7 * SIZE * math.cos(angle), 3 * SIZE, 7 * SIZE * math.sin(angle)]
    return Camera.of(eye, [0, 0, 0], width=width, height=height)


def around(folder: Path) -> str:
    """Figures 5 and 6: triangles, and quadrangles by depth, once around the scene."""
    surface, degrees = fleet(), range(0, 361, 2)
    triangles, quads = [], np.zeros((len(DEPTHS), len(degrees)))
    for i, angle in enumerate(degrees):
        triangles.append(surface.update(turning(angle), depths=RULES).triangles)
        found = np.bincount(surface.arrays().depths.reshape(-1), minlength=len(DEPTHS))
        quads[:, i] = found * 4.0 ** np.arange(len(DEPTHS))
    patches = 40 * surface.patches
    figure, axes = plot.subplots(figsize=(8, 3.2), layout="constrained")
    for depth, colour in UNIFORM.items():
        axes.axhline(2 * patches * 4**depth, color=colour, label=f"uniform depth {depth}")
    axes.plot(degrees, triangles, color=ADAPTIVE, label="adaptive, depths 0 to 4")
    axes.set(yscale="log", xlabel="camera, degrees", ylabel="triangles", xlim=(0, 360))
    axes.legend(fontsize=8, ncols=2)
    save(figure, folder / "slates_triangles.svg")
    figure, axes = plot.subplots(figsize=(8, 3.2), layout="constrained")
    shades = [tuple(c / 255 for c in shade) for shade in SHADES]
    axes.stackplot(degrees, quads / 1e3, colors=shades, labels=[f"depth {d}" for d in DEPTHS])
    axes.set(xlabel="camera, degrees", ylabel="thousand quadrangles", xlim=(0, 360))
    axes.legend(fontsize=8, ncols=5, loc="upper center")
    axes.set_ylim(0, 1.25 * quads.sum(axis=0).max() / 1e3)
    save(figure, folder / "slates_quads.svg")
    lines = ["| tessellation | triangles | of uniform depth 4 |", "| --- | ---: | ---: |"]
    most = 2 * patches * 4**4
    for depth in UNIFORM:
        lines.append(f"| uniform depth {depth} | {2 * patches * 4**depth:,} | {4.0 ** (depth - 4):.1%} |")
    low, middle, high = min(triangles), int(np.median(triangles)), max(triangles)
    lines.append(f"| adaptive, median of {len(degrees)} views | {middle:,} | {middle / most:.1%} |")
    lines.append(
        f"| adaptive, least and most | {low:,} and {high:,} | {low / most:.1%} and {high / most:.1%} |"
    )
    return "\n".join(lines)


def controlled(folder: Path) -> str:
    """Figure 7: frames a second, with the rate held from frame 60 on."""
    rules = Depths(most=4, size_px=(1.0, 6.0))
    surface = fleet()
    surface.update(turning(0), depths=rules)
    free = surface.update(turning(359), depths=rules).triangles
    draw_ms = 1000 / 14.5 / free
    pace: FrameRate | None = None
    rates, counts = [], []
    for frame in range(240):
        if frame == 60:
            pace = FrameRate(39.5, budget=free)
        begin = time.perf_counter()
        budget = pace.budget if pace else None
        triangles = surface.update(turning(frame), depths=rules, budget=budget).triangles
        took = 1e3 * (time.perf_counter() - begin) + draw_ms * triangles
        if pace:
            pace.tell(took, triangles)
        rates.append(1000 / took)
        counts.append(triangles)
    figure, axes = plot.subplots(figsize=(8, 3.2), layout="constrained")
    for depth, colour in UNIFORM.items():
        rate = 1000 / (draw_ms * 2 * 40 * surface.patches * 4**depth)
        axes.axhline(rate, color=colour, label=f"uniform depth {depth}")
    axes.plot(rates, color=ADAPTIVE, label="adaptive, 39.5 frames a second held from frame 60 on")
    axes.set(xlabel="frame", ylabel="frames a second", xlim=(0, 239), yscale="log")
    axes.set_yticks([5, 10, 20, 40, 80, 160], [5, 10, 20, 40, 80, 160])
    axes.minorticks_off()
    axes.legend(fontsize=8)
    save(figure, folder / "slates_rate.svg")
    held = np.array(rates[60:])
    first = int((np.abs(held / 39.5 - 1) <= 0.1).argmax())
    off = 100 * float(np.percentile(np.abs(held[first:] / 39.5 - 1), 95))
    return (
        f"From {np.median(rates[:60]):.1f} frames a second it takes {first} frames to within a "
        f"tenth of 39.5; after that 19 of 20 frames are within {off:.1f} %."
    )


def picture(mesh: TriMesh, camera: Camera) -> NDArray[np.uint8]:
    """(height, width, 3): flat triangles with their edges, two by two samples a pixel."""
    pixels = np.asarray(
        raster.picture(mesh, camera, background=(255, 255, 255), supersampling=1, is_flat=True)
    )
    ids = raster.rasterise(mesh.positions, mesh.faces, camera).face_ids
    is_edge = np.zeros(ids.shape, np.bool_)
    is_edge[:, :-1] |= ids[:, :-1] != ids[:, 1:]
    is_edge[:-1] |= ids[:-1] != ids[1:]
    wide = pixels[..., :3].astype(np.float64) * np.where(is_edge, 0.6, 1.0)[..., None]
    return wide.reshape(ids.shape[0] // 2, 2, -1, 2, 3).mean(axis=(1, 3)).astype(np.uint8)


def by_depth(surface: Slates, placements: Floats) -> TriMesh:
    """What is shown, each triangle in the colour of its patch's depth."""
    arrays = surface.arrays()
    points, faces, colours = [], [], []
    for matrix, first, counts, depths in zip(
        placements, arrays.first, arrays.counts, arrays.depths, strict=True
    ):
        for at, count, depth in zip(first, counts, depths, strict=True):
            corners = arrays.positions[arrays.faces[at : at + count].reshape(-1)]
            faces.append(np.arange(3 * count).reshape(-1, 3) + sum(map(len, points)))
            points.append(corners @ matrix[:3, :3].T + matrix[:3, 3])
            colours.append(np.broadcast_to(np.uint8(SHADES[depth]), (3 * count, 3)))
    return TriMesh(
        np.concatenate(points), np.concatenate(faces).astype(np.int32), colours=np.concatenate(colours)
    )


def scenes(folder: Path) -> None:
    """Figures 12, 11 and 8: the scene, one ship from where it was tessellated for, and from behind."""
    surface, white = fleet(), (255, 255, 255)
    camera = Camera.of(
        [5.2 * SIZE, 2.6 * SIZE, 3.4 * SIZE], [0.8 * SIZE, 0, 0.6 * SIZE], width=960, height=420
    )
    surface.update(camera, depths=RULES)
    scene = np.asarray(raster.picture(surface.mesh(), camera, background=white))
    raster.write_png(scene[..., :3], folder / "slates_scene.png")
    one, middle = Slates(ship()), np.array([0.0, 0.6, 0.0])
    towards = np.array([8.0, 5.0, 9.0]) * 0.82
    halves = [
        Camera.of(middle + eye, middle, width=960, height=760) for eye in (towards, -towards * [1, -1, 1])
    ]
    one.update(halves[0].resized(480, 380), depths=Depths(most=4, size_px=(5.0, 30.0)))
    mesh = by_depth(one, np.eye(4)[None])
    raster.write_png(np.hstack([picture(mesh, camera) for camera in halves]), folder / "slates_back.png")


def strategies(folder: Path) -> str:
    """Figure 10: four patches of depths 1, 3, 3, 1 with gaps, with the simple fans, with ours."""
    grid = quad_grid(2)
    x, y = grid.positions[:, 0] - 0.5, grid.positions[:, 1] - 0.5
    dome = np.column_stack([x, y, 0.8 - 1.6 * (x**2 + y**2)])
    mesh = PolyMesh(dome, grid.starts, grid.corners).checked()
    depths = [1, 3, 3, 1]
    surface = Slates(mesh)
    surface.show(3)
    patches, normals = _grids(surface, 3)
    surface.show(depths)
    both = list(zip(patches, depths, strict=True))
    deep = [grid for grid, depth in both if depth == 3]
    made = {
        "with gaps": _soup([_plain(grid, depth) for grid, depth in both]),
        "simple fans": _soup(
            [_plain(grid, 3) if depth == 3 else _simple(grid, deep) for grid, depth in both]
        ),
        "fans around the next face point": surface.mesh(),
    }
    middle = np.array([0.0, -0.05, 0.2])
    eye = middle + np.array([-0.55, -1.15, 0.75])
    camera = Camera.of(eye, middle, up=[0, 0, 1], width=640, height=560)
    pictures = []
    lines = [
        "| | triangles | open edges inside | largest angle to the limit's normal | largest bend |",
        "| --- | ---: | ---: | ---: | ---: |",
    ]
    for name, shown in made.items():
        pictures.append(picture(shown, camera))
        lines.append(
            f"| {name} | {len(shown.faces):,} | {_open_inside(shown, patches):,} "
            f"| {_worst(shown, patches, normals):.1f}° | {_bend(shown):.1f}° |"
        )
    raster.write_png(np.hstack(pictures), folder / "slates_gaps.png")
    return "\n".join(lines)


def _grids(surface: Slates, depth: int) -> tuple[list[Floats], list[Floats]]:
    """Of each patch of a surface shown at one depth: (n, n, 3) points and normals, row by row."""
    arrays, side = surface.arrays(), 2**depth + 1
    begins = [
        int(arrays.faces[at : at + count].min())
        for at, count in zip(arrays.first[0], arrays.counts[0], strict=True)
    ]
    return (
        [arrays.positions[at : at + side**2].reshape(side, side, 3).copy() for at in begins],
        [arrays.normals[at : at + side**2].reshape(side, side, 3).copy() for at in begins],
    )


def _sides(grid: Floats) -> list[Floats]:
    """Its four sides, around."""
    return [grid[0], grid[:, -1], grid[-1, ::-1], grid[::-1, 0]]


def _names(points: Floats) -> set[bytes]:
    return {point.tobytes() for point in points}


def _plain(grid: Floats, depth: int) -> list[Floats]:
    """Triangles of a patch by itself."""
    coarse = grid[:: 2 ** (3 - depth), :: 2 ** (3 - depth)]
    n = len(coarse) - 1
    quads = [
        (coarse[i, j], coarse[i, j + 1], coarse[i + 1, j + 1], coarse[i + 1, j])
        for i in range(n)
        for j in range(n)
    ]
    return [np.array(t) for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def _simple(grid: Floats, deeper: list[Floats]) -> list[Floats]:
    """Triangles of a patch of depth 1 beside some of depth 3: their border points are joined to corners."""
    fine = [
        side
        for side in _sides(grid)
        if any(
            other is not grid and {side[0].tobytes(), side[-1].tobytes()} <= _names(other.reshape(-1, 3))
            for other in deeper
        )
    ]
    triangles = []
    for i in (0, 4):
        for j in (0, 4):
            corners = [grid[i, j], grid[i, j + 4], grid[i + 4, j + 4], grid[i + 4, j]]
            ring, hub = _with_points(corners, fine)
            ring = ring[hub:] + ring[:hub]
            triangles += [np.array((ring[0], b, c)) for b, c in pairwise(ring[1:])]
    return triangles


def _with_points(corners: list[Floats], fine: list[Floats]) -> tuple[list[Floats], int]:
    """A quadrangle's corners with the points of fine sides between, and which of them the fan is from."""
    ring: list[Floats] = []
    on_fine = [0, 0, 0, 0]
    begins = []
    for k in range(4):
        begins.append(len(ring))
        a, b = corners[k], corners[(k + 1) % 4]
        ring.append(a)
        for side in fine:
            names = [point.tobytes() for point in side]
            if a.tobytes() in names and b.tobytes() in names:
                first, last = names.index(a.tobytes()), names.index(b.tobytes())
                ring += list(side[first + 1 : last]) if first < last else list(side[first - 1 : last : -1])
                on_fine[k] += 1
                on_fine[(k + 1) % 4] += 1
    return ring, begins[int(np.argmin(on_fine))]


def _soup(patches: list[list[Floats]]) -> TriMesh:
    points = np.concatenate([np.concatenate(triangles) for triangles in patches])
    return TriMesh(points, np.arange(len(points), dtype=np.int32).reshape(-1, 3))


def _open_inside(mesh: TriMesh, patches: list[Floats]) -> int:
    """Edges with one triangle that are not on the surface's own border; places equal bit for bit are one."""
    _, index = np.unique(mesh.positions, axis=0, return_inverse=True)
    faces = index.reshape(-1)[mesh.faces]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    ends = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    _, first, count = np.unique(edges, axis=0, return_index=True, return_counts=True)
    every = [side for grid in patches for side in _sides(grid)]
    border = set().union(
        *(_names(side) for side in every if sum(_names(side) == _names(other) for other in every) == 1)
    )
    lone = mesh.positions[ends[first[count == 1]]]
    return sum(not (a.tobytes() in border and b.tobytes() in border) for a, b in lone)


def _worst(mesh: TriMesh, patches: list[Floats], normals: list[Floats]) -> float:
    """The largest angle, in degrees, between a triangle and the limit surface at its middle."""
    from scipy.spatial import cKDTree

    points = np.concatenate([grid.reshape(-1, 3) for grid in patches])
    limits = np.concatenate([grid.reshape(-1, 3) for grid in normals])
    a, b, c = mesh.positions[mesh.faces].transpose(1, 0, 2)
    own = np.cross(b - a, c - a)
    own /= np.linalg.norm(own, axis=1)[:, None]
    near = cKDTree(points).query((a + b + c) / 3)[1]
    return float(np.degrees(np.arccos(np.clip((own * limits[near]).sum(axis=1), -1, 1))).max())


def _bend(mesh: TriMesh) -> float:
    """The largest angle, in degrees, between two triangles with an edge in common."""
    _, index = np.unique(mesh.positions, axis=0, return_inverse=True)
    faces = index.reshape(-1)[mesh.faces]
    a, b, c = mesh.positions[mesh.faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    order = np.lexsort(edges.T)
    is_same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    one, two = order[1:][is_same] % len(faces), order[:-1][is_same] % len(faces)
    return float(np.degrees(np.arccos(np.clip((normals[one] * normals[two]).sum(axis=1), -1, 1))).max())


def main(folder: Path) -> None:
    """Measure, then write everything."""
    path = folder / "slates.md"
    page = path.read_text(encoding="utf-8")
    scenes(folder)
    for name, make in (("counts", around), ("rate", controlled), ("gaps", strategies)):
        print(name, file=sys.stderr)
        page = fill(page, name, make(folder))
    path.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
