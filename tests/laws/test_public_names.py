"""The public interface: its names exist, are explained, and take their arguments in the house's way."""

import importlib
import inspect
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

import foveal
import foveal.server.view

VERBS = {
    name: foveal.server.view.view if name == "view" else getattr(foveal, name)
    for name in foveal.__all__
    if name.islower() and not name.startswith("_")
}
JOINING = ("foveal.scene.", "foveal.server.", "foveal.raster.", "foveal.view.")
MODULES = sorted(
    info.name
    for info in pkgutil.walk_packages(foveal.__path__, "foveal.")
    if not info.name.startswith(("foveal.cli", "foveal.__main__")) and "._kernels" not in info.name
)


def test_the_front_door():
    assert set(foveal.__all__) < set(dir(foveal))
    for name in foveal.__all__:
        assert getattr(foveal, name) is not None
    with pytest.raises(AttributeError, match="nonsense"):
        _ = foveal.nonsense


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_is_explained_with_an_example(name):
    verb = VERBS[name]
    gives = inspect.signature(verb).return_annotation
    # `open` is the room's own; what it gives shows in its example how it was opened.
    assert ">>> " in f"{inspect.getdoc(verb)} {inspect.getdoc(gives)}"


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_is_one_file_of_its_name(name):
    assert name == "open" or VERBS[name].__module__.rpartition(".")[2] == name


def test_every_command_is_a_verb():
    from foveal.cli.app import app

    # In Python `foveal.refine` is the room, whose verb over arrays is `foveal.refine.sqrt3`.
    named = {command.callback.__name__ for command in app.registered_commands}
    assert named - {"refine"} <= VERBS.keys()
    assert ">>> " in inspect.getdoc(importlib.import_module("foveal.scene.refine").refine)


def test_rooms_are_there_without_importing_each():
    code = "import foveal; print(foveal.raster.picture.__name__, foveal.mesh.TriMesh.__name__)"
    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert child.stdout.split() == ["picture", "TriMesh"]
    rooms = {Path(path).parent.name for path in Path(foveal.__path__[0]).glob("*/__init__.py")}
    missing = rooms - {"cli"} - set(dir(foveal))
    assert not missing, f"name {', '.join(missing)} in _ROOMS of foveal/__init__.py"


def test_view_is_both_the_room_and_the_verb():
    from foveal.view.camera import Camera

    assert callable(foveal.view)
    assert foveal.view.camera.Camera is Camera is foveal.Camera
    with pytest.raises(foveal.FovealError, match="no such file"):
        foveal.view("none.ply")


@pytest.mark.parametrize("name", MODULES)
def test_every_module_says_what_it_is_and_what_it_gives(name):
    module = importlib.import_module(name)
    assert (module.__doc__ or "").strip(), f"{name} has no docstring"
    for member in getattr(module, "__all__", []):
        assert hasattr(module, member), f"{name} lists {member}, which it has not"


@pytest.mark.parametrize(
    "name", [name for name in MODULES if name.count(".") == 1 or name.startswith(JOINING)]
)
def test_data_is_positional_and_options_are_named(name):
    module = importlib.import_module(name)
    for function in module.__all__ if hasattr(module, "__all__") else ():
        member = getattr(module, function)
        if not inspect.isfunction(member):
            continue
        assert inspect.getdoc(member), f"{name}.{function} has no docstring"
        for parameter in inspect.signature(member).parameters.values():
            is_loose = parameter.kind is parameter.POSITIONAL_OR_KEYWORD
            assert not is_loose, (
                f"{name}.{function}: {parameter.name} must be positional-only or keyword-only"
            )
