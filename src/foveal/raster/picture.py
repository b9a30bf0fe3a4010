"""A mesh and a camera to a picture, and the picture to a PNG."""

import io
from dataclasses import replace
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from foveal.base.errors import FovealError
from foveal.base.files import PathLike, whole_file
from foveal.base.progress import SILENT, Progress
from foveal.base.tasks import Executor, ordered_map, threads_unless
from foveal.mesh.normals import vertex_normals
from foveal.mesh.trimesh import TriMesh
from foveal.view.camera import Camera

from . import _kernels_shade as kernels
from .lit import SceneLight, lit_band
from .rasterise import AHEAD, BAND_ROWS, Screen
from .shade import PLASTER, shade_band, tables

__all__ = ["Colour", "Picture", "gradient", "picture", "write_png"]

Colour = tuple[int, int, int]
Background = Colour | NDArray[np.uint8] | None

_GRADIENT_ROWS = 64  # at once: a large picture's in float64 would not fit


class Picture(np.ndarray):
    """(height, width, 3 or 4) uint8 sRGB: an array like any other, that a notebook shows as a picture.

    A part of it is a picture too; what is computed from it is a plain array or number.

    Attributes
    ----------
    camera : Camera or None
        What it was drawn with; a part of a picture has none.

    Examples
    --------
    >>> pixels = Picture.of(np.zeros((2, 3, 3), np.uint8))
    >>> pixels._repr_png_()[1:4], type(pixels + 1).__name__, pixels.max()
    (b'PNG', 'ndarray', np.uint8(0))
    """

    camera: Camera | None = None

    @classmethod
    def of(cls, pixels: NDArray[np.uint8], camera: Camera | None = None, /) -> Self:
        """An array as a picture, contiguous; it is copied only if it is not."""
        picture = np.ascontiguousarray(pixels).view(cls)
        picture.camera = camera
        return picture

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        return array[()] if return_scalar else np.asarray(array)

    def _repr_png_(self) -> bytes | None:
        if self.ndim != 3 or self.shape[2] not in (3, 4) or self.dtype != np.uint8 or not self.size:
            return None  # a row, a channel: the notebook shows numbers
        stream = io.BytesIO()
        _save(self, stream)
        return stream.getvalue()


def picture(
    mesh: TriMesh,
    camera: Camera,
    /,
    *,
    background: Background = None,
    supersampling: int = 2,
    is_flat: bool = False,
    has_colours: bool = True,
    plain: Colour = PLASTER,
    light: SceneLight | None = None,
    error_px: float = 0.0,
    executor: Executor | None = None,
    progress: Progress = SILENT,
) -> Picture:
    """Draw a mesh as the viewer does: lit from the camera or by a light, smooth, from both sides.

    Parameters
    ----------
    mesh : TriMesh
        Without normals of its own it gets means of its faces'.
    camera : Camera
        Its size is the picture's.
    background : (red, green, blue) or (height, width, 3) uint8, optional
        sRGB; transparent by default. `gradient` makes one.
    supersampling : int
        Samples a pixel along each side, 1 to 8: their squares are averaged, as linear light.
    is_flat : bool
        Whether each triangle shows its own normal.
    has_colours : bool
        Whether the mesh's colours are shown; else, and without colours, it is `plain` (sRGB).
    light : SceneLight, optional
        Where the key light comes from and how much of it arrives; by default it hangs on the camera.
    error_px : float
        By how many pixels the mesh may be beside what casts the light's shadows: so far towards the eye is
        asked how much light arrives, or a coarser mesh would be in the shadow of the finer one.
    executor : Executor, optional
        Local threads by default. The bytes do not depend on it.
    progress : Progress
        Told of the rows drawn.

    Returns
    -------
    Picture
        (height, width, 4) uint8, sRGB and opacity, rows from the top. Colour is not multiplied by opacity.

    Raises
    ------
    FovealError
        If the picture, or the background, is of a size that cannot be.

    Examples
    --------
    >>> triangle = TriMesh.of([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> pixels = picture(triangle, Camera.of([0, 0, 3], [0, 0, 0], width=3, height=3))
    >>> pixels[1, 1].tolist(), pixels[0, 0].tolist()
    ([205, 199, 189, 255], [0, 0, 0, 0])
    """
    if not 1 <= supersampling <= 8:
        raise ValueError(f"supersampling must be from 1 to 8, got {supersampling}")
    behind = _background(background, camera)
    lift_px = error_px * supersampling
    linear_of = tables()[0].astype(np.float32)
    wide = replace(camera, width=camera.width * supersampling, height=camera.height * supersampling)
    normals = None if is_flat else vertex_normals(mesh) if mesh.normals is None else mesh.normals
    colours = mesh.colours if has_colours else None
    out = np.empty((camera.height, camera.width, 4), dtype=np.uint8)

    # A group of bands is a whole number of the picture's rows, so that no square of samples is torn.
    bands_a_group = supersampling // np.gcd(BAND_ROWS, supersampling)
    rows_a_group = bands_a_group * BAND_ROWS // supersampling

    def draw(group: int) -> None:
        bands = range(group * bands_a_group, min((group + 1) * bands_a_group, screen.bands))
        face_ids = [screen.draw(band)[1] for band in bands]
        linear = []
        for band, ids in zip(bands, face_ids, strict=True):
            keys, shadows = (None, None) if light is None else lit_band(screen, band, ids, light, lift_px)
            linear.append(
                shade_band(
                    *(screen, band, ids),
                    normals=normals,
                    colours=colours,
                    plain=plain,
                    keys=keys,
                    shadows=shadows,
                )
            )
        rows = slice(group * rows_a_group, (group + 1) * rows_a_group)
        # Decoded by the group: all at once a large picture's would take more memory than all else.
        back = np.empty((0, 0, 3), np.float32) if behind is None else linear_of[behind[rows]]
        samples = (np.concatenate(linear), np.concatenate(face_ids))
        kernels.develop(*samples, supersampling, back, behind is not None, tables()[1], out[rows])

    with threads_unless(executor) as pool:
        screen = Screen(mesh.positions, mesh.faces, wide, executor=pool)
        groups = -(-screen.bands // bands_a_group)
        with progress.stage("Drawing", float(groups)) as stage:
            for _ in ordered_map(pool, draw, range(groups), ahead=AHEAD):
                stage.advance()
    return Picture.of(out, camera)


def _background(background: Background, camera: Camera) -> NDArray[np.uint8] | None:
    if background is None:
        return None
    colours = np.asarray(background)
    shape = (camera.height, camera.width, 3)
    if colours.shape not in ((3,), shape) or not ((colours >= 0) & (colours <= 255)).all():
        raise FovealError(
            f"background: it must be three numbers from 0 to 255, or as many a pixel, in shape {shape}."
        )
    return np.broadcast_to(colours.astype(np.uint8, copy=False), shape)


def gradient(
    camera: Camera, /, *, middle: Colour = (251, 249, 245), corners: Colour = (217, 211, 200)
) -> NDArray[np.uint8]:
    """(height, width, 3) uint8: the viewer's light background, from its middle to its corners.

    Examples
    --------
    >>> gradient(Camera.of([0, 0, 1], [0, 0, 0], width=3, height=3))[0, 0].tolist()
    [232, 228, 220]
    """
    out = np.empty((camera.height, camera.width, 3), dtype=np.uint8)
    aspect = camera.width / camera.height
    column = np.arange(camera.width) + 0.5
    x = (2 * column / camera.width - 1) * min(1, aspect)
    for first in range(0, camera.height, _GRADIENT_ROWS):
        row = np.arange(first, min(first + _GRADIENT_ROWS, camera.height))[:, None] + 0.5
        y = (1 - 2 * row / camera.height) * min(1, 1 / aspect) - 0.12
        t = np.clip((np.sqrt(x * x + y * y) - 0.1) / 1.4, 0, 1)[..., None]
        t = t * t * (3 - 2 * t)
        # Steps of one level in a flat gradient show as bands: a fixed noise below one level hides them.
        noise = np.modf(52.9829189 * np.modf(column * 0.06711056 + row * 0.00583715)[0])[0][..., None]
        colours = np.array(middle) * (1 - t) + np.array(corners) * t
        out[first : first + len(row)] = np.clip(np.floor(colours + noise), 0, 255)
    return out


def write_png(pixels: NDArray[np.uint8], path: PathLike, /) -> None:
    """Write a picture, (height, width, 3 or 4) uint8 sRGB, to a PNG file that appears when it is whole.

    Raises
    ------
    FovealError
        If `path` cannot be written.
    """
    with whole_file(path) as stream:
        _save(pixels, stream)


def _save(pixels: NDArray[np.uint8], stream: BinaryIO) -> None:
    Image.fromarray(np.ascontiguousarray(pixels)).save(stream, format="PNG")
