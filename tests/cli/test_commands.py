"""Each command does what its page says, and tells programs about it."""

import json

import pytest

from cli.stand_in import Server
from foveal import multires
from foveal.mesh.io import read_mesh


def result(answer):
    assert answer.exit_code == 0, answer.stderr
    return json.loads(answer.stdout)


def test_build(run, ball_mesh, tmp_path):
    out = tmp_path / "new" / "folders" / "ball.fov"
    facts = result(
        run("build", ball_mesh, "-o", out, "--json", "--bits", "12", "--normals", "NONE", "--up", "Z")
    )
    assert facts["file"] == str(out)
    assert facts["bytes"] == out.stat().st_size
    assert facts["repairs"]["triangles"] == 5120
    with multires.open(out) as asset:
        assert asset.header["up"] == "z"
        assert not asset.has_normals


def test_build_names_its_output_after_its_input(run, ball_mesh, tmp_path):
    mesh = tmp_path / "statue.v2.ply"
    mesh.write_bytes(ball_mesh.read_bytes())
    answer = run("build", mesh)
    assert answer.exit_code == 0
    assert (tmp_path / "statue.v2.fov").exists()
    assert "5,120 triangles" in answer.stdout


def test_build_replaces_only_when_told(run, ball_mesh, tmp_path):
    out = tmp_path / "ball.fov"
    out.write_bytes(b"precious")
    answer = run("build", ball_mesh, "-o", out)
    assert answer.exit_code == 1
    assert "--force" in answer.stderr
    assert out.read_bytes() == b"precious"
    assert run("build", ball_mesh, "-o", out, "--force", "--quiet").exit_code == 0
    assert out.read_bytes() != b"precious"


def test_how_it_is_built_changes_no_byte_but_what_is_built_does(run, ball_mesh, tmp_path):
    def built(name, *options):
        path = tmp_path / f"{name}.fov"
        answer = run("build", ball_mesh, "-o", path, "-q", *options)
        assert answer.exit_code == 0, answer.stderr
        return path.read_bytes()

    usual = built("usual")
    assert built("alone", "--workers", "1", "--memory", "1GB") == usual
    assert built("coarse", "--step", "0.01") != usual
    with multires.open(tmp_path / "coarse.fov") as asset:
        assert asset.step == 0.01


def test_a_cluster_gives_the_same_bytes(run, ball_mesh, ball, tmp_path):
    distributed = pytest.importorskip("distributed", reason="Dask is an extra")
    local = {"processes": False, "protocol": "tcp://", "dashboard_address": None}
    with distributed.LocalCluster(n_workers=1, threads_per_worker=2, **local) as cluster:
        answer = run("build", ball_mesh, "-o", tmp_path / "a.fov", "--dask", cluster.scheduler_address, "-q")
    assert answer.exit_code == 0, answer.stderr
    assert (tmp_path / "a.fov").read_bytes() == ball.read_bytes()


def test_quiet_is_quiet_and_progress_goes_to_stderr(run, ball_mesh, tmp_path):
    quiet = run("build", ball_mesh, "-o", tmp_path / "a.fov", "--quiet")
    assert (quiet.stdout, quiet.stderr) == ("", "")
    told = run("build", ball_mesh, "-o", tmp_path / "b.fov", "--json", "-v")
    json.loads(told.stdout)
    assert " s\n" in told.stderr


def test_info_of_a_fov(run, ball):
    facts = result(run("info", ball, "--json"))
    assert facts["level_table"][-1]["triangles"] == facts["triangles"] == 5120
    text = run("info", ball).stdout
    for word in ("5,120 triangles", "bits", "overhead", "level", "error"):
        assert word in text


def test_info_of_a_mesh(run, ball_mesh):
    facts = result(run("info", ball_mesh, "--json"))
    assert facts["topology"]["is_closed"] is True
    assert facts["topology"]["components"] == 1
    text = run("info", ball_mesh, "--up", "z").stdout
    assert "boundary edges" in text
    assert "  up           z\n" in text


def test_check(run, ball, ball_mesh, tmp_path):
    assert result(run("check", ball, "--json"))["is_whole"] is True
    assert "every promise holds" in run("check", ball, "--deep", "--original", ball_mesh).stdout
    data = bytearray(ball.read_bytes())
    data[-5] ^= 1
    (tmp_path / "broken.fov").write_bytes(data)
    answer = run("check", tmp_path / "broken.fov")
    assert answer.exit_code == 1
    assert "broken.fov" in answer.stderr
    assert run("check", ball, "--original", ball_mesh).exit_code == 2


def test_export(run, ball, tmp_path):
    facts = result(run("export", ball, "-o", tmp_path / "all.ply", "--json"))
    assert facts["triangles"] == 5120 == len(read_mesh(tmp_path / "all.ply").faces)
    facts = result(run("export", ball, "-o", tmp_path / "all.glb", "--error", "0.0001", "--json"))
    assert len(read_mesh(tmp_path / "all.glb").faces) == facts["triangles"]
    assert run("export", ball, "-o", tmp_path / "x.ply", "--error", "1", "--triangles", "9").exit_code == 2


def test_render(run, ball, tmp_path):
    from PIL import Image

    camera = tmp_path / "cam.json"
    camera.write_text('{"position": [0, 0, 4], "target": [0, 0, 0], "size": [50, 40]}')
    facts = result(run("render", ball, "-o", tmp_path / "a.png", "--camera", camera, "--json"))
    assert facts["camera"]["position"] == [0, 0, 4]
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (50, 40)
    assert run("render", ball, "-o", tmp_path / "b.png", "--size", "64x48", "--error-px", "8").exit_code == 0
    with Image.open(tmp_path / "b.png") as picture:
        assert picture.size == (64, 48)


def test_publish(run, ball, tmp_path, monkeypatch):
    viewer = tmp_path / "viewer"
    viewer.mkdir()
    (viewer / "index.html").write_text("<!doctype html>")
    monkeypatch.setattr("foveal.scene.viewer_files._BUILT", viewer)
    facts = result(run("publish", ball, "-o", tmp_path / "site", "--json"))
    assert facts["files"] == 4
    assert run("publish", ball, "-o", tmp_path / "site").exit_code == 1
    assert run("publish", tmp_path / "site" / "scene.json", "-o", tmp_path / "again").exit_code == 0
    assert run("info", tmp_path / "again" / "scene.json").exit_code == 0


@pytest.mark.parametrize("words", [["view"], []])
def test_view_serves_what_it_is_given(run, ball_mesh, tmp_path, monkeypatch, words):
    viewer = tmp_path / "viewer"
    viewer.mkdir()
    (viewer / "index.html").write_text("<!doctype html>")
    monkeypatch.setattr("foveal.scene.viewer_files._BUILT", viewer)
    served = []

    def start(scene, **options):
        served.append((scene, options))
        return Server()

    monkeypatch.setattr("foveal.server.view.start", start)
    monkeypatch.setattr("webbrowser.open", None)
    for more, told in (
        ([], "http://here/   (Ctrl-C ends it)\n"),
        (["-q"], "http://here/\n"),
        (["--json"], '{\n "url": "http://here/"\n}\n'),
    ):
        answer = run(*words, ball_mesh, "--no-browser", "--port", "0", "--bind", "localhost", *more)
        assert (answer.exit_code, answer.stdout) == (0, told), answer.stderr
    assert {scene.title for scene, _ in served} == {"ball"}
    assert len(list((tmp_path / "cache").iterdir())) == 1
    assert all((options["port"], options["host"]) == (0, "localhost") for _, options in served)


def test_help_names_every_command_and_every_option_has_its_line(run):
    page = run("--help").stdout
    for command in ("view", "build", "info", "check", "export", "refine", "render", "shadow", "publish"):
        assert f"\n  {command} " in page
        own = run(command, "--help").stdout
        assert "--debug" in own
    assert "..." not in page.split("Commands:")[1]  # no summary is cut off
    assert run("--version").stdout.startswith("foveal ")
