"""Pictures in a scene's light: directions, filters, cones, and what cannot be."""

import dataclasses

import numpy as np
import pytest

import foveal
from foveal import Camera, FovealError, multires
from foveal.mesh.io import source_from_mesh
from foveal.mesh.shapes import icosphere, terrain
from foveal.mesh.trimesh import TriMesh
from foveal.scene import scene_of
from foveal.scene.lighting import FILTERS, lighting, lighting_of
from foveal.scene.render import draw, render
from foveal.shadows import AreaLight, Directional, Spot, build
from foveal.shadows.tree import FAR, LEAF, Tree

CAMERA = Camera.of([0, -4, 6], [0, 0, 0], up=[0, 0, 1], width=120, height=90)
SUN = Directional((1.0, 0.0, -1.0))


def floor():
    corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
    corners += [[x, y, -0.1] for x, y, _ in corners]
    faces = [[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]]
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        faces += [[a, a + 4, b], [b, a + 4, b + 4]]
    return TriMesh.of(corners, faces)


def scene():
    ball, ground = icosphere(3), floor()
    positions = np.concatenate([ball.positions * 0.5 + [-0.4, 0, 0.9], ground.positions])
    return TriMesh.of(positions, np.concatenate([ball.faces, ground.faces + len(ball.positions)]))


@pytest.fixture(scope="module")
def shadow():
    return build(scene(), SUN, resolution=1024)


def pixel_of(point):
    right, up, back = CAMERA.basis() @ (np.asarray(point, float) - CAMERA.position)
    scale = CAMERA.pixels_per_radian() / -back
    return int(CAMERA.height / 2 - up * scale), int(CAMERA.width / 2 + right * scale)


@pytest.mark.parametrize("kind", ["hard", "pcf3", "pcf5", "filtered"])
def test_a_shadow_lies_where_the_light_does_not_reach(shadow, kind):
    lit = render(scene(), camera=CAMERA, shadow=shadow, shadow_filter=kind)
    dark, light = pixel_of((0.5, 0, 0)), pixel_of((-1.5, 0, 0))
    # By the page: the fill from above, with and without the key light at 45 degrees.
    up = CAMERA.basis() @ [0, 0, 1]
    ambient = 0.08 + 0.17 * (0.5 + 0.5 * up[1])
    for place, key in ((dark, 0.0), (light, np.sqrt(0.5))):
        found = int(lit[place][0])
        linear = ((214 / 255 + 0.055) / 1.055) ** 2.4 * min(1, ambient + 0.9 * key)
        assert abs(found - 255 * (1.055 * linear ** (1 / 2.4) - 0.055)) <= 3  # corners bend normals a little


def test_the_whole_lit_floor_and_the_front_of_the_ball_are_without_stripes(shadow):
    lit = render(floor(), camera=CAMERA, shadow=build(floor(), SUN, resolution=256), shadow_filter="hard")
    row, column = pixel_of((0, 0, 0))
    assert np.ptp(lit[row - 8 : row + 8, column - 20 : column + 20].astype(int), axis=(0, 1)).max() <= 3


@pytest.mark.parametrize("kind", ["hard", "pcf5"])
def test_a_coarser_surface_is_not_in_the_shadow_of_the_finer(tmp_path, kind):
    ground = terrain(96, seed=2, height=0.02)
    shadow = build(ground, Directional((0.1, 0, -1)), resolution=1024, exits="strict")
    multires.build(source_from_mesh(ground, up="z"), tmp_path / "ground.fov", cell_triangles=512)
    coarse = scene_of(tmp_path / "ground.fov")
    above = Camera.of([0.5, 0.4, 2], [0.5, 0.5, 0], up=[0, 1, 0], width=120, height=120)
    options = {"camera": above, "error_px": 4.0, "shadow_filter": kind}
    lit = render(coarse, shadow=shadow, **options).astype(int)
    bare = render(coarse, shadow=dataclasses.replace(shadow, trees=(lit_everywhere(),)), **options)
    middle = np.s_[30:90, 30:90]
    assert np.abs(lit - bare)[middle].max() == 0  # nothing so flat casts on itself, the sun so high
    exact = draw(coarse, above, light=lighting(shadow, kind), error_px=4.0).astype(int)
    np.testing.assert_array_equal(lit, exact)


def lit_everywhere():
    masks = np.empty(0, np.uint16), np.zeros(11, np.int64)
    return Tree(10, 4, LEAF, *masks, np.array([FAR], np.uint32), np.array([0] + [1] * 11))


def test_a_surface_that_shines_is_soft_unless_else_is_said():
    lamp = AreaLight(Spot((-3, 0, 4), (0, 0, 0), np.radians(80)), radius=0.6, samples=16)
    shadow = build(scene(), lamp, resolution=256)
    assert lighting(shadow).filter == "soft"
    soft = render(scene(), camera=CAMERA, shadow=shadow)
    hard = render(scene(), camera=CAMERA, shadow=shadow, shadow_filter="hard", shadow_image=3)
    row = pixel_of((0.5, 0, 0))[0]
    assert len(np.unique(soft[row, :, 0])) > len(np.unique(hard[row, :, 0]))


def test_a_spot_lights_nothing_outside_its_cone():
    lamp = Spot((0, 0, 3), (0, 0, 0), np.radians(40))
    lit = lighting(build(scene(), lamp, resolution=256), "hard")
    reach = 3 * np.tan(np.radians(20))
    points = np.array(
        [[r * np.cos(a), r * np.sin(a), 0] for r in (0.98 * reach, 1.02 * reach) for a in range(6)]
    )
    _, shares = lit(points, np.broadcast_to([0.0, 0, 1], points.shape), np.zeros((12, 2, 3)))
    assert (shares[6:] == 0).all()
    assert (shares[:6] == 1).any()


def test_the_light_of_a_scene_is_taken(tmp_path, shadow):
    multires.build(source_from_mesh(scene(), up="z"), tmp_path / "scene.fov")
    bare = scene_of(tmp_path / "scene.fov")
    assert lighting_of(bare) is None
    shadow.save(tmp_path / "light.fov")
    with_light = dataclasses.replace(bare, light=tmp_path / "light.fov")
    assert lighting_of(with_light, "pcf5").filter == "pcf5"
    found = render(with_light, camera=CAMERA)
    np.testing.assert_array_equal(found, render(bare, camera=CAMERA, shadow=shadow))
    assert np.abs(found.astype(int) - render(bare, camera=CAMERA)).max() > 60


def test_what_cannot_be_is_said(shadow):
    stack = build(scene(), AreaLight(SUN, radius=0.1, samples=4), resolution=64)
    for arguments, sentence in (
        ((shadow, "blurred"), "is not known; choose one of hard, pcf3, pcf5, filtered, soft"),
        ((shadow, "soft"), "this shadow has one image"),
        ((stack, "filtered"), "is a stack"),
        ((stack, "hard", 4), "images 0 to 3"),
    ):
        with pytest.raises(FovealError, match=sentence):
            lighting(*arguments)
    assert lighting(None) is None
    assert set(FILTERS) == {"hard", "pcf3", "pcf5", "filtered", "soft"}
    with pytest.raises(FovealError, match="not known"):
        foveal.render(scene(), shadow=shadow, shadow_filter="blurred")


def test_what_moves_casts_beside_what_the_light_was_made_for(tmp_path):
    """A ball that the shadow file knows nothing of shades the floor where it hangs."""
    foveal.build(floor(), tmp_path / "floor.fov", up="z")
    ball = icosphere(2)
    foveal.build(TriMesh(ball.positions * 0.5 + [-0.4, 0, 0.9], ball.faces), tmp_path / "ball.fov", up="z")
    foveal.shadow(floor(), tmp_path / "light.fov", light=SUN, resolution=256)
    layers = '[{"name": "floor", "asset": "floor.fov"}, {"name": "ball", "asset": "ball.fov"}]'
    pictures = []
    for moving in ('["ball"]', "[]"):
        path = tmp_path / "scene.json"
        path.write_text(
            f'{{"version": 1, "layers": {layers}, "light": {{"asset": "light.fov", "moving": {moving}}}}}'
        )
        pictures.append(render(path, camera=CAMERA))
    shaded, lit = pixel_of((0.5, 0, 0)), pixel_of((-1.5, 0, 0))
    assert int(pictures[0][shaded][0]) < int(pictures[1][shaded][0]) - 40
    assert (pictures[0][lit] == pictures[1][lit]).all()
