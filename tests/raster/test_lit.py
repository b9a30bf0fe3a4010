"""A light of the scene: where samples are in the world, and what the page makes of the light there."""

import numpy as np
import pytest

from foveal.base.tasks import threads_unless
from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh
from foveal.raster import PLASTER, picture
from foveal.raster.lit import lit_band
from foveal.raster.rasterise import Screen
from foveal.view.camera import Camera
from raster import naive_raster

CAMERA = Camera.of([0.3, 0.7, 3], [0, 0, 0], width=40, height=30)


class Asked:
    """A light that keeps what it was asked."""

    def __init__(self, towards=(0, 1, 0), share=1.0):
        self.towards, self.share, self.calls = np.asarray(towards, float), share, []

    def __call__(self, points, normals, spans):
        self.calls.append((points.copy(), normals.copy(), spans.copy()))
        return np.broadcast_to(self.towards, points.shape), np.full(len(points), self.share, np.float32)


def asked(mesh, camera, lift_px=0.0):
    light = Asked()
    with threads_unless(None) as pool:
        screen = Screen(mesh.positions, mesh.faces, camera, executor=pool)
        _, face_ids = screen.draw(0)
        lit_band(screen, 0, face_ids, light, lift_px)
    return face_ids, *light.calls[0]


@pytest.mark.parametrize("shift", [(0, 0, 0), (455_000.5, 5_020_000.25, 310.125)])
def test_samples_are_where_rays_meet_their_triangles(shift):
    ball = icosphere(2)
    mesh = TriMesh(ball.positions + shift, ball.faces)
    camera = Camera.of(CAMERA.position + shift, shift, width=40, height=30)
    face_ids, points, normals, spans = asked(mesh, camera)
    rays = naive_raster.rays(camera)[face_ids >= 0]
    corners = mesh.positions[mesh.faces[face_ids[face_ids >= 0]]]
    g = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    g /= np.linalg.norm(g, axis=1, keepdims=True)
    g *= -np.sign(np.einsum("ij,ij->i", g, rays))[:, None]
    np.testing.assert_allclose(normals, g, atol=1e-7)
    distance = np.einsum("ij,ij->i", g, corners[:, 0] - camera.position) / np.einsum("ij,ij->i", g, rays)
    exact = camera.position + distance[:, None] * rays
    # Of a sample beside its triangle, by the rounding of places, the nearest point of it is taken.
    np.testing.assert_allclose(points, exact, atol=2e-3)
    assert np.median(np.abs(points - exact)) < 1e-8
    off = np.abs(np.einsum("ij,ij->i", points - corners[:, 0], g))
    assert off.max() < 1e-8
    for axis, step in enumerate(((1, 0), (0, -1))):
        beside = naive_raster.rays(camera, shift=step)[face_ids >= 0]
        t = np.einsum("ij,ij->i", g, corners[:, 0] - camera.position) / np.einsum("ij,ij->i", g, beside)
        facing = -np.einsum("ij,ij->i", g, rays) / np.linalg.norm(rays, axis=1)
        moved = camera.position + t[:, None] * beside - exact
        error = np.linalg.norm(spans[:, axis] - moved, axis=1) / np.linalg.norm(moved, axis=1)
        assert error[facing > 0.5].max() < 0.1  # a step is the first order of the way to the next sample


def test_a_lift_is_so_many_samples_along_the_normal():
    _, flat, normals, _ = asked(icosphere(2), CAMERA)
    _, lifted, _, _ = asked(icosphere(2), CAMERA, lift_px=3.0)
    depth = (CAMERA.position - flat) @ CAMERA.basis()[2]
    width = depth / CAMERA.pixels_per_radian()
    np.testing.assert_allclose(lifted - flat, 3 * width[:, None] * normals, atol=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_every_pixel_is_what_the_page_says(share):
    ball, to_light = icosphere(3), np.array([0.6, 0.0, -0.8])
    found = picture(ball, CAMERA, supersampling=1, is_flat=True, light=Asked(to_light, share))
    face_ids, _, normals, _ = asked(ball, CAMERA)
    basis = CAMERA.basis()
    wanted = [
        naive_raster.shade(PLASTER, basis @ normal, basis @ normal, share, basis @ to_light)
        for normal in normals
    ]
    assert np.abs(found[face_ids >= 0][:, :3].astype(int) - wanted).max() <= 1


def test_the_light_on_the_camera_is_one_of_the_scene_there():
    x, y, z = naive_raster.KEY
    towards = np.array([x, y, z]) @ CAMERA.basis()
    lit = picture(icosphere(3), CAMERA, light=Asked(towards)).astype(int)
    assert np.abs(lit - picture(icosphere(3), CAMERA)).max() <= 1


def test_a_picture_of_nothing_asks_nothing():
    light = Asked()
    picture(icosphere(1), Camera.of([0, 0, 5], [0, 0, 9], width=8, height=8), light=light)
    assert not light.calls
