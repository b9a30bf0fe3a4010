"""A picture by the CPU rasteriser of anything that can be shown, each asset as fine as the picture shows."""

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from numpy.typing import NDArray

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, read_json, refuse_unwritable
from foveal.base.progress import SILENT, Progress
from foveal.mesh.polymesh import PolyMesh
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from .build import BuildOptions, up_of
from .cage_file import read_cage
from .lighting import Lighting, lighting, lighting_of
from .prepare import load
from .scene import Layer, Scene
from .source import Source, checked, triangles_of

if TYPE_CHECKING:
    from foveal.raster import Picture, SceneLight
    from foveal.shadows import ShadowMap

__all__ = ["draw", "frame", "home", "read_camera", "render"]

_SIZE = (1280, 720)
_UP = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
_FROM = {"x": (0.25, -0.3, 1.0), "y": (0.3, 0.25, 1.0), "z": (0.3, -1.0, 0.25)}
"""From the object to the eye, by the axis that points up: 0.3 to the right, 0.25 up, 1 to the front, which is
-y where z is up and else z: the viewer's home."""


def render(
    source: Source | Scene,
    output: PathLike | None = None,
    /,
    *,
    camera: Camera | PathLike | None = None,
    size: tuple[int, int] | None = None,
    error_px: float = 1.0,
    triangles: int | None = None,
    shadow: "ShadowMap | PathLike | None" = None,
    shadow_filter: str | None = None,
    shadow_image: int = 0,
    progress: Progress = SILENT,
    **options: Unpack[BuildOptions],
) -> "Picture":
    """Draw a mesh, a `.fov` or a scene.json on the CPU: the same pixels on every machine.

    Parameters
    ----------
    source : path, TriMesh, PolyMesh or Scene
        What to draw. A mesh in a file is built into the user's cache first; one in memory is drawn as it
        is, every triangle, but with a `scheme`.
    output : path, optional
        A PNG to write.
    camera : Camera or path, optional
        By default all is framed, as the viewer does at first. A path is of a camera file, which
        `Camera.to_json` gives the content of.
    size : (int, int), optional
        Width and height in pixels; by default the camera's, or 1280 x 720.
    error_px : float
        How wrong the surface may look, in pixels.
    triangles : int, optional
        At most about this many for each layer, spent where the eye is.
    shadow : ShadowMap or path, optional
        The light to draw it in, with its shadows; by default the scene's, or one that hangs on the camera.
    shadow_filter : str, optional
        "hard": one pixel of the shadow map; "pcf3", "pcf5": the mean of 3 x 3 or 5 x 5; "filtered": at the
        level of the map that fits the picture's pixels; "soft": the mean over a stack's images. By default
        "soft" in the light of a surface, else "pcf3".
    shadow_image : int
        Of a stack along a path, which image: the time of day.
    progress, **options
        As for `build`.

    Returns
    -------
    Picture
        (height, width, 3) uint8, sRGB, with the `camera` it was drawn with; a notebook shows it. What shows
        no surface has the scene's `background`, or else the viewer's light one, a gradient.

    Raises
    ------
    FovealError
        If the source, the camera file or the shadow cannot be used, or the output not be written.

    Examples
    --------
    >>> import foveal
    >>> from foveal.mesh.shapes import icosphere
    >>> foveal.render(icosphere(2), size=(64, 48)).shape
    (48, 64, 3)
    """
    from foveal.raster import write_png

    if not error_px >= 0:
        raise FovealError(f"error_px must be a number of pixels, 0 or more, got {error_px}.")
    if triangles is not None and triangles < 1:
        raise FovealError(f"at least one triangle must be wanted, got {triangles}.")
    if output is not None:
        _refuse_output(Path(output))
    if camera is not None and not isinstance(camera, Camera):
        camera = read_camera(camera)
    if camera is not None and size is not None:
        camera = camera.resized(*size)
    light = lighting(shadow, shadow_filter, shadow_image)
    if not isinstance(source, Scene):
        source = checked(source)
    if isinstance(source, (TriMesh, PolyMesh)) and options.get("scheme") is None:
        eye = camera or home([source.positions], up=up_of(options), size=size or _SIZE)
        picture = _opaque(triangles_of(source), eye, None, light, 0.0, progress)
    else:
        scene = load(source, progress=progress, **options)
        eye = camera or frame(scene, size=size or _SIZE)
        light = light or lighting_of(scene, shadow_filter, shadow_image)
        picture = draw(
            *(scene, eye),
            light=light,
            error_px=error_px,
            triangles=triangles,
            progress=progress,
        )
    if output is not None:
        write_png(picture, output)
    return picture


def _refuse_output(output: Path) -> None:
    if output.suffix.lower() != ".png":
        raise FovealError(f"{output}: the name must end in .png.")
    refuse_unwritable(output)


def read_camera(path: PathLike, /) -> Camera:
    """Read a camera file, whose content `Camera.to_json` gives.

    Raises
    ------
    FovealError
        If the file is missing or is no camera.
    """
    return Camera.from_json(read_json(path), name=str(path))


def frame(scene: Scene, /, *, size: tuple[int, int] = _SIZE) -> Camera:
    """A camera that sees every visible layer whole, from where the viewer begins."""
    from foveal import multires

    corners, up = [], "y"
    for layer in _visible(scene):
        if layer.refinement is not None:
            cage = read_cage(layer.path)
            corners.append(cage.mesh.positions)
            up = cage.up
            continue
        with multires.open(layer.path) as asset:
            corners.append(asset.origin + asset.step * np.array(asset.header["box"], dtype=np.float64))
            up = asset.header.get("up", "y")
    return home(corners, up=up, size=size)


def home(points: list[NDArray[np.float64]], /, *, up: str, size: tuple[int, int] = _SIZE) -> Camera:
    """The viewer's home for the box of points, each (n, 3)."""
    return Camera.around(
        np.min([array.min(axis=0) for array in points], axis=0),
        np.max([array.max(axis=0) for array in points], axis=0),
        direction=_FROM[up],
        up=_UP[up],
        width=size[0],
        height=size[1],
    )


def draw(
    scene: Scene,
    camera: Camera,
    /,
    *,
    light: Lighting | None = None,
    error_px: float = 1.0,
    triangles: int | None = None,
    progress: Progress = SILENT,
) -> "Picture":
    """Draw the visible layers of a scene; what `render` says of options and picture holds.

    The light is none of the scene's own: `lighting_of` gives that.
    """
    from foveal import multires
    from foveal.lod.select import cut

    from .refined import refined

    layers, meshes = _visible(scene), []
    for layer in layers:
        if layer.refinement is not None:
            cage = dataclasses.replace(
                read_cage(layer.path), refinement=layer.refinement.chosen({"budget": triangles})
            )
            meshes.append(refined(cage, camera, name=str(layer.path), progress=progress))
            continue
        with multires.open(layer.path) as asset:
            seen = cut(
                asset.graph, _moved(camera, -asset.origin), error_px=error_px, triangle_budget=triangles
            )
            meshes.append(asset.mesh_of(seen.expanded))
    moving = [mesh for mesh, layer in zip(meshes, layers, strict=True) if layer.is_moving]
    if light is not None and moving:
        light = light.with_moving(_joined(moving))
    return _opaque(_joined(meshes), camera, scene.background, light, error_px, progress)


def _opaque(
    mesh: TriMesh,
    camera: Camera,
    background: str | None,
    light: "SceneLight | None",
    error_px: float,
    progress: Progress,
) -> "Picture":
    """On a background of one colour, or the viewer's light one; without the channel of opacity."""
    from foveal import raster

    behind = _rgb(background) if background else raster.gradient(camera)
    picture = raster.picture(
        mesh, camera, background=behind, light=light, error_px=error_px, progress=progress
    )
    return raster.Picture.of(picture[..., :3], camera)


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def _visible(scene: Scene) -> list[Layer]:
    return [layer for layer in scene.layers if layer.is_visible] or list(scene.layers[:1])


def _moved(camera: Camera, shift: NDArray[np.float64]) -> Camera:
    return dataclasses.replace(camera, position=camera.position + shift, target=camera.target + shift)


def _joined(meshes: list[TriMesh]) -> TriMesh:
    """All meshes as one, each as the viewer shows it alone."""
    from foveal.raster import PLASTER

    starts = np.cumsum([0, *(len(mesh.positions) for mesh in meshes)])
    has_colours = any(mesh.colours is not None for mesh in meshes)
    return TriMesh(
        np.concatenate([mesh.positions for mesh in meshes]),
        np.concatenate(
            [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)], dtype=np.int32
        ),
        # A `.fov` without normals is flat: a normal of no length has the triangle's own shown.
        np.concatenate([_or(mesh.normals, len(mesh.positions), (0, 0, 0), np.float32) for mesh in meshes]),
        np.concatenate([_or(mesh.colours, len(mesh.positions), PLASTER, np.uint8) for mesh in meshes])
        if has_colours
        else None,
    )


def _or(
    array: NDArray[Any] | None, count: int, value: tuple[int, int, int], kind: type[np.generic]
) -> NDArray[Any]:
    """An attribute, or the same value for each vertex where a mesh has none."""
    return np.broadcast_to(np.array(value, kind), (count, 3)) if array is None else array
