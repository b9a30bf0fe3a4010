"""scene.json, version 1: assets put together, with named views.

    {"version": 1,
     "title": "Statue",
     "layers": [{"name": "statue", "asset": "data/statue.fov", "visible": true}],
     "light": {"asset": "data/shadow.fov"},
     "views": [{"name": "front", "camera": {"position": [0, 0, 5], "target": [0, 0, 0]}}],
     "background": "#20242a"}

`title`, `visible`, `light` (a file that `foveal shadow` made), `views` and `background` may be left out. A
light may have `moving`, names of layers that were not among what cast when it was made. A
layer of a control mesh may have what `refinement.py` keeps (`scheme`, `criteria`, `positions`, `budget`,
`rate`), in place of what its file says.
An asset is a path relative to the folder of the scene.json, with forward slashes, that does not leave it: a
scene that came from elsewhere must not make a server give out other files. Keys that are not known are
ignored, for what later versions add.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, read_json, whole_file
from foveal.container import open_container
from foveal.view.camera import Camera

from .cage_file import KIND as CAGE
from .cage_file import control_mesh
from .refinement import Refinement, RefineOptions, refinement_json, refinement_of
from .scene_light import KIND as SHADOW
from .scene_light import light_file

__all__ = ["Layer", "Scene", "View", "read_scene", "scene_json", "scene_of", "write_scene"]

VERSION = 1
# What no name may hold: control characters, and halves of characters, which no UTF-8 can say.
_UNSAYABLE = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")


@dataclass(frozen=True, slots=True)
class Layer:
    """One asset of a scene.

    Attributes
    ----------
    name : str
        For people.
    path : Path
        The `.fov`.
    is_visible : bool
        Whether it is shown at first.
    refinement : Refinement or None
        Of a control mesh, how it is refined; None for any other asset.
    is_moving : bool
        Whether it is beside what the scene's light was precomputed for: it casts, and is cast on, by an
        ordinary shadow map.
    """

    name: str
    path: Path
    is_visible: bool = True
    refinement: Refinement | None = None
    is_moving: bool = False


@dataclass(frozen=True, slots=True)
class View:
    """A camera with a name."""

    name: str
    camera: Camera


@dataclass(frozen=True, slots=True)
class Scene:
    """Assets put together: what the viewer shows, `render` draws and `publish` copies.

    Attributes
    ----------
    title : str
        For people.
    layers : tuple of Layer
        At least one.
    views : tuple of View
        Named cameras.
    background : str or None
        sRGB as "#rrggbb"; None lets the viewer choose by its dark or light dress.
    light : Path or None
        The `.fov` of a light's shadows; None has the eye carry the light.
    """

    title: str
    layers: tuple[Layer, ...]
    views: tuple[View, ...] = ()
    background: str | None = None
    light: Path | None = None

    @property
    def assets(self) -> tuple[Path, ...]:
        """All files: of the layers, and of the light."""
        return (*(layer.path for layer in self.layers), *([self.light] if self.light else []))


def scene_of(path: PathLike, /, *, title: str | None = None, options: RefineOptions | None = None) -> Scene:
    """A scene of one layer from one `.fov`.

    Parameters
    ----------
    path
        The file.
    title : str, optional
        By default its name.
    options : RefineOptions, optional
        Of a control mesh, what is chosen in place of what its file says.

    Raises
    ------
    FovealError
        If there is no such file or it is not a `.fov` that this version reads.
    """
    path = Path(path)
    refinement = _refinement(path)
    if refinement is not None:
        refinement = refinement.chosen(options or {})
    name = _UNSAYABLE.sub("_", title or path.stem)  # file systems allow what scene.json does not
    return Scene(name, (Layer(name, path.resolve(), refinement=refinement),))


def _refinement(path: Path) -> Refinement | None:
    """What a control mesh's file says of its refinement; None for patches; nothing else is shown."""
    with open_container(path) as file:
        if file.kind == CAGE:
            return control_mesh(file).refinement
        if file.kind == SHADOW:
            raise FovealError(
                f"{path}: it holds the shadows of a light, and no surface. Name a mesh, with --shadow {path}."
            )
        file.expect("multires", 1)
        return None


def read_scene(path: PathLike, /) -> Scene:
    """Read a scene.json, or take a lone `.fov` as a scene of one layer.

    Raises
    ------
    FovealError
        In one sentence: not JSON, an unknown version, a key of the wrong kind, an asset that is
        missing, not a `.fov`, or outside the scene's folder.
    """
    path = Path(path)
    if path.suffix.lower() != ".json":
        return scene_of(path)
    data = read_json(path)
    if not isinstance(data, dict) or "version" not in data or "layers" not in data:
        raise FovealError(f'{path}: this is not a scene.json; it needs "version" and "layers".')
    if data["version"] != VERSION:
        raise FovealError(
            f"{path}: scene version {data['version']!r} is not known; this foveal reads version {VERSION}. "
            "Use a newer one."
        )
    layers = _list(data, "layers", path)
    if not layers:
        raise FovealError(f'{path}: "layers" is empty; name at least one asset.')
    background = data.get("background")
    if background is not None and not (
        isinstance(background, str) and re.fullmatch("#[0-9a-fA-F]{6}", background)
    ):
        raise FovealError(f'{path}: "background" must be a colour such as "#20242a", got {background!r}.')
    return Scene(
        _text(data, "title", path.parent.resolve().name, path),
        _moving(
            [_layer(layer, f'layer {n} of "layers"', path) for n, layer in enumerate(layers, 1)], data, path
        ),
        tuple(_view(view, n, path) for n, view in enumerate(_list(data, "views", path), 1)),
        background,
        _light(data.get("light"), path),
    )


def _light(data: Any, path: Path) -> Path | None:
    if data is None:
        return None
    if not isinstance(data, dict) or not isinstance(data.get("asset"), str):
        raise FovealError(f'{path}: "light" needs an "asset", the path of a file by \'foveal shadow\'.')
    return light_file(_contained(data["asset"], '"light"', path))


def _moving(layers: list[Layer], data: Mapping[str, Any], path: Path) -> tuple[Layer, ...]:
    """The layers, with those that the light names as moving marked so."""
    light = data.get("light")
    names = light.get("moving", []) if isinstance(light, dict) else []
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise FovealError(f'{path}: "moving" of "light" must be a list of names of layers.')
    unknown = sorted({*names} - {layer.name for layer in layers})
    if unknown:
        raise FovealError(
            f'{path}: "moving" of "light" names {unknown[0]!r:.60}, and no layer has that name.'
        )
    return tuple(replace(layer, is_moving=layer.name in names) for layer in layers)


def _list(data: Mapping[str, Any], key: str, path: Path) -> list[Any]:
    value = data.get(key, [])
    if not isinstance(value, list) or len(value) > 10_000:
        raise FovealError(f'{path}: "{key}" must be a list, of at most 10,000 members.')
    return value


def _text(data: Mapping[str, Any], key: str, default: str, path: Path) -> str:
    value = data.get(key, default)
    if not isinstance(value, str) or len(value) > 1000 or _UNSAYABLE.search(value):
        raise FovealError(f'{path}: "{key}" must be a short text of one line, got {value!r:.60}.')
    return value


def _layer(data: Any, where: str, path: Path) -> Layer:
    if not isinstance(data, dict) or not isinstance(data.get("asset"), str):
        raise FovealError(f'{path}: {where} needs an "asset", the path of a .fov file.')
    asset = _contained(data["asset"], where, path)
    is_visible = data.get("visible", True)
    if not isinstance(is_visible, bool):
        raise FovealError(f'{path}: "visible" of {where} must be true or false, got {is_visible!r:.60}.')
    refinement = _refinement(asset)
    if refinement is not None:
        refinement = refinement_of(data, f"{path}: {where}", default=refinement)
    return Layer(_text(data, "name", asset.stem, path), asset, is_visible, refinement)


def _contained(asset: str, where: str, path: Path) -> Path:
    """The asset's own path, links resolved, if it lies in the folder of the scene.json."""
    folder = path.parent.resolve()
    pure = PurePosixPath(asset)
    is_plain = (
        asset
        and not pure.is_absolute()
        and ".." not in pure.parts
        and not re.search(r"[\\:]", asset)
        and not _UNSAYABLE.search(asset)
    )
    found = (folder / pure).resolve() if is_plain else None
    if found is None or not found.is_relative_to(folder):
        raise FovealError(
            f"{path}: the asset {asset!r} of {where} leaves the folder of the scene. Move the file there."
        )
    return found


def _view(data: Any, number: int, path: Path) -> View:
    if not isinstance(data, dict):
        raise FovealError(f'{path}: view {number} must have a "name" and a "camera".')
    name = _text(data, "name", f"view {number}", path)
    return View(name, Camera.from_json(data.get("camera"), name=f"{path}: view {name!r}"))


def scene_json(
    scene: Scene, addresses: Mapping[Path, str], /, *, live: Mapping[Path, str] | None = None
) -> bytes:
    """The scene.json's bytes, with the address of each asset and, if a server refines it, of that session."""
    data: dict[str, Any] = {
        "version": VERSION,
        "title": scene.title,
        "layers": [
            {
                "name": layer.name,
                "asset": addresses[layer.path],
                "visible": layer.is_visible,
                **(refinement_json(layer.refinement) if layer.refinement else {}),
                **({"live": live[layer.path]} if layer.refinement and live else {}),
            }
            for layer in scene.layers
        ],
        "views": [{"name": view.name, "camera": view.camera.to_json()} for view in scene.views],
    }
    if scene.light is not None:
        moving = [layer.name for layer in scene.layers if layer.is_moving]
        data["light"] = {"asset": addresses[scene.light], **({"moving": moving} if moving else {})}
    if scene.background is not None:
        data["background"] = scene.background
    return (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode()


def write_scene(scene: Scene, path: PathLike, /) -> None:
    """Write a scene.json beside or above its assets; it appears whole or not at all.

    Raises
    ------
    FovealError
        If an asset lies outside the folder of `path`, where no reader would accept it.
    """
    path = Path(path)
    folder = path.parent.resolve()
    for asset in scene.assets:
        if not asset.resolve().is_relative_to(folder):
            raise FovealError(
                f"{path}: the asset {asset} lies outside this folder. Move it there, or use 'foveal publish'."
            )
    addresses = {asset: asset.resolve().relative_to(folder).as_posix() for asset in scene.assets}
    with whole_file(path) as out:
        out.write(scene_json(scene, addresses))
