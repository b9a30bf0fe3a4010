"""The public interface: its names exist, are explained, and take their arguments in the house's way."""

import importlib
import inspect
import pkgutil

import pytest

import foveal
from foveal import _api

MODULES = sorted(
    info.name
    for info in pkgutil.walk_packages(foveal.__path__, "foveal.")
    if not info.name.startswith(("foveal.cli", "foveal.__main__")) and "._kernels" not in info.name
)


def test_the_front_door():
    assert set(dir(foveal)) == set(foveal.__all__)
    for name in foveal.__all__:
        assert getattr(foveal, name) is not None
    with pytest.raises(AttributeError, match="nonsense"):
        _ = foveal.nonsense


@pytest.mark.parametrize("name", _api.__all__)
def test_every_verb_is_explained_with_an_example(name):
    assert name in foveal.__all__
    text = inspect.getdoc(getattr(_api, name))
    assert ">>> " in text


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


@pytest.mark.parametrize("name", ["foveal._api", *(name for name in MODULES if name.count(".") == 1)])
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
