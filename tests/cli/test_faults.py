"""Wrong input: one sentence on stderr, the right exit code, no traceback, no file."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

try:
    import resource
except ImportError:  # on Windows
    resource = None

import foveal
from foveal.base.files import _MACHINE
from foveal.cli import main
from foveal.mesh.io import write_ply
from foveal.mesh.shapes import bumpy_sphere, icosphere

#: ./do builds the viewer before any test; only a bare pytest in a new checkout is without it.
HAS_VIEWER = (Path(foveal.__file__).parent / "viewer" / "index.html").is_file()


def assert_one_sentence(answer, *parts):
    assert answer.exit_code == 1
    assert answer.stdout == ""
    lines = [line for line in answer.stderr.splitlines() if not line.endswith("...")]
    assert len(lines) == 1, answer.stderr
    assert lines[0].startswith("foveal: ")
    assert "Traceback" not in answer.stderr
    assert "fault in foveal itself" not in answer.stderr
    for part in parts:
        assert part in lines[0]


@pytest.mark.parametrize(
    ("name", "content", "part"),
    [
        ("empty.ply", "", "empty.ply"),
        ("text.ply", "hello", "text.ply"),
        ("cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "cut.ply"),
        ("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "NaN"),
        ("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "index.obj"),
        ("points.obj", "v 0 0 0\nv 1 0 0\n", "points.obj"),
        ("zip.glb", "PK\3\4" + "x" * 100, "zip.glb"),
    ],
)
def test_a_file_that_is_no_mesh(run, tmp_path, name, content, part):
    (tmp_path / name).write_text(content)
    assert_one_sentence(run("build", tmp_path / name, "-o", tmp_path / "out.fov"), part)
    assert not (tmp_path / "out.fov").exists()
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("command", ["view", "build", "info", "check", "export", "render", "publish"])
@pytest.mark.parametrize(("name", "part"), [("none.fov", "no such file"), ("folder.fov", "folder")])
def test_a_file_that_is_not_there(run, tmp_path, command, name, part):
    (tmp_path / "folder.fov").mkdir()
    out = {"build": "out.fov", "export": "out.ply", "render": "out.png", "publish": "out"}
    more = ["-o", tmp_path / out[command]] if command in out else []
    answer = run(command, tmp_path / name, *more)
    assert answer.exit_code == 1
    if HAS_VIEWER or command not in ("view", "publish"):  # without it they say that first
        assert_one_sentence(answer, part)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.fov"]


def test_every_prefix_of_a_file_is_refused(run, ball, tmp_path):
    data = ball.read_bytes()
    for length in (0, 1, 4, 20, 24, 200, len(data) // 2, len(data) - 1):
        (tmp_path / "cut.fov").write_bytes(data[:length])
        assert_one_sentence(run("info", tmp_path / "cut.fov"), "cut.fov")


@pytest.mark.parametrize(
    "words",
    [
        ["biuld", "x"],
        ["info"],
        ["info", "a", "b"],
        ["build", "a.ply", "--bits", "many"],
        ["build", "a.ply", "--memory", "lots"],
        ["build", "a.ply", "--memory", "0GB"],
        ["build", "a.ply", "--memory", "9" * 400],
        ["build", "a.ply", "--workers", "0"],
        ["build", "a.ply", "--workers", "99999"],
        ["build", "a.ply", "--up", "w"],
        ["render", "a.ply", "-o", "a.png", "--size", "big"],
        ["export", "a.ply"],
        ["info", "a.ply", "--nonsense"],
    ],
)
def test_a_wrong_command_line_exits_with_2(run, words):
    answer = run(*words)
    assert answer.exit_code == 2
    assert answer.stdout == ""
    assert "Traceback" not in answer.stderr


def test_a_mistyped_command_is_guessed(run):
    assert "build" in run("biuld", "x.ply").stderr


@pytest.mark.parametrize(
    ("words", "part"),
    [
        (["build", "-o", "a.fov", "--bits", "9", "--step", "1"], "--step"),
        (["build", "-o", "a.fov", "--step", "-1"], "--step"),
        (["build", "-o", "a.fov", "--step", "nan"], "--step"),
        (["build", "-o", "a.ply"], ".fov"),
        (["export", "-o", "a.stl"], ".glb"),
        (["export", "-o", "a.ply", "--error", "1", "--triangles", "9"], "--triangles"),
        (["render", "-o", "a.jpg"], ".png"),
        (["render", "-o", "a.png", "--size", "0x9"], "--size"),
        (["check", "--original", "a.ply"], "--original"),
    ],
)
def test_options_that_do_not_go_together_exit_with_2_and_are_named(run, ball, words, part):
    answer = run(words[0], ball, *words[1:])
    assert (answer.exit_code, answer.stdout) == (2, "")
    assert part in answer.stderr


@pytest.mark.parametrize(
    ("command", "name"), [("build", "a.fov"), ("export", "a.ply"), ("render", "a.png"), ("publish", "a")]
)
def test_a_place_that_cannot_be_written_is_said_before_any_work(run, ball_mesh, tmp_path, command, name):
    (tmp_path / "file").write_text("this is no folder")
    answer = run(command, ball_mesh, "-o", tmp_path / "file" / name)
    if HAS_VIEWER or command != "publish":  # without it that is said first
        assert_one_sentence(answer, "cannot be written here")
    assert answer.exit_code == 1
    assert "..." not in answer.stderr


def test_whether_a_file_can_be_read_is_not_for_the_parser_to_say(run, ball, tmp_path, monkeypatch):
    # It would exit with 2, as if the command line were at fault.
    camera = tmp_path / "cam.json"
    camera.write_text('{"position": [0, 0, 4], "target": [0, 0, 0], "size": [5, 4]}')
    monkeypatch.setattr("os.access", lambda *_, **__: False)
    for words in (
        ["info", ball],
        ["check", ball, "--deep", "--original", ball],
        ["build", ball, "-o", tmp_path / "a.fov"],
        ["export", ball, "-o", tmp_path / "a.ply"],
        ["render", ball, "-o", tmp_path / "a.png", "--camera", camera],
        ["build", ball, "-o", tmp_path / "a.fov", "--force"],
    ):
        answer = run(*words)
        assert answer.exit_code == 0, answer.stderr


def test_debug_shows_where(run, tmp_path):
    assert "Traceback" in run("info", tmp_path / "none.fov", "--debug").stderr


def test_a_cluster_that_does_not_answer(run, ball_mesh, tmp_path, monkeypatch):
    monkeypatch.setattr("distributed.Client", lambda *_, **__: (_ for _ in ()).throw(OSError("nobody")))
    answer = run("build", ball_mesh, "-o", tmp_path / "a.fov", "--dask", "tcp://127.0.0.1:1")
    assert_one_sentence(answer, "no cluster answers")


def test_no_memory_and_full_disks_are_said(run, ball, monkeypatch):
    for error, part in (
        (MemoryError(), "--memory"),
        (OSError(28, "No space left on device", "/x"), "No space left"),
    ):
        monkeypatch.setattr("foveal.info", lambda *_, error=error, **__: (_ for _ in ()).throw(error))
        assert_one_sentence(run("info", ball), part)


def test_as_a_process(spawn, ball, tmp_path):
    good = spawn("info", ball, "--json")
    bad = spawn("info", "none.fov")
    usage = spawn("nonsense")
    out, error = good.communicate(timeout=60)
    assert (good.returncode, error) == (0, "")
    assert json.loads(out)["kind"] == "multires"
    out, error = bad.communicate(timeout=60)
    assert (bad.returncode, out) == (1, "")
    assert error == "foveal: none.fov: there is no such file.\n"
    usage.communicate(timeout=60)
    assert usage.returncode == 2


@pytest.mark.skipif(sys.platform == "win32", reason="Windows limits no file size")
@pytest.mark.parametrize(
    ("command", "name"), [("build", "a.fov"), ("export", "a.ply"), ("render", "a.png"), ("publish", "a")]
)
def test_a_disk_that_is_full_is_said_and_nothing_is_left(run, environment, ball, tmp_path, command, name):
    if command == "publish" and not HAS_VIEWER:
        pytest.skip("there is no viewer to publish; ./do test builds it first")
    # Once without the limit, so that no kernel is left to be compiled and written.
    assert run(command, ball, "-o", tmp_path / f"first-{name}").exit_code == 0
    out = tmp_path / "out"
    out.mkdir()
    answer = subprocess.run(
        [sys.executable, "-m", "foveal", command, ball, "-o", out / name],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)),
    )
    assert answer.returncode == 1
    assert "Free some space" in answer.stderr.splitlines()[-1]
    assert "Traceback" not in answer.stderr
    assert list(out.iterdir()) == []
    assert not any((tmp_path / "tmp").iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="only there a name may be any bytes")
def test_names_that_cannot_be_said_are_spelled(spawn, ball, tmp_path):
    path = tmp_path / os.fsdecode(b"bell\x07\xff.fov")
    path.write_bytes(ball.read_bytes())
    out, error = spawn("info", path).communicate(timeout=60)
    assert error == ""
    assert "bell\\x07\\udcff.fov: " in out
    out, _ = spawn("info", path, "--json").communicate(timeout=60)
    assert json.loads(out)["file"] == str(path)
    _, error = spawn("info", os.fsdecode(b"\x1b[2J\xff")).communicate(timeout=60)
    assert error == "foveal: \\x1b[2J\\udcff: there is no such file.\n"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
def test_a_stdout_that_takes_nothing(environment, ball):
    with open("/dev/full", "w") as full:
        answer = subprocess.run(
            [sys.executable, "-m", "foveal", "info", ball],
            env=environment,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert (answer.returncode, answer.stderr.count("\n")) == (1, 1)


@pytest.fixture
def interrupted(spawn, tmp_path):
    """A build of a larger mesh that got a signal when it was under way."""
    write_ply(bumpy_sphere(7), tmp_path / "large.ply")  # seconds to build, so the signal comes before the end

    def begin(signal_number):
        child = spawn("build", "large.ply", "-o", "out/large.fov", "--quiet")
        deadline = time.monotonic() + 60
        while not any((tmp_path / "tmp").glob(".foveal-scratch-*")):
            assert child.poll() is None, child.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.01)
        time.sleep(0.2)
        child.send_signal(signal_number)
        out, error = child.communicate(timeout=60)
        return child.returncode, out, error

    return begin


@pytest.mark.skipif(
    sys.platform == "win32", reason="Windows cannot send SIGINT or SIGKILL to one child alone"
)
@pytest.mark.parametrize(("name", "wanted"), [("SIGINT", 130), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_who_is_told_to_end_leaves_nothing(interrupted, tmp_path, name, wanted):
    code, out, error = interrupted(getattr(signal, name))
    assert code == wanted
    assert (out, error.strip()) == ("", "")
    assert not list(tmp_path.glob("out/*"))
    assert not list(tmp_path.glob("out/.*"))
    assert not list((tmp_path / "tmp").iterdir())


def test_ctrl_c_while_python_still_imports(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "foveal.cli.app", None)
    with pytest.raises(ImportError):
        main.run()

    class Interrupting:
        def __getattr__(self, name):
            raise KeyboardInterrupt

    monkeypatch.setitem(sys.modules, "foveal.cli.app", Interrupting())
    with pytest.raises(SystemExit) as exit:
        main.run()
    assert (exit.value.code, capsys.readouterr()) == (130, ("", ""))


@pytest.mark.skipif(
    sys.platform == "win32", reason="Windows cannot send SIGINT or SIGKILL to one child alone"
)
def test_a_killed_build_leaves_nothing_whole_and_the_next_one_sweeps(interrupted, run, tmp_path, monkeypatch):
    code, _, _ = interrupted(signal.SIGKILL)
    assert code == -signal.SIGKILL
    assert not (tmp_path / "out" / "large.fov").exists()
    assert list((tmp_path / "tmp").iterdir())
    (tmp_path / "out").mkdir(exist_ok=True)
    (tmp_path / "out" / f".large.fov.{_MACHINE}-999999999.part").write_bytes(
        b"as a kill while writing leaves it"
    )
    write_ply(icosphere(2), tmp_path / "small.ply")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    assert run("build", tmp_path / "small.ply", "-o", tmp_path / "out" / "large.fov").exit_code == 0
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["large.fov"]
    assert not list((tmp_path / "tmp").iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one child alone")
@pytest.mark.skipif(not HAS_VIEWER, reason="there is no viewer to serve; ./do test builds it first")
def test_ctrl_c_while_serving_is_success(spawn, ball, tmp_path):
    import urllib.request

    child = spawn("view", ball, "--no-browser", "--port", "0")
    line = child.stdout.readline()
    url = line.split()[0]
    assert json.load(urllib.request.urlopen(url + "scene.json"))["title"] == "ball"
    child.send_signal(signal.SIGINT)
    out, error = child.communicate(timeout=30)
    assert (child.returncode, out, error) == (0, "", "")
