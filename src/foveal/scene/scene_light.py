"""The light of a scene: a `.fov` of kind "shadow" beside the layers."""

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, refuse_missing
from foveal.container import Container, open_container

if TYPE_CHECKING:
    from .scene import Scene

__all__ = ["KIND", "is_shadow", "light_file", "shadow_facts", "with_light"]

KIND, VERSION = "shadow", 1
_NODES = ("leaf", "empty", "inner")


def is_shadow(path: PathLike, /) -> bool:
    """Whether a `.fov` holds the shadows of a light.

    Raises
    ------
    FovealError
        If it is no `.fov`.
    """
    if Path(path).suffix.lower() != ".fov":
        return False
    with open_container(path) as file:
        return file.kind == KIND


def light_file(path: PathLike, /) -> Path:
    """The path of a file that holds the shadows of a light, links resolved.

    Raises
    ------
    FovealError
        If there is none, or it holds something else.
    """
    refuse_missing(path)
    with open_container(path) as file:
        if file.kind != KIND:
            raise FovealError(
                f"{file.name}: it holds {file.kind!r} and no shadows. Make some with 'foveal shadow'."
            )
        file.expect(KIND, VERSION)
    return Path(path).resolve()


def with_light(scene: "Scene", shadow: PathLike | None, /) -> "Scene":
    """The scene in another light; as it is, if that is None.

    Raises
    ------
    FovealError
        As `light_file` does.
    """
    return scene if shadow is None else dataclasses.replace(scene, light=light_file(shadow))


def shadow_facts(file: Container, size: int, /) -> dict[str, Any]:
    """What `info` says of such a file, by its header alone.

    Raises
    ------
    FovealError
        If it is of another version, or its header is damaged.
    """
    file.expect(KIND, VERSION)
    header = file.header
    levels, images, nodes = header.get("levels"), header.get("images"), header.get("nodes")
    light, projections = header.get("light"), header.get("projections")
    if not (
        isinstance(levels, int)
        and 0 <= levels <= 32
        and isinstance(images, int)
        and isinstance(projections, list)
        and isinstance(nodes, dict)
        and all(isinstance(nodes.get(kind), int) for kind in _NODES)
        and isinstance(light, dict)
        and isinstance(light.get("kind"), str)
    ):
        raise FovealError(f"{file.name}: its header is damaged. Copy it again, or make it anew.")
    side = 1 << levels
    return {
        "file": file.name,
        "kind": KIND,
        "version": file.version,
        "bytes": size,
        "light": light,
        "resolution": side,
        "images": images,
        "maps": len(projections),
        "pixels": side * side * len(projections),
        "nodes": {kind: nodes[kind] for kind in _NODES},
        "generator": header.get("generator"),
    }
