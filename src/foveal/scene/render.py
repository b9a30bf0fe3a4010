"""A picture of a scene by the CPU rasteriser, with each asset as fine as the picture shows."""

import dataclasses
import json
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .scene import Layer, Scene

__all__ = ["frame", "read_camera", "render"]

_UP = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_FROM = {"x": (0.25, -0.3, 1.0), "y": (0.3, 0.25, 1.0), "z": (0.3, -1.0, 0.25)}
"""From the object to the eye, by the axis that points up: 0.3 to the right, 0.25 up, 1 to the front, which is
-y where z is up and else z: the viewer's home."""


def read_camera(path: str | os.PathLike[str], /, *, size: tuple[int, int] | None = None) -> Camera:
    """Read a camera file, as `Camera.to_json` gives it; `size` in pixels goes before the file's.

    Raises
    ------
    FovealError
        If the file is missing or is no camera.
    """
    path = Path(path)
    try:
        data = json.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError as error:
        raise FovealError(f"{path}: there is no such file.") from error
    except OSError as error:
        raise FovealError(f"{path}: cannot be read ({error.strerror}).") from error
    except ValueError as error:
        raise FovealError(f"{path}: this is not JSON ({error}).") from error
    camera = Camera.from_json(data, name=str(path))
    return camera if size is None else camera.resized(*size)


def frame(scene: Scene, /, *, size: tuple[int, int] = (1280, 720)) -> Camera:
    """A camera that sees every visible layer whole, from where the viewer begins."""
    from foveal import multires

    lows, highs, up = [], [], "y"
    for layer in _visible(scene):
        with multires.open(layer.path) as asset:
            origin, step = np.array(asset.header["origin"]), asset.header["step"]
            low, high = np.array(asset.header["box"], dtype=np.float64)
            up = asset.header.get("up", "y")
        lows.append(origin + step * low)
        highs.append(origin + step * high)
    return Camera.around(
        np.min(lows, axis=0),
        np.max(highs, axis=0),
        direction=_FROM[up],
        up=_UP[up],
        width=size[0],
        height=size[1],
    )


def render(
    scene: Scene,
    camera: Camera | None = None,
    /,
    *,
    error_px: float = 1.0,
    triangle_budget: int | None = None,
) -> NDArray[np.uint8]:
    """Draw what a camera sees.

    Parameters
    ----------
    scene : Scene
        Its visible layers are drawn.
    camera : Camera, optional
        By default the whole of the scene, framed.
    error_px : float
        How wrong the surface may look, in pixels.
    triangle_budget : int, optional
        At most about this many triangles for each layer.

    Returns
    -------
    (height, width, 3) uint8
        sRGB; write it with `foveal.raster.write_png`. Behind all is the scene's background, or else the
        viewer's light one, a gradient.
    """
    from foveal import multires, raster
    from foveal.lod.select import cut

    camera = camera or frame(scene)
    meshes = []
    for layer in _visible(scene):
        with multires.open(layer.path) as asset:
            origin = np.array(asset.header["origin"])
            seen = cut(
                asset.graph, _moved(camera, -origin), error_px=error_px, triangle_budget=triangle_budget
            )
            meshes.append(asset.mesh_of(seen.expanded))
    background = _rgb(scene.background) if scene.background else raster.gradient(camera)
    return np.ascontiguousarray(raster.picture(_joined(meshes), camera, background=background)[..., :3])


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def _visible(scene: Scene) -> list[Layer]:
    return [layer for layer in scene.layers if layer.is_visible] or list(scene.layers[:1])


def _moved(camera: Camera, shift: NDArray[np.float64]) -> Camera:
    return dataclasses.replace(camera, position=camera.position + shift, target=camera.target + shift)


def _joined(meshes: list[TriMesh]) -> TriMesh:
    """All meshes as one; an attribute is kept if every mesh has it."""
    if len(meshes) == 1:
        return meshes[0]
    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    normals = [mesh.normals for mesh in meshes if mesh.normals is not None]
    colours = [mesh.colours for mesh in meshes if mesh.colours is not None]
    return TriMesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate(faces).astype(np.int32),
        np.concatenate(normals) if len(normals) == len(meshes) else None,
        np.concatenate(colours) if len(colours) == len(meshes) else None,
    )
