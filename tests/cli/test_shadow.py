"""`foveal shadow`: each kind of light by its options, and usage errors that name the choices."""

import json
import math

import pytest

from cli.stand_in import Server
from foveal.mesh.io import write_ply
from foveal.scene import read_scene
from scene.shadow_scenes import ball_over_slab

PISA = ("--sun", "2026-06-21T15:00+02:00", "--at", "43.72,10.40")


@pytest.fixture(scope="module")
def scene_mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("meshes") / "scene.ply"
    write_ply(ball_over_slab(), path)
    return path


@pytest.fixture
def made(run, scene_mesh, tmp_path):
    """`made("--direction", ...)` gives what a command of so much says as JSON."""

    def call(*words):
        out = tmp_path / "shadow.fov"
        answer = run("shadow", scene_mesh, "-o", out, "--resolution", "64", "--force", "--json", *words)
        assert answer.exit_code == 0, answer.stderr
        return json.loads(answer.stdout)

    return call


def test_sun(made):
    facts = made(*PISA, "--up", "z", "--north", "y")
    assert facts["light"]["direction"][2] == pytest.approx(-math.sin(math.radians(61.2)), abs=0.01)
    assert facts["light"]["direction"][0] > 0  # from the west, in the afternoon
    assert made(*PISA, "--up", "z")["light"]["direction"] == facts["light"]["direction"]
    turned = made(*PISA, "--up", "z", "--north", "-x")["light"]["direction"]
    assert turned[1] == pytest.approx(facts["light"]["direction"][0])
    assert made(*PISA)["light"]["up"] == "y"


def test_direction_and_negative_numbers(made):
    assert made("--direction", "-1,0,-2")["light"] == {"kind": "directional", "direction": [-1, 0, -2]}


def test_spot(made):
    light = made("--spot", "1,0,6", "--target", "0,0,0", "--angle", "40")["light"]
    assert light["position"] == [1, 0, 6]
    assert light["angle_degrees"] == pytest.approx(40)
    assert made("--spot", "1,0,6", "--target", "0,0,0")["light"]["angle_degrees"] == pytest.approx(60)


def test_point(made):
    facts = made("--point", "0,0,5")
    assert facts["light"] == {"kind": "point", "position": [0, 0, 5]}
    assert facts["pixels"] == 6 * 64 * 64


def test_area_light(made):
    spot = ("--spot", "1,0,6", "--target", "0,0,0")
    facts = made(*spot, "--area-light", "0.5", "--samples", "16", "--jitter", "--seed", "3")
    light = facts["light"]
    assert (light["radius"], light["samples"], light["jitter"], light["seed"]) == (0.5, 16, True, 3)
    assert facts["images"] == len(light["positions"]) == 16
    assert made(*spot, "--area-light", "0.5x1", "--samples", "4")["light"]["size"] == [0.5, 1]
    sun = made(*PISA, "--up", "z", "--area-light", "0.27", "--samples", "4")["light"]
    assert (sun["light"]["kind"], sun["radius"]) == ("sun", pytest.approx(0.27))
    assert made("--direction", "0,0,-1", "--area-light", "2", "--samples", "4")["images"] == 4


def test_sun_path(made):
    facts = made(*PISA, "--up", "z", "--sun-path", "10:00..16:30", "--steps", "3")
    assert facts["light"]["times"] == [f"2026-06-21T{t}:00+02:00" for t in ("10:00", "13:15", "16:30")]
    assert facts["images"] == 3


def test_how_it_is_built(made):
    words = ("--direction", "0,0,-1", "--method", "bottom-up", "--exits", "strict", "--workers", "1")
    assert made(*words)["resolution"] == 64
    assert made("--direction", "0,0,-1")["bytes"] > 0


def test_the_closing_table(run, scene_mesh, tmp_path):
    out = tmp_path / "shadow.fov"
    words = ("--direction", "0.3,0,-1", "--resolution", "1,024")
    answer = run("shadow", scene_mesh, "-o", out, *words)
    assert answer.exit_code == 0, answer.stderr
    for word in ("1,048,576 (1,024 x 1,024)", "on disk", "in memory", "leaf", "empty", "inner", "writing"):
        assert word in answer.stdout
    assert run("shadow", scene_mesh, "-o", out, *words).exit_code == 1  # is there already
    quiet = run("shadow", scene_mesh, "-o", out, *words, "--force", "--quiet")
    assert (quiet.exit_code, quiet.stdout, quiet.stderr) == (0, "", "")
    told = run("info", out)
    assert "shadows of kind directional" in told.stdout
    assert "1,024 x 1,024, 1 map" in told.stdout
    assert json.loads(run("check", out, "--json").stdout)["is_whole"]


def test_what_is_assumed_is_told(run, scene_mesh, tmp_path):
    words = ("--resolution", "64", "--up", "z", "--at", "43.72,10.40")
    answer = run("shadow", scene_mesh, "-o", tmp_path / "s.fov", "--sun", "2026-06-21T12:00", *words)
    assert answer.exit_code == 0
    assert "taken as UTC" in answer.stderr


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([], "--sun, --direction, --spot or --point; got none"),
        (["--point", "0,0,5", "--direction", "0,0,-1"], "got --direction and --point"),
        (["--sun", "2026-06-21T12:00"], "it needs --at"),
        (["--spot", "0,0,5"], "it needs --target"),
        (["--point", "0,0,5", "--at", "1,2"], "it goes with --sun only"),
        (["--point", "0,0,5", "--area-light", "1"], "it goes with --sun or --direction or --spot only"),
        (["--direction", "0,0,-1", "--sun-path", "08:00..18:00"], "it goes with --sun only"),
        (["--direction", "0,0,-1", "--samples", "16"], "it goes with --area-light only"),
        (["--direction", "0,0,-1", "--area-light", "1", "--seed", "1"], "it goes with --jitter only"),
        ([*PISA, "--steps", "9"], "it goes with --sun-path only"),
        ([*PISA, "--sun-path", "08:00..18:00", "--area-light", "1"], "cannot go with --sun-path"),
        ([*PISA, "--sun-path", "8 to 18"], "is not a time from and a time to"),
        ([*PISA, "--sun-path", "08:00..25:00"], "is not a time from and a time to"),
        (["--direction", "down"], "is not 3 numbers"),
        (["--direction", "0,0"], "is not 3 numbers"),
        (["--point", "0,0,nan"], "is not 3 numbers"),
        (["--sun", "2026-06-21T12:00", "--at", "Pisa"], "is not 2 numbers"),
        (["--spot", "0,0,5", "--target", "0,0,0", "--area-light", "1x2x3"], "neither a radius nor"),
        (["--direction", "0,0,-1", "--area-light", "wide"], "is not 1 numbers"),
        (["--direction", "0,0,-1", "--resolution", "1000"], "not a power of two"),
        (["--direction", "0,0,-1", "--resolution", "2097152"], "not a power of two"),
        (["--direction", "0,0,-1", "--resolution", "two"], "not a power of two"),
    ],
)
def test_usage(run, scene_mesh, tmp_path, words, told):
    answer = run("shadow", scene_mesh, "-o", tmp_path / "s.fov", *words)
    assert answer.exit_code == 2
    assert told in " ".join(answer.stderr.replace("│", " ").split())
    assert not (tmp_path / "s.fov").exists()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--sun", "noon", "--at", "1,2"], "not a time"),
        (["--sun", "2026-06-21T02:00+02:00", "--at", "43.72,10.40"], "below the horizon"),
        (["--sun", "2026-06-21T12:00", "--at", "99,10"], "no place"),
        ([*PISA, "--north", "up"], "neither an axis"),
        ([*PISA, "--sun-path", "18:00..08:00"], "not after its beginning"),
        ([*PISA, "--sun-path", "00:00..02:00"], "below the horizon"),
        (["--direction", "0,0,0"], "has no length"),
        (["--spot", "0,0,5", "--target", "0,0,0", "--angle", "180"], "at most 170"),
        (["--spot", "0,0,5", "--target", "0,0,9"], "nothing lies in the light's cone"),
        (["--direction", "0,0,-1", "--area-light", "1", "--samples", "7"], "power of two"),
        (["--point", "0,0,1"], "inside"),
    ],
)
def test_what_is_no_light_is_a_sentence(run, scene_mesh, tmp_path, words, told):
    answer = run("shadow", scene_mesh, "-o", tmp_path / "s.fov", "--resolution", "64", *words)
    assert answer.exit_code == 1, answer.stderr
    assert answer.stderr.splitlines()[-1].startswith("foveal: ")
    assert told in answer.stderr
    assert not (tmp_path / "s.fov").exists()


def test_a_mesh_is_shown_and_published_in_a_light(run, scene_mesh, made, tmp_path, monkeypatch):
    viewer = tmp_path / "viewer"
    viewer.mkdir()
    (viewer / "index.html").write_text("<!doctype html>")
    monkeypatch.setattr("foveal.scene.viewer_files._BUILT", viewer)
    made("--direction", "0,0,-1")
    light = tmp_path / "shadow.fov"
    assert run("publish", scene_mesh, "-o", tmp_path / "site", "--shadow", light).exit_code == 0
    assert read_scene(tmp_path / "site" / "scene.json").light.read_bytes() == light.read_bytes()
    told = run("info", tmp_path / "site" / "scene.json").stdout
    assert "shadows of kind directional" in told
    served = []
    monkeypatch.setattr("foveal.server.view.start", lambda scene, **_: served.append(scene) or Server())
    assert run("view", scene_mesh, "--no-browser", "--shadow", light).exit_code == 0
    assert served[0].light == light.resolve()
    for command in (["view", "--no-browser"], ["publish", "-o", tmp_path / "other"]):
        answer = run(command[0], scene_mesh, *command[1:], "--shadow", tmp_path / "none.fov")
        assert answer.exit_code == 1
        assert "none.fov: there is no such file" in answer.stderr
