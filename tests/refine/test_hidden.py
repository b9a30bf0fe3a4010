"""What a depth buffer hides is not refined, and nothing else is left out."""

import numpy as np
import pytest

import corpus
from foveal.mesh.shapes import bumpy_sphere, icosphere
from foveal.mesh.trimesh import TriMesh
from foveal.refine import Criteria, Hidden, Region, Sqrt3
from foveal.refine._kernels_hidden import is_hidden
from foveal.refine.criteria import view_of
from foveal.view.camera import Camera
from refine.surfaces import assert_same, assert_surface

CAMERA = Camera.of([0, 0, 6], [0, 0, 0])
CRITERIA = Criteria(Region(4, 6.0), Region(5, 4.0))


def before_and_behind():
    """A wide ball, and a smaller one right behind it."""
    ball = icosphere(2)
    return corpus.joined(ball, TriMesh(ball.positions * 0.5 + [0, 0, -3], ball.faces))


def test_what_is_behind_is_left_alone_and_what_is_before_is_not():
    mesh = before_and_behind()
    refined = Sqrt3(mesh)
    all_of_it = refined.update(CAMERA, criteria=CRITERIA)
    is_behind = refined.mesh().positions[:, 2] < -2
    some = refined.update(CAMERA, criteria=CRITERIA, hidden=Hidden.behind(mesh, CAMERA))
    found = refined.mesh()
    assert_surface(found, mesh)
    half = len(mesh.positions) // 2
    assert is_behind.sum() > 2 * half
    assert (found.positions[:, 2] < -2).sum() == half
    assert (found.positions[:, 2] > -2).sum() == (~is_behind).sum()
    assert some.faces < all_of_it.faces
    assert refined.update(CAMERA, criteria=CRITERIA).faces == all_of_it.faces


@pytest.mark.parametrize("seed", range(3))
def test_the_mesh_depends_on_the_view_and_the_depth_buffer_alone(seed):
    rng = np.random.default_rng(seed)
    mesh = corpus.joined(
        bumpy_sphere(2, seed=seed), TriMesh(icosphere(1).positions - [0, 0, 3], icosphere(1).faces)
    )
    refined = Sqrt3(mesh)
    for _ in range(5):
        eye = rng.normal(size=3)
        camera = Camera.of(6 * eye / np.linalg.norm(eye), [0, 0, 0])
        hidden = Hidden.behind(refined.mesh(), camera) if rng.integers(0, 3) else None
        refined.update(camera, criteria=CRITERIA, hidden=hidden)
        fresh = Sqrt3(mesh)
        fresh.update(camera, criteria=CRITERIA, hidden=hidden)
        assert_same(refined.mesh(), fresh.mesh())


def test_a_ball_is_hidden_only_if_every_pixel_it_may_touch_is_nearer():
    rng = np.random.default_rng(7)
    width, height = 37, 23
    depth = rng.uniform(3, 9, (height, width)).astype(np.float32)
    depth[rng.random(depth.shape) < 0.02] = np.inf
    camera = CAMERA.resized(width, height)
    view = np.concatenate([view_of(camera), Hidden.of(depth, camera).words])
    right, up, backward = camera.basis()
    found = 0
    for _ in range(3000):
        centre, radius = rng.uniform(-3, 3, 3) * [1, 1, 1.5], rng.uniform(0.01, 0.4)
        if not is_hidden(view, *centre, radius):
            continue
        found += 1
        points = rng.normal(size=(400, 3))
        points = centre + radius * points / np.linalg.norm(points, axis=1)[:, None]
        seen = points - camera.position
        far = -seen @ backward
        column = np.floor(width / 2 + camera.pixels_per_radian() * (seen @ right) / far).astype(int)
        row = np.floor(height / 2 - camera.pixels_per_radian() * (seen @ up) / far).astype(int)
        assert (depth[row, column] < far).all()  # an index outside the picture would show
        assert min(row.min(), column.min()) >= 0
    assert found > 100


def test_a_depth_buffer_has_rows_and_columns():
    with pytest.raises(ValueError, match="height, width"):
        Hidden.of(np.zeros(4, np.float32), CAMERA)
