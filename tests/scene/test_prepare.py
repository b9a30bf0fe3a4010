"""The cache of built files: built once, anew when anything changed, the least used go first."""

import os
import shutil
import time

import pytest

from foveal import FovealError
from foveal.mesh.io import write_ply
from foveal.mesh.shapes import icosphere
from foveal.scene import prepare as module
from foveal.scene import scene_of, write_scene
from foveal.scene.build import build
from foveal.scene.prepare import load, prepare


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "my ball.ply"
    write_ply(icosphere(2), path)
    return path


@pytest.fixture
def builds(monkeypatch):
    """The outputs of builds, in order."""
    made = []
    real = module.build

    def counted(source, output, /, **options):
        made.append(output)
        return real(source, output, **options)

    monkeypatch.setattr(module, "build", counted)
    return made


def test_a_fov_is_taken_as_it_is(tmp_path, fov, builds):
    assert prepare(fov, folder=tmp_path / "cache") == fov
    assert builds == []


def test_the_second_time_nothing_is_built(tmp_path, ball, builds):
    first = prepare(ball, folder=tmp_path / "cache")
    written = first.stat().st_mtime_ns
    second = prepare(ball, folder=tmp_path / "cache")
    assert first == second
    assert len(builds) == 1
    assert second.stat().st_mtime_ns == written  # its ETag stays, so browsers keep what they have


def test_a_copy_under_the_same_content_is_the_same(tmp_path, ball, builds):
    first = prepare(ball, folder=tmp_path / "cache")
    (tmp_path / "copy").mkdir()
    shutil.copyfile(ball, tmp_path / "copy" / ball.name)
    assert prepare(tmp_path / "copy" / ball.name, folder=tmp_path / "cache") == first


def test_a_changed_file_or_option_is_built_anew(tmp_path, ball, builds):
    found = {prepare(ball, folder=tmp_path / "cache")}
    found.add(prepare(ball, folder=tmp_path / "cache", bits=10))
    found.add(prepare(ball, folder=tmp_path / "cache", up="z"))
    write_ply(icosphere(2, radius=1.5), ball)
    found.add(prepare(ball, folder=tmp_path / "cache"))
    assert len(found) == len(builds) == 4


def test_changed_code_builds_anew(tmp_path, ball, monkeypatch):
    first = prepare(ball, folder=tmp_path / "cache")
    monkeypatch.setattr(module, "_builder", lambda: "another foveal")
    assert prepare(ball, folder=tmp_path / "cache") != first


def test_large_files_are_told_by_their_ends_and_their_time(tmp_path, ball, monkeypatch):
    monkeypatch.setattr(module, "_WHOLE", 100)
    monkeypatch.setattr(module, "_END", 50)
    first = module._fingerprint(ball, {})
    assert module._fingerprint(ball, {}) == first
    os.utime(ball, ns=(0, ball.stat().st_mtime_ns + 1))
    assert module._fingerprint(ball, {}) != first


def test_a_changed_texture_is_a_changed_model(tmp_path):
    model = tmp_path / "model.obj"
    model.write_text("mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    before = module._fingerprint(model, {})
    (tmp_path / "textures").mkdir()
    (tmp_path / "textures" / "skin.png").write_bytes(b"1")
    assert module._fingerprint(model, {}) != before


def test_the_least_used_go_first_and_the_new_one_stays(tmp_path, ball):
    cache = tmp_path / "cache"
    cache.mkdir()
    now = time.time_ns()
    for age, name in enumerate(["newest", "middle", "oldest"]):
        path = cache / f"{name}.fov"
        path.write_bytes(bytes(100_000))
        os.utime(path, ns=(now - (age + 1) * 10**12, now))
    built = prepare(ball, folder=cache, limit_bytes=250_000)
    assert {path.stem for path in cache.iterdir()} == {built.stem, "newest", "middle"}
    other = prepare(ball, folder=cache, limit_bytes=1, bits=9)
    assert list(cache.iterdir()) == [other]


def test_litter_of_killed_builds_goes(tmp_path, ball):
    cache = tmp_path / "cache"
    cache.mkdir()
    for name, age in ((".gone.fov.999.part", 10**6), (".fresh.fov.998.part", 10)):
        (cache / name).write_bytes(b"x")
        os.utime(cache / name, (time.time() - age, time.time() - age))
    built = prepare(ball, folder=cache)
    assert {path.name for path in cache.iterdir()} == {built.name, ".fresh.fov.998.part"}


def test_a_failed_build_leaves_nothing(tmp_path):
    bad = tmp_path / "bad.ply"
    bad.write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n")
    with pytest.raises(FovealError):
        prepare(bad, folder=tmp_path / "cache")
    assert not (tmp_path / "cache").exists() or list((tmp_path / "cache").iterdir()) == []


def test_a_mesh_in_memory_is_built_once_too(tmp_path, builds):
    paths = {prepare(icosphere(2), folder=tmp_path / "cache") for _ in range(2)}
    paths.add(prepare(icosphere(2, radius=2.0), folder=tmp_path / "cache"))
    assert len(paths) == len(builds) == 2


def test_a_scene_of_a_mesh_has_its_name(tmp_path, ball, monkeypatch):
    monkeypatch.setattr(module, "cache_folder", lambda: tmp_path / "cache")
    scene = load(ball)
    assert scene.title == scene.layers[0].name == "my ball"


@pytest.mark.parametrize(("name", "sentence"), [("none.ply", "no such file"), ("", "folder")])
def test_what_is_not_there_is_said(tmp_path, name, sentence):
    with pytest.raises(FovealError, match=sentence):
        prepare(tmp_path / name, folder=tmp_path / "cache")


def test_a_first_run_says_so_before_anything_is_compiled(tmp_path, monkeypatch):
    said = []

    class Listener:
        def note(self, sentence):
            said.append(sentence)

    def opening(*_, **__):
        raise FovealError("opened")

    monkeypatch.setattr("foveal.base.jit.is_cold", lambda: True)
    monkeypatch.setattr("foveal.mesh.io.open_source", opening)
    (tmp_path / "a.obj").write_text("v 0 0 0\n")
    with pytest.raises(FovealError, match="opened"):
        build(tmp_path / "a.obj", tmp_path / "a.fov", progress=Listener())
    assert "kernels are compiled" in said[0]


@pytest.mark.parametrize("option", [{"bits": 9}, {"step": 0.1}, {"normals": "none"}, {"up": "z"}])
def test_options_that_come_too_late_are_said(tmp_path, fov, option):
    write_scene(scene_of(fov), tmp_path / "scene.json")
    for source in (fov, tmp_path / "scene.json", scene_of(fov)):
        with pytest.raises(FovealError, match=f"built already, so {next(iter(option))} would"):
            load(source, **option)
    load(fov, memory_bytes=10**9, workers=1, bits=None)  # these change no byte


def test_an_option_that_there_is_not_is_the_programmers_fault(ball, fov, tmp_path):
    prepare(ball, folder=tmp_path / "cache")  # so that it is at hand, and nothing looks at options again
    for source in (ball, fov):
        with pytest.raises(TypeError, match="bit"):
            prepare(source, folder=tmp_path / "cache", bit=9)


def test_a_scene_is_taken_as_it_is(fov):
    scene = scene_of(fov)
    assert load(scene) is scene


def test_a_cache_that_cannot_be_written_is_said_before_any_work(tmp_path, ball, builds):
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(FovealError, match="foveal build FILE -o"):
        prepare(ball, folder=tmp_path / "file" / "cache")
    assert builds == []


def test_a_file_of_somebody_else_is_shown_all_the_same(tmp_path, ball, monkeypatch):
    built = prepare(ball, folder=tmp_path / "cache")

    def utime(*_, **__):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr("os.utime", utime)
    assert prepare(ball, folder=tmp_path / "cache") == built
