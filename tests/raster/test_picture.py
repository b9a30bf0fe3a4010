"""Pictures: the shading page, supersampling, backgrounds, and the file."""

import dataclasses
import io
import json
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from foveal.base.errors import FovealError
from foveal.mesh.normals import vertex_normals
from foveal.mesh.shapes import icosphere
from foveal.mesh.trimesh import TriMesh
from foveal.raster import _kernels_shade as kernels
from foveal.raster import gradient, picture, rasterise, write_png
from foveal.raster.shade import PLASTER, decode_srgb, encode_srgb, tables
from foveal.view.camera import Camera
from raster import naive_raster

SHADING = Path(__file__).parents[2] / "spec" / "golden" / "shading.json"
CAMERA = Camera.of([0.3, 0.7, 3], [0, 0, 0], width=40, height=30)


def coloured_ball():
    ball = icosphere(3)
    colours = np.clip((ball.positions + 1) * 127, 0, 255).astype(np.uint8)
    return TriMesh(ball.positions, ball.faces, ball.positions.astype(np.float32), colours)


def by_the_page(mesh, camera, *, is_flat=False, has_colours=True):
    """The same picture, pixel by pixel as spec/shading.md says."""
    seen, directions, basis = (
        rasterise(mesh.positions, mesh.faces, camera),
        naive_raster.rays(camera),
        camera.basis(),
    )
    out = np.zeros((camera.height, camera.width, 4), dtype=int)
    for row, column in np.argwhere(seen.face_ids >= 0):
        corners, weights = mesh.faces[seen.face_ids[row, column]], seen.weights[row, column].astype(float)
        a, b, c = mesh.positions[corners]
        facing = basis @ np.cross(b - a, c - a)
        facing *= -np.sign(facing @ (basis @ directions[row, column]))
        normal = facing if is_flat else basis @ (weights @ mesh.normals[corners])
        normal = normal / np.linalg.norm(normal)
        colour = weights @ mesh.colours[corners] if has_colours and mesh.colours is not None else PLASTER
        out[row, column, :3] = naive_raster.shade(colour, normal, facing)
        out[row, column, 3] = 255
    return out


@pytest.mark.parametrize("is_flat", [False, True])
@pytest.mark.parametrize("has_colours", [False, True])
def test_every_pixel_is_what_the_page_says(is_flat, has_colours):
    options = {"is_flat": is_flat, "has_colours": has_colours}
    found = picture(coloured_ball(), CAMERA, supersampling=1, **options).astype(int)
    wanted = by_the_page(coloured_ball(), CAMERA, **options)
    assert (wanted[..., 3] > 0).sum() > 200
    assert np.abs(found - wanted).max() <= 1


def test_both_sides_are_lit_alike():
    ball = coloured_ball()
    inside_out = TriMesh(ball.positions, ball.faces[:, ::-1].copy(), -ball.normals, ball.colours)
    for is_flat in (False, True):
        pair = [picture(mesh, CAMERA, is_flat=is_flat, supersampling=1) for mesh in (ball, inside_out)]
        np.testing.assert_array_equal(*pair)


def test_a_vertex_without_a_normal_shows_its_face():
    ball = icosphere(2)
    nothing = TriMesh(ball.positions, ball.faces, np.zeros(ball.positions.shape, dtype=np.float32))
    np.testing.assert_array_equal(picture(nothing, CAMERA), picture(ball, CAMERA, is_flat=True))


@pytest.mark.skipif(not SHADING.exists(), reason="the viewer's cases are not written yet")
def test_golden_cases_of_the_viewer():
    golden = json.loads(SHADING.read_text())
    for case in golden["cases"] + golden["with_light"]:
        to_light = case.get("to_light", naive_raster.KEY)
        light = kernels.light_of(*case["normal"], *case["facing"], *to_light, case.get("shadow", 1.0))
        decode, encode = tables()
        linear = [min(1.0, kernels.decoded(float(c), decode) * light) for c in case["colour"]]
        found = [int(kernels.encoded(x, encode)) for x in linear]
        assert np.abs(np.array(found) - case["pixel"]).max() <= 1


def test_tables_are_within_a_byte_of_the_formulas():
    decode, encode = tables()
    linear = np.concatenate([np.linspace(0, 1, 100_001), np.geomspace(1e-9, 1, 1000)])
    found = np.array([kernels.encoded(x, encode) for x in linear], dtype=float)
    exact = 255 * encode_srgb(linear)
    assert np.abs(found - exact).max() < 0.6
    colours = np.linspace(0, 255, 5001)
    between = np.array([kernels.decoded(c, decode) for c in colours])
    assert np.abs(encode_srgb(between) - encode_srgb(decode_srgb(colours / 255))).max() * 255 < 0.05
    np.testing.assert_array_equal([kernels.encoded(x, encode) for x in decode], np.arange(256))


def test_supersampling_averages_linear_light():
    # A wall that covers exactly the left half of each middle pixel: half the light, not half the bytes.
    wall = TriMesh.of([[-9, -9, 0], [0.5, -9, 0], [0.5, 9, 0], [-9, 9, 0]], [[0, 1, 2], [0, 2, 3]])
    camera = Camera.of([0, 0, 2], [0, 0, 0], field_of_view=np.pi / 2, width=4, height=4)
    sharp = picture(wall, camera, supersampling=1, background=(0, 0, 0))
    soft = picture(wall, camera, supersampling=2, background=(0, 0, 0))
    np.testing.assert_array_equal(soft[:, :2, :3], sharp[:, :2, :3])
    half = 255 * encode_srgb(decode_srgb(sharp[:, 0, :3] / 255) / 2)
    assert np.abs(soft[:, 2, :3] - half).max() <= 1
    clear = picture(wall, camera, supersampling=2)
    np.testing.assert_array_equal(clear[0, :, 3], [255, 255, 128, 0])
    np.testing.assert_array_equal(clear[:, 2, :3], sharp[:, 1, :3])


@pytest.mark.parametrize("supersampling", [1, 2, 3, 5, 8])
def test_the_number_of_threads_changes_no_byte_and_no_row_is_lost(supersampling):
    ball, camera = icosphere(2), Camera.of([0, 0, 1.2], [0, 0, 0], field_of_view=0.9, width=30, height=100)
    results = []
    for workers in (1, 3):
        with ThreadPoolExecutor(workers) as pool:
            results.append(picture(ball, camera, supersampling=supersampling, executor=pool))
    np.testing.assert_array_equal(*results)
    fine = picture(ball, camera, supersampling=1)
    assert np.abs(results[0][..., 3].astype(int) - fine[..., 3]).mean() < 3


def test_background_is_exact_where_nothing_is_seen():
    camera = Camera.of([0, 0, 30], [0, 0, 0], width=40, height=20)
    plain = picture(icosphere(1), camera, background=(10, 200, 77))
    assert plain[0, 0].tolist() == [10, 200, 77, 255]
    behind = gradient(camera)
    np.testing.assert_array_equal(picture(icosphere(1), camera, background=behind)[:5, :, :3], behind[:5])


def test_wrong_backgrounds_and_sampling_are_refused():
    ball = icosphere(0)
    with pytest.raises(FovealError, match="background"):
        picture(ball, CAMERA, background=(300, 0, 0))
    with pytest.raises(FovealError, match="background"):
        picture(ball, CAMERA, background=np.zeros((2, 2, 3), dtype=np.uint8))
    with pytest.raises(ValueError, match="supersampling"):
        picture(ball, CAMERA, supersampling=0)


def test_without_normals_of_its_own_a_mesh_has_means_of_its_faces():
    ball = icosphere(3)
    given = dataclasses.replace(ball, normals=vertex_normals(ball))
    np.testing.assert_array_equal(picture(ball, CAMERA), picture(given, CAMERA))
    assert (picture(ball, CAMERA) != picture(ball, CAMERA, is_flat=True)).any()
    # a surface with no area has no normals, and is nothing to see
    flat = TriMesh.of([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    assert not picture(flat, CAMERA).any()


def test_png_round_trip(tmp_path):
    pixels = picture(coloured_ball(), CAMERA)
    write_png(pixels, tmp_path / "deep" / "ball.png")
    with Image.open(tmp_path / "deep" / "ball.png") as image:
        np.testing.assert_array_equal(np.asarray(image), pixels)
    write_png(pixels[..., :3], tmp_path / "ball.png")
    with Image.open(tmp_path / "ball.png") as image:
        np.testing.assert_array_equal(np.asarray(image), pixels[..., :3])


def test_a_gradient_is_the_same_in_parts_and_its_memory_is_small():
    camera = Camera.of([0, 0, 1], [0, 0, 0], width=7, height=200)  # more rows than are made at once
    rows = gradient(camera)
    assert rows.shape == (200, 7, 3)
    steps = np.abs(np.diff(rows.astype(int), axis=0))
    assert steps.max() <= 2  # no seam
    tracemalloc.start()
    gradient(camera.resized(4000, 2000))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3 * 4000 * 2000 * 3


def test_a_notebook_shows_a_picture_and_what_is_computed_from_it_is_plain():
    shown = picture(icosphere(1), CAMERA, background=(255, 255, 255))
    assert shown.camera is CAMERA
    for part in (shown, shown[5:20, ::2], shown[..., :3]):
        with Image.open(io.BytesIO(part._repr_png_())) as image:
            np.testing.assert_array_equal(np.asarray(image), part)
    assert shown[5:20].camera is None  # it was drawn with another
    for numbers in (shown[0], shown[..., 0], shown[:0]):
        assert numbers._repr_png_() is None
    assert (shown / 255)[0, 0, 0] == 1.0
    assert type(shown / 255) is type(shown == 0) is type(shown.mean(axis=0)) is np.ndarray
    assert isinstance(shown.max(), np.uint8)
    assert shown.flags.c_contiguous


def test_drawing_tells_how_far_it_is():
    told = []

    class Stage:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            told.append("done")

        def advance(self, amount=1.0):
            told.append(amount)

    class Listener:
        def stage(self, what, total):
            told.extend([what, total])
            return Stage()

    picture(icosphere(1), CAMERA.resized(8, 200), supersampling=1, progress=Listener())
    assert told == ["Drawing", 4.0, 1.0, 1.0, 1.0, 1.0, "done"]
