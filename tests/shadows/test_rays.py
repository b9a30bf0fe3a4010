"""Shadow tests against rays that know nothing of maps: all triangles in float64, and embree where it is."""

import numpy as np
import pytest

from foveal.shadows import Directional, build

from .scenes import mixed, solids

_NO_EMBREE = "embreex has wheels for x86_64 alone; rays of NumPy are asked in any case"

LIGHT = Directional((0.45, 0.3, -0.84))
CLEAR = 1e-6
"""Of the depth of the scene, between a receiver and every surface: a map's corners are 2^-31 of its side off,
so its planes 2^-31 times their slope, which for the slopes of these scenes is far less."""


def soup(meshes):
    """Triangles, and whether each is of a solid: in these scenes meshes of two triangles are sheets."""
    return (
        np.concatenate([mesh.positions[mesh.faces] for mesh in meshes]),
        np.concatenate([np.full(len(mesh.faces), len(mesh.faces) > 2) for mesh in meshes]),
    )


def crossings(triangles, begin, way):
    """All triangles that a ray meets, in order: where, which, from which side; or None beside an edge."""
    a, b, c = (triangles[:, k] - begin for k in range(3))
    volumes = np.stack([np.cross(p, q) @ way for p, q in ((b, c), (c, a), (a, b))], axis=1)
    whole = volumes.sum(axis=1)
    is_met = (volumes > 0).all(1) | (volumes < 0).all(1)
    is_near = (volumes >= -CLEAR).all(1) | (volumes <= CLEAR).all(1)
    if (is_near & ~(np.abs(volumes) > CLEAR).all(1)).any():
        return None
    normal = np.cross(b - a, c - a)[is_met]
    at = (a[is_met] * normal).sum(1) / (normal @ way)
    order = np.argsort(at)
    return at[order], np.flatnonzero(is_met)[order], np.sign(whole[is_met])[order]


def receivers(shadow, triangles, is_solid, count, seed):
    """Points on rays through middles of pixels, in the air, and whether rays say that they are lit.

    In the air: clear of surfaces and outside of solids; where an open part is met first, behind the second
    surface, since before that a map's value is free.
    """
    random, side = np.random.default_rng(seed), shadow.resolution
    inverse = np.linalg.inv(shadow.projections[0].matrix)
    for x, y in random.integers(0, side, (count, 2)):
        u, v = (x + 0.5) / side, (y + 0.5) / side
        begin, end = ((inverse @ [u, v, z, 1])[:3] for z in (0, 1))
        met = crossings(triangles, begin, end - begin)
        if met is None:
            continue
        at, which, sides = met
        inside = np.concatenate([[0], np.cumsum(np.where(is_solid[which], -sides, 0))])
        ends = np.concatenate([[0], at, [1]])
        is_free_behind = len(at) > 0 and not is_solid[which[0]]
        for gap in range(len(ends) - 1):
            room = ends[gap + 1] - ends[gap]
            is_free = gap > 0 and is_free_behind and ends[gap] < at[0] + 4 * CLEAR
            if inside[gap] == 0 and room > 4 * CLEAR and not is_free:
                for share in (2 * CLEAR / room, random.random()):
                    yield begin + (ends[gap + 1] - share * room) * (end - begin), gap == 0


@pytest.mark.parametrize("resolution", [256, 1 << 13])
@pytest.mark.parametrize("scene", [solids, mixed])
def test_rays_agree(scene, resolution):
    meshes = scene()
    shadow = build(meshes, LIGHT, resolution=resolution)
    points, is_lit = zip(*receivers(shadow, *soup(meshes), 500, seed=resolution), strict=True)
    assert len(points) > 1000
    assert 0.2 < np.mean(is_lit) < 0.9
    np.testing.assert_array_equal(shadow.lookup(np.array(points)), is_lit)


def test_embree_agrees():
    """With one ray to the light for each receiver, clear of edges by what float32 is off."""
    scenes = pytest.importorskip("embreex.rtcore_scene", reason=_NO_EMBREE)
    construction = pytest.importorskip("embreex.mesh_construction", reason=_NO_EMBREE)
    meshes = solids()
    triangles, is_solid = soup(meshes)
    shadow = build(meshes, LIGHT, resolution=4096)
    points, is_lit = map(np.array, zip(*receivers(shadow, triangles, is_solid, 500, seed=3), strict=True))
    scene = scenes.EmbreeScene()
    construction.TriangleMesh(scene, triangles.astype(np.float32))
    to_light = LIGHT.towards(points)
    origins = (points + 1e-4 * to_light).astype(np.float32)
    clear = scene.run(origins, to_light.astype(np.float32)) < 0
    differs = clear != shadow.lookup(points)
    assert differs.mean() < 2e-3  # where float32 takes the other side of an edge
    np.testing.assert_array_equal(shadow.lookup(points)[differs], is_lit[differs])
