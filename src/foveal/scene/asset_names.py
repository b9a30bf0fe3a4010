"""What the files of a scene are called where it is published or served."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["asset_names"]

_RESERVED = {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))}


def asset_names(scene: "Scene", /) -> dict[Path, str]:
    """A file name for each asset, after its layer, safe in a URL and on any file system, no two alike.

    Examples
    --------
    >>> from foveal.scene import Layer, Scene
    >>> layers = (Layer("My Statue", Path("x/a.fov")), Layer("my statue", Path("y/a.fov")))
    >>> list(asset_names(Scene("two", layers)).values())
    ['My-Statue.fov', 'my-statue-2.fov']
    """
    names: dict[Path, str] = {}
    taken: set[str] = set()
    called = [(layer.name, layer.path) for layer in scene.layers]
    if scene.light is not None:
        called.append(("shadow", scene.light))
    for text, path in called:
        if path in names:  # one asset may be in two layers
            continue
        stem = re.sub("[^A-Za-z0-9_.-]+", "-", text).strip("-.")[:80] or "asset"
        if stem.lower() in _RESERVED:
            stem = f"{stem}-asset"
        name, number = stem, 1
        while name.lower() in taken:  # Windows and macOS do not tell cases apart
            number += 1
            name = f"{stem}-{number}"
        taken.add(name.lower())
        names[path] = f"{name}.fov"
    return names
