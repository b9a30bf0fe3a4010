"""foveal render in the light of a shadow map: alone, of a scene, and what cannot be."""

import numpy as np
import pytest
from PIL import Image

import foveal
from foveal.mesh.io import write_ply
from foveal.mesh.shapes import icosphere
from foveal.shadows import AreaLight, Directional


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.ply"
    write_ply(icosphere(3), path)
    return path


def pixels(path):
    with Image.open(path) as picture:
        return np.asarray(picture).astype(int)


def test_a_picture_in_a_light_of_its_own(run, ball, tmp_path):
    light, stack = tmp_path / "light.fov", tmp_path / "stack.fov"
    foveal.shadow(ball, light, light=Directional((0.2, -1, -0.1)), resolution=256)
    foveal.shadow(ball, stack, light=AreaLight(Directional((0, -1, 0)), radius=0.2, samples=4), resolution=64)
    size = ("--size", "64x48")
    bare, lit = tmp_path / "bare.png", tmp_path / "lit.png"
    assert run("render", ball, "-o", bare, *size).exit_code == 0
    assert run("render", ball, "-o", lit, *size, "--shadow", light, "--shadow-filter", "pcf5").exit_code == 0
    top, bottom = pixels(lit)[14, 32, 0], pixels(lit)[34, 32, 0]
    assert top > bottom + 60  # lit from above
    assert np.abs(pixels(bare) - pixels(lit)).max() > 60
    for words in (("--shadow-filter", "hard", "--shadow-image", "3"), ()):
        facts = run("render", ball, "-o", lit, "--force", *size, "--shadow", stack, *words)
        assert facts.exit_code == 0, facts.stderr


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--shadow-filter", "blurred"], "choose one of hard"),
        (["--shadow-filter", "soft"], "has one image"),
        (["--shadow-image", "4"], "there is no image 4"),
        (["--shadow", "ball.ply"], "ball.ply"),
        (["--shadow", "missing.fov"], "missing.fov"),
    ],
)
def test_what_cannot_be_is_a_sentence(run, ball, tmp_path, monkeypatch, words, sentence):
    monkeypatch.chdir(tmp_path)
    foveal.shadow(ball, "light.fov", light=Directional((0.2, -1, -0.1)), resolution=64)
    result = run("render", ball, "-o", "a.png", "--shadow", "light.fov", *words)
    assert result.exit_code == 1
    assert sentence in " ".join(result.stderr.split())
    assert not (tmp_path / "a.png").exists()
